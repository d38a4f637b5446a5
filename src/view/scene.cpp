#include "view/scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "base/box.h"
#include "base/error.h"
#include "case/probe_columns.h"
#include "case/rheology.h"
#include "geometry/from_spec.h"
#include "geometry/opening.h"
#include "probes/probe_set.h"
#include "view/frame.h"

namespace tailwater {
namespace {

/// Rounds to the digits that a picture needs, because a mesh has a hundred thousand coordinates.
double rounded(double number) { return std::strtod(fmt::format("{:.7g}", number).c_str(), nullptr); }

template <int Dim>
Json point(const Vec<Dim>& x) {
  Json numbers = Json::array();
  for (const double coordinate : x) numbers.push_back(rounded(coordinate));
  return numbers;
}

/// The faces of a wall; for a plate only those at the front.
template <int Dim>
std::vector<std::size_t> faces_of(const Boundary<Dim>& boundary, int wall) {
  std::vector<std::size_t> faces;
  for (std::size_t f = 0; f < boundary.faces.size(); ++f) {
    if (boundary.faces[f].wall == wall) faces.push_back(f);
  }
  for (const WallPlate& plate : boundary.plates) {
    if (plate.wall != wall) continue;
    const auto first_back = static_cast<std::size_t>(plate.first_face + plate.pieces);
    std::erase_if(faces, [&](std::size_t f) { return f >= first_back && f < first_back + plate.pieces; });
  }
  return faces;
}

using Chain = std::deque<Vec<2>>;

/// Joins two chains if one ends at the start of the other.
bool join(Chain& chain, Chain& other) {
  if (chain.back() == other.front()) {
    chain.insert(chain.end(), other.begin() + 1, other.end());
  } else if (other.back() == chain.front()) {
    chain.insert(chain.begin(), other.begin(), other.end() - 1);
  } else {
    return false;
  }
  return true;
}

/// The faces of a wall as chains of points, as long as possible. Faces mostly follow each other, forwards, or backwards
/// where the water is on the right; those of a box come in another order.
Json polylines_of(const Boundary<2>& boundary, int wall) {
  std::vector<Chain> chains;
  for (const std::size_t f : faces_of(boundary, wall)) {
    const auto& [from, to] = boundary.faces[f].corners;
    Chain face{from, to};
    if (chains.empty() || !join(chains.back(), face)) chains.push_back(std::move(face));
  }
  for (std::size_t k = 0; k < chains.size(); ++k) {
    for (std::size_t other = k + 1; other < chains.size(); ++other) {
      if (!join(chains[k], chains[other])) continue;
      chains.erase(chains.begin() + static_cast<std::ptrdiff_t>(other));
      other = k;  // its ends have changed
    }
  }
  Json all = Json::array();
  for (const Chain& chain : chains) {
    Json points = Json::array();
    for (const Vec<2>& x : chain) points.push_back(point<2>(x));
    all.push_back(std::move(points));
  }
  return all;
}

/// Triangles with corners in common: {positions: [x, y, z, ...], indices: [a, b, c, ...]}.
Json triangles_of(const Boundary<3>& boundary, int wall) {
  std::map<std::array<double, 3>, std::size_t> number_of;
  Json positions = Json::array();
  Json indices = Json::array();
  for (const std::size_t f : faces_of(boundary, wall)) {
    for (const Vec<3>& corner : boundary.faces[f].corners) {
      const auto [entry, is_new] = number_of.try_emplace({corner[0], corner[1], corner[2]}, number_of.size());
      if (is_new) {
        for (const double coordinate : corner) positions.push_back(rounded(coordinate));
      }
      indices.push_back(entry->second);
    }
  }
  return {{"positions", std::move(positions)}, {"indices", std::move(indices)}};
}

template <int Dim>
Json walls_json(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const std::vector<int> poses = pose_of_walls(boundary);
  Json walls = Json::array();
  for (std::size_t w = 0; w < boundary.walls.size(); ++w) {
    const WallProperties& properties = boundary.walls[w];
    const bool is_of_body = w < spec.walls.size() && spec.walls[w].drive.by == Drive::By::body;
    Json wall{{"name", properties.name},
              {"kind", is_of_body ? "body" : properties.kind},
              {"plate", properties.is_plate},
              {"moving", poses[w] < 0 ? Json() : Json(poses[w])}};
    if constexpr (Dim == 2) {
      wall["polylines"] = polylines_of(boundary, static_cast<int>(w));
    } else {
      wall["triangles"] = triangles_of(boundary, static_cast<int>(w));
    }
    walls.push_back(std::move(wall));
  }
  return walls;
}

Json bodies_json(const CaseSpec& spec, const std::vector<int>& poses) {
  Json bodies = Json::array();
  for (std::size_t b = 0; b < spec.bodies.size(); ++b) {
    Json body{{"name", spec.bodies[b].name}, {"pose", nullptr}, {"centre", spec.bodies[b].centre}};
    for (std::size_t w = 0; w < std::min(poses.size(), spec.walls.size()); ++w) {
      if (spec.walls[w].drive == Drive{Drive::By::body, b} && poses[w] >= 0) body["pose"] = poses[w];
    }
    bodies.push_back(std::move(body));
  }
  return bodies;
}

/// Inlets or outlets, with the corners of their rims: two in 2D, four or more in 3D.
template <int Dim>
Json open_ends_json(const std::vector<Opening<Dim>>& ends, OpeningKind kind) {
  Json all = Json::array();
  for (const Opening<Dim>& end : ends) {
    if (end.kind != kind) continue;
    Json corners = Json::array();
    for (const Vec<Dim>& corner : end.rim()) corners.push_back(point<Dim>(corner));
    all.push_back({{"name", end.name}, {"corners", std::move(corners)}, {"direction", point<Dim>(end.direction())}});
  }
  return all;
}

/// The place of a probe: a point, the ends of a line, the corners of an outline; none for a probe of the whole domain.
/// A height that the case leaves out is that of the lowest wall.
std::vector<Coordinates> places_of(const ProbeTable& probe, std::size_t dimension, double lowest) {
  std::vector<Coordinates> places;
  for (Coordinates x : {probe.at, probe.from, probe.to}) {
    if (x.size() + 1 < dimension || x.empty()) continue;
    x.resize(dimension, lowest);
    places.push_back(std::move(x));
  }
  if (!places.empty()) return places;
  const Coordinates& low = probe.region_min;
  const Coordinates& high = probe.region_max;
  if (low.size() != dimension || high.size() != dimension) return {};
  if (dimension == 3) return {low, high};
  return {low, {high[0], low[1]}, high, {low[0], high[1]}};
}

/// By probe.
using Columns = std::vector<std::vector<OutputColumn>>;

/// The columns of each probe's table after the time; none where it cannot measure, which another check reports.
template <int Dim>
Columns columns_of_probes(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  Columns columns(spec.probes.size());
  try {
    const std::vector<Probe<Dim>> probes = make_probes<Dim>(spec, boundary);
    for (std::size_t p = 0; p < probes.size(); ++p) columns[p] = probes[p].reading.columns;
  } catch (const InputError&) {
    columns.assign(spec.probes.size(), {});
  }
  return columns;
}

template <int Dim>
Json probes_json(const CaseSpec& spec, const Columns& columns, const Json& box) {
  const double lowest = box.is_null() ? 0.0 : box["min"][Dim - 1].template get<double>();
  Json probes = Json::array();
  for (std::size_t p = 0; p < spec.probes.size(); ++p) {
    const ProbeTable& table = spec.probes[p];
    Json headings = Json::array();
    Json names = Json::array();
    Json units = Json::array();
    for (const OutputColumn& column : columns[p]) {
      headings.push_back(column.heading);
      names.push_back(column.name);
      units.push_back(unit_of(column.measure, Dim));
    }
    probes.push_back({{"name", table.name},
                      {"type", name_of(table.type)},
                      {"file", fmt::format("probes/{}.csv", table.name)},
                      {"points", places_of(table, Dim, lowest)},
                      {"columns", std::move(headings)},
                      {"names", std::move(names)},
                      {"units", std::move(units)},
                      {"walls", table.walls},
                      {"body", table.body}});
  }
  return probes;
}

/// The measurements of laboratories within the time of the run, in the order of the case.
Json measurements_json(const CaseSpec& spec) {
  Json measurements = Json::array();
  for (const MeasurementTable& table : spec.measurements) {
    Json one{{"probe", table.probe},
             {"column", compared_with(table, spec).column.heading},
             {"file", std::filesystem::path(table.file).filename().string()},
             {"time", Json::array()},
             {"value", Json::array()}};
    for (std::size_t k = 0; k < table.series.time.size(); ++k) {
      if (table.series.time[k] < 0.0 || table.series.time[k] > spec.time.end) continue;
      one["time"].push_back(rounded(table.series.time[k]));
      one["value"].push_back(rounded(table.series.columns[0][k]));
      if (table.series.columns.size() > 1) one["x"].push_back(rounded(table.series.columns[1][k]));
    }
    measurements.push_back(std::move(one));
  }
  return measurements;
}

/// The places of the spaces that start at another pressure.
template <int Dim>
Json pockets_json(const CaseSpec& spec) {
  Json pockets = Json::array();
  for (const PocketTable& pocket : spec.pockets) {
    pockets.push_back(
        {{"name", pocket.name}, {"at", point<Dim>(to_vec<Dim>(pocket.at, CaseLabel("pocket", pocket.name), "at"))}});
  }
  return pockets;
}

/// Vents with the width of a slit in 2D, or of a round hole in 3D, of their area.
template <int Dim>
Json vents_json(const CaseSpec& spec) {
  Json vents = Json::array();
  for (const VentTable& vent : spec.vents) {
    const double width = Dim == 2 ? vent.area : std::sqrt(4.0 * vent.area / std::numbers::pi);
    vents.push_back({{"name", vent.name},
                     {"at", point<Dim>(to_vec<Dim>(vent.at, CaseLabel("vent", vent.name), "at"))},
                     {"width", rounded(width)}});
  }
  return vents;
}

Json periodic_json(const CaseSpec& spec) {
  Json periodic = Json::array();
  for (int axis = 0; axis < spec.general.dimension; ++axis) {
    const std::vector<double>& range = periodic_range(spec.domain, axis);
    if (range.size() == 2) periodic.push_back({{"axis", axis}, {"low", range[0]}, {"high", range[1]}});
  }
  return periodic;
}

/// The valid open ends; another check reports the others.
template <int Dim>
std::vector<Opening<Dim>> sound_open_ends(const CaseSpec& spec) {
  try {
    return make_open_ends<Dim>(spec);
  } catch (const InputError&) {
    return {};
  }
}

/// The box around the drawn objects; null if there are none.
template <int Dim>
Json box_json(const Boundary<Dim>& boundary, const std::vector<Opening<Dim>>& ends) {
  Box<Dim> box = box_around(boundary.faces);
  for (const Opening<Dim>& end : ends) box.extend(box_around(end.as_faces()));
  if (box.isEmpty()) return {};
  return {{"min", point<Dim>(box.min())}, {"max", point<Dim>(box.max())}};
}

}  // namespace

std::vector<FrameScalar> frame_scalars(const CaseSpec& spec) {
  std::vector<FrameScalar> scalars{{"pressure", "Pa"}, {"speed", "m/s"}};
  if (!spec.refinement.empty()) scalars.push_back({"size", "m"});
  if (has_several_liquids(spec)) scalars.push_back({"liquid", ""});
  return scalars;
}

template <int Dim>
std::vector<int> pose_of_walls(const Boundary<Dim>& boundary) {
  std::vector<int> poses;
  std::map<int, int> pose_of_body;
  for (const WallProperties& wall : boundary.walls) {
    poses.push_back(wall.moves() ? pose_of_body.try_emplace(wall.body, pose_of_body.size()).first->second : -1);
  }
  return poses;
}

template <int Dim>
Json scene_json(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const std::vector<Opening<Dim>> ends = sound_open_ends<Dim>(spec);
  const Json box = box_json(boundary, ends);
  const Columns columns = columns_of_probes(spec, boundary);
  Json scalars = Json::array();
  for (const FrameScalar& scalar : frame_scalars(spec)) {
    scalars.push_back({{"name", scalar.name}, {"unit", scalar.unit}});
  }
  Json liquids = Json::array();
  if (has_several_liquids(spec)) {
    for (const LiquidTable& liquid : spec.liquids) liquids.push_back(liquid.name);
  }
  return {{"format", frame_format},
          {"title", spec.general.title},
          {"dimension", Dim},
          {"spacing", spec.particles.spacing},
          {"gravity", spec.physics.gravity},
          {"density", spec.physics.density},
          {"end", spec.time.end},
          {"box", box},
          {"periodic", periodic_json(spec)},
          {"walls", walls_json(spec, boundary)},
          {"bodies", bodies_json(spec, pose_of_walls(boundary))},
          {"inlets", open_ends_json(ends, OpeningKind::inlet)},
          {"outlets", open_ends_json(ends, OpeningKind::outlet)},
          {"pockets", pockets_json<Dim>(spec)},
          {"vents", vents_json<Dim>(spec)},
          {"probes", probes_json<Dim>(spec, columns, box)},
          {"measurements", measurements_json(spec)},
          {"scalars", std::move(scalars)},
          {"liquids", std::move(liquids)}};
}

TAILWATER_IN_2D_AND_3D(pose_of_walls);
TAILWATER_IN_2D_AND_3D(scene_json);

}  // namespace tailwater
