#include "results/water_balance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/for_each.h"
#include "geometry/mesh_surface.h"

namespace tailwater {
namespace {

Json amount_json(const WaterAmount& water, double density) {
  return {{"particles", water.particles}, {"volume_m3", water.volume}, {"mass_kg", density * water.volume}};
}

/// By how much, since when and for how long a prescribed level was missed; null: it was held.
Json json_of_miss(const LevelError& miss) {
  if (miss.since < 0.0) return nullptr;
  return {{"by_m", miss.most}, {"since_s", miss.since}, {"for_s", miss.total}};
}

/// A wall that a body falling from a place meets first.
struct Landing {
  double share = std::numeric_limits<double>::infinity();  ///< of the fall to where it meets the wall
  double height = -1.0;                                    ///< m; of the place above it: positive if it meets the front
};

template <int Dim>
Landing landing_of(const Boundary<Dim>& boundary, const Vec<Dim>& x, const Vec<Dim>& fall, double tolerance) {
  const Vec<Dim> lowest = x + fall;
  Landing first;
  const auto meets = [&](const WallFace<Dim>& face) {
    // Of the two faces of a plate the one that looks at x counts.
    if (face.height(x) <= 0.0 && boundary.walls[face.wall].is_plate) return;
    const double share = face.height(x) / (face.height(x) - face.height(lowest));
    if (share < first.share) first = {share, face.height(x)};
  };
  boundary.visit_plain_faces([&](int f) {
    if (crosses(boundary.faces[f], x, lowest, tolerance)) meets(boundary.faces[f]);
  });
  if constexpr (Dim == 3) {
    for (const WallMesh& mesh : boundary.meshes) {
      const Vec<3> drawn = boundary.displacement_of(mesh);
      const int triangle = mesh.surface->first_crossed(x - drawn, lowest - drawn, tolerance);
      if (triangle >= 0) meets(boundary.faces[mesh.first_face + triangle]);
    }
  }
  return first;
}

/// The place and those of its images from which `fall` may lead through the domain: what leaves a periodic domain on
/// one side goes on at the other.
template <int Dim>
std::vector<Vec<Dim>> images_along(const PeriodicDomain<Dim>& domain, const Vec<Dim>& x, const Vec<Dim>& fall) {
  std::vector<Vec<Dim>> images{x};
  for (int axis = 0; axis < Dim; ++axis) {
    if (!domain[axis]) continue;
    const double period = domain[axis]->second - domain[axis]->first;
    const int count = 1 + static_cast<int>(std::ceil(std::abs(fall[axis]) / period));
    const std::vector<Vec<Dim>> before = images;
    for (const Vec<Dim>& image : before) {
      for (int k = 1; k <= count; ++k) {
        for (const int shift : {-k, k}) images.push_back(image + shift * period * Vec<Dim>::Unit(axis));
      }
    }
  }
  return images;
}

template <int Dim>
bool is_passing_end(const Flow<Dim>& flow, const Vec<Dim>& x) {
  return std::any_of(flow.setup.open_ends.begin(), flow.setup.open_ends.end(),
                     [&](const OpenEnd<Dim>& end) { return end.opening.is_passed_by(x); });
}

/// Whether water that is beyond the box around the walls falls onto the front of one, as spray above an open tank does.
template <int Dim>
bool falls_back(const Flow<Dim>& flow, const Eigen::AlignedBox<double, Dim>& box, const Vec<Dim>& x) {
  const Vec<Dim>& gravity = flow.setup.gravity;
  if (gravity.norm() == 0.0) return false;
  const double length = box.exteriorDistance(x) + box.diagonal().norm() + flow.setup.spacing;
  const Vec<Dim> fall = length * gravity.normalized();
  Landing first;
  for (const Vec<Dim>& place : images_along<Dim>(flow.setup.domain, x, fall)) {
    const Landing landing = landing_of<Dim>(flow.walls.boundary, place, fall, corner_tolerance * flow.setup.spacing);
    if (landing.share < first.share) first = landing;
  }
  return first.height > 0.0;
}

}  // namespace

std::string text_of(const WaterAmount& water) {
  return fmt::format("{} particles ({:.6g} m^3)", water.particles, water.volume);
}

template <int Dim>
WaterAmount water_in(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  WaterAmount water = sum_over(particles.owned, WaterAmount(), [&](std::size_t i) {
    return particles.is_fluid(i) ? WaterAmount{1, particles.volume[i]} : WaterAmount();
  });
  flow.setup.ranks.sum_each(water.particles, water.volume);
  return water;
}

template <int Dim>
WaterAmount water_outside(const Flow<Dim>& flow) {
  const Eigen::AlignedBox<double, Dim> box = flow.box();
  if (box.isEmpty()) return {};
  const Particles<Dim>& particles = flow.state.particles;
  WaterAmount water = sum_over(particles.owned, WaterAmount(), [&](std::size_t i) {
    const Vec<Dim> x = flow.neighbourhood.wrapped(particles.position[i]);
    const bool is_outside =
        particles.is_fluid(i) && !box.contains(x) && !falls_back(flow, box, x) && !is_passing_end(flow, x);
    return is_outside ? WaterAmount{1, particles.volume[i]} : WaterAmount();
  });
  flow.setup.ranks.sum_each(water.particles, water.volume);
  water += flow.state.fallen;
  return water;
}

template <int Dim>
WaterAmount water_inside(const Flow<Dim>& flow) {
  WaterAmount water = water_in(flow);
  water += flow.state.fallen;
  water -= water_outside(flow);
  return water;
}

template <int Dim>
WaterAmount water_out(const Flow<Dim>& flow) {
  WaterAmount water;
  for (const OpenEndState& end : flow.state.open_ends) water += end.departed;
  return water;
}

template <int Dim>
WaterAmount water_came(const Flow<Dim>& flow) {
  WaterAmount water;
  for (const OpenEndState& end : flow.state.open_ends) water += end.arrived;
  return water;
}

template <int Dim>
Json water_balance(const WaterAmount& at_start, const Flow<Dim>& flow) {
  const double density = flow.setup.density;
  const auto json_of_passed = [&](const WaterAmount& passed) {
    Json json = amount_json(passed, density);
    json["energy_J"] = passed.energy;
    return json;
  };
  Json inlets = Json::array();
  Json outlets = Json::array();
  for (std::size_t e = 0; e < flow.setup.open_ends.size(); ++e) {
    const Opening<Dim>& opening = flow.setup.open_ends[e].opening;
    const OpenEndState& end = flow.state.open_ends[e];
    const bool is_inlet = opening.kind == OpeningKind::inlet;
    // On the way that is meant, and `back`.
    Json json;
    json["name"] = opening.name;
    json.update(json_of_passed(is_inlet ? end.arrived : end.departed));
    json["back"] = json_of_passed(is_inlet ? end.departed : end.arrived);
    const int circuit = flow.setup.open_ends[e].circuit;
    if (circuit >= 0 && is_inlet) json["steps_short_of_water"] = end.short_steps;
    if (flow.setup.open_ends[e].flow.feeds()) json["asked_for_m3"] = end.asked;
    if (flow.setup.open_ends[e].holds_level()) json["level_missed"] = json_of_miss(end.miss);
    if (circuit == static_cast<int>(e)) json["waiting"] = amount_json(sump_of(flow, circuit), density);
    (is_inlet ? inlets : outlets).push_back(json);
  }
  return {{"start", amount_json(at_start, density)},
          {"in", amount_json(water_came(flow), density)},
          {"inside", amount_json(water_inside(flow), density)},
          {"outside", amount_json(water_outside(flow), density)},
          {"out", amount_json(water_out(flow), density)},
          {"inlets", inlets},
          {"outlets", outlets}};
}

TAILWATER_IN_2D_AND_3D(water_in);
TAILWATER_IN_2D_AND_3D(water_outside);
TAILWATER_IN_2D_AND_3D(water_inside);
TAILWATER_IN_2D_AND_3D(water_out);
TAILWATER_IN_2D_AND_3D(water_came);
TAILWATER_IN_2D_AND_3D(water_balance);

}  // namespace tailwater
