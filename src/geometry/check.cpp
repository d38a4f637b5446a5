#include "geometry/check.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "geometry/cell_space.h"
#include "geometry/check_motion.h"
#include "geometry/from_spec.h"
#include "geometry/outlet.h"
#include "geometry/point_grid.h"

namespace tailwater {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::string fluid_name(const CaseSpec& spec, int block) {
  return fmt::format("fluid '{}'", name_or_number(spec.fluid[block].name, "fluid", block));
}

template <class... Arguments>
void error(std::vector<Finding>& findings, fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  findings.push_back({Severity::error, fmt::format(text, std::forward<Arguments>(arguments)...)});
}

template <class... Arguments>
void warning(std::vector<Finding>& findings, fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  findings.push_back({Severity::warning, fmt::format(text, std::forward<Arguments>(arguments)...)});
}

/// The spacing nearest to dx that divides every extent of a box; that divides the `extent` asked for, if there is none.
double fitting_spacing(const FluidTable& block, double extent, double dx) {
  double best = extent / std::max(1.0, std::round(extent / dx));
  double best_change = infinite;
  for (double cells = std::max(1.0, std::floor(0.8 * extent / dx)); cells <= 1.25 * extent / dx + 1.0; ++cells) {
    const double candidate = extent / cells;
    bool fits = true;
    for (std::size_t axis = 0; axis < block.min.size(); ++axis) {
      const double n = (block.max[axis] - block.min[axis]) / candidate;
      fits = fits && std::abs(n - std::round(n)) < 1e-6 * n;
    }
    if (fits && std::abs(candidate - dx) < best_change) {
      best = candidate;
      best_change = std::abs(candidate - dx);
    }
  }
  return best;
}

template <int Dim>
void check_blocks(const CaseSpec& spec, const FluidParticles<Dim>& fluid, std::vector<Finding>& findings) {
  const double dx = spec.particles.spacing;
  if (spec.fluid.empty()) {
    error(findings, "there is no fluid: add a [[fluid]] table");
  }
  std::vector<std::size_t> count(spec.fluid.size(), 0);
  for (const int block : fluid.block) {
    ++count[block];
  }
  for (std::size_t b = 0; b < spec.fluid.size(); ++b) {
    const FluidTable& block = spec.fluid[b];
    const std::string name = fluid_name(spec, static_cast<int>(b));
    if (block.shape == BlockShape::polygon) {
      if (count[b] == 0) {
        error(findings,
              "{} at {} holds no particle: its area is {:.3g} m^2 and the spacing {:.6g} m; make the spacing "
              "smaller, or mend its points",
              name, place(to_vec<Dim>(block.points[0], name, "points[0]")), std::abs(signed_area(block.points)), dx);
      }
      continue;
    }
    const Vec<Dim> low = to_vec<Dim>(block.min, name, "min");
    const Vec<Dim> extent = to_vec<Dim>(block.max, name, "max") - low;
    int smallest = 0;
    extent.minCoeff(&smallest);
    if (count[b] == 0 || extent[smallest] < (1.0 - corner_tolerance) * dx) {
      error(findings,
            "{} at {} is {:.6g} m long in {}, which holds no particle of spacing {:.6g} m: use a spacing of at "
            "most {:.6g} m, or a larger block",
            name, place(low), extent[smallest], "xyz"[smallest], dx, extent[smallest]);
      continue;
    }
    for (int axis = 0; axis < Dim; ++axis) {
      const double cells = extent[axis] / dx;
      if (std::abs(cells - std::round(cells)) > 1e-3) {
        warning(findings,
                "{} at {} is {:.6g} m long in {}, which is {:.2f} spacings: its particles fill {:.6g} m; a "
                "spacing of {:.6g} m fits",
                name, place(low), extent[axis], "xyz"[axis], cells, std::round(cells) * dx,
                fitting_spacing(block, extent[axis], dx));
      }
    }
  }
}

template <int Dim>
void check_overlaps(const CaseSpec& spec, const FluidParticles<Dim>& fluid, std::vector<Finding>& findings) {
  if (spec.fluid.size() < 2) {
    return;
  }
  // Neighbouring blocks stand dx apart, less what the jitter takes from both sides.
  const double least = std::min(0.5, 1.0 - 2.0 * spec.particles.jitter) * spec.particles.spacing;
  PointGrid<Dim> grid(least * (1.0 - corner_tolerance));
  struct Overlap {
    std::size_t particles = 0;
    Vec<Dim> where;
  };
  std::map<std::pair<int, int>, Overlap> overlaps;
  for (std::size_t i = 0; i < fluid.position.size(); ++i) {
    int other = -1;
    grid.visit_near(fluid.position[i], [&](int j) {
      if (fluid.block[j] != fluid.block[i]) {
        other = fluid.block[j];
      }
    });
    grid.add(fluid.position[i]);
    if (other >= 0) {
      Overlap& overlap = overlaps[{other, fluid.block[i]}];
      if (overlap.particles++ == 0) {
        overlap.where = fluid.position[i];
      }
    }
  }
  for (const auto& [blocks, overlap] : overlaps) {
    error(findings,
          "{} and {} overlap, first at {}: {} particles of the second stand nearer than {:.6g} m to the first; "
          "move the blocks apart, or leave the common part out of one of them",
          fluid_name(spec, blocks.first), fluid_name(spec, blocks.second), place(overlap.where), overlap.particles,
          least);
  }
}

/// One block beside one wall.
template <int Dim>
struct Contact {
  std::size_t in_front = 0;
  std::size_t behind = 0;
  std::size_t too_near = 0;
  double deepest = 0.0;       ///< m behind the wall, positive
  double nearest = infinite;  ///< m in front of it
  Vec<Dim> deepest_at, nearest_at;
};

template <int Dim>
void check_contact(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid,
                   std::vector<Finding>& findings) {
  const double dx = spec.particles.spacing;
  const double jitter = spec.particles.jitter;
  // Where the first particle belongs, and how far off it may be.
  const double regular = spec.scheme.walls == WallTreatment::dummies ? 0.5 : 1.0;
  const double play = std::max(0.25, jitter) + corner_tolerance;
  const double least = (0.5 - play) * dx;
  const double gap_from = (regular + play) * dx;
  const double gap_to = (regular + 1.5) * dx;

  std::map<std::pair<int, int>, Contact<Dim>> contacts;                        // by wall and block
  std::map<std::pair<int, int>, std::pair<double, Vec<Dim>>> nearest_to_face;  // by face and block
  for (std::size_t i = 0; i < fluid.position.size(); ++i) {
    const Vec<Dim>& x = fluid.position[i];
    const NearestWall<Dim> near = boundary.nearest(x, infinite);
    if (near.face < 0) {
      return;
    }
    const double height = boundary.faces[near.face].height(x);
    Contact<Dim>& contact = contacts[{boundary.faces[near.face].wall, fluid.block[i]}];
    // Beyond a free end of a wall the sign means nothing: only what stands squarely before or behind a face counts.
    const bool is_square = std::abs(std::abs(near.signed_distance) - std::abs(height)) < corner_tolerance * dx;
    if (near.signed_distance >= 0.0) {
      contact.in_front += is_square ? 1 : 0;
      contact.too_near += near.signed_distance < least ? 1 : 0;
      if (near.signed_distance < contact.nearest) {
        contact.nearest = near.signed_distance;
        contact.nearest_at = x;
      }
      auto& [distance, at] = nearest_to_face.try_emplace({near.face, fluid.block[i]}, infinite, x).first->second;
      if (is_square && near.signed_distance < distance) {
        distance = near.signed_distance;
        at = x;
      }
    } else if (is_square) {
      ++contact.behind;
      if (-near.signed_distance > contact.deepest) {
        contact.deepest = -near.signed_distance;
        contact.deepest_at = x;
      }
    }
  }

  std::vector<std::size_t> in_front(boundary.walls.size(), 0);
  for (const auto& [key, contact] : contacts) {
    in_front[key.first] += contact.in_front;
  }
  for (const auto& [key, contact] : contacts) {
    const std::string wall = wall_label(boundary, key.first);
    const std::string block = fluid_name(spec, key.second);
    if (contact.behind > 0 && in_front[key.first] > 0) {
      error(
          findings,
          "{} has fluid on both sides: {} particles of {} lie behind it, up to {:.6g} m deep at {}; where the water "
          "starts inside a bed, let the block end on the bed (shape = \"polygon\"); where a wall stands in water, draw "
          "it with two faces, {} spacings apart or more",
          wall, contact.behind, block, contact.deepest, place(contact.deepest_at), dummy_layers(spec) + 1);
    } else if (contact.behind > 0) {
      error(findings,
            "{} lies behind {}: {} particles, up to {:.6g} m deep at {}; turn the wall's fluid_side round, or "
            "move the block",
            block, wall, contact.behind, contact.deepest, place(contact.deepest_at));
    }
    if (contact.too_near > 0) {
      error(findings,
            "{} is too near to {}: {} particles nearer than {:.6g} m, the nearest {:.3g} m at {}; put the "
            "block's edge on the wall or a whole number of spacings ({:.6g} m) from it",
            block, wall, contact.too_near, least, contact.nearest, place(contact.nearest_at), dx);
    }
  }
  std::map<std::pair<int, int>, bool> is_reported;
  for (const auto& [key, nearest] : nearest_to_face) {
    const int wall = boundary.faces[key.first].wall;
    if (nearest.first > gap_from && nearest.first < gap_to && !std::exchange(is_reported[{wall, key.second}], true)) {
      warning(findings,
              "there is a gap between {} and {}: the nearest particle stands {:.2f} spacings from the wall, at "
              "{}, instead of {:.2f}; put the block's edge on the wall, or move it away by two spacings or more",
              fluid_name(spec, key.second), wall_label(boundary, wall), nearest.first / dx, place(nearest.second),
              regular);
    }
  }
}

template <int Dim>
bool shares_corner(const WallFace<Dim>& a, const WallFace<Dim>& b, double tolerance) {
  for (const Vec<Dim>& p : a.corners) {
    for (const Vec<Dim>& q : b.corners) {
      if ((p - q).norm() <= tolerance) {
        return true;
      }
    }
  }
  return false;
}

void check_crossings(const CaseSpec& spec, const Boundary<2>& boundary, std::vector<Finding>& findings) {
  const double tolerance = corner_tolerance * spec.particles.spacing;
  for (std::size_t i = 0; i < boundary.faces.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const WallFace<2>& a = boundary.faces[i];
      const WallFace<2>& b = boundary.faces[j];
      if (a.wall == b.wall && crosses(a, b.corners[0], b.corners[1], tolerance) &&
          crosses(b, a.corners[0], a.corners[1], tolerance)) {
        error(findings, "{} crosses itself at {}: mend the order of its points", wall_label(boundary, a.wall),
              place(meet(a, b.corners[0], b.corners[1])));
      }
    }
  }
}

/// A bed whose crest is as high as its own ends: what gets there has run over the ends before.
void check_humps(const CaseSpec& spec, const Boundary<2>& boundary, std::vector<Finding>& findings) {
  const Vec<2> gravity = to_vec<2>(spec.physics.gravity, "[physics]", "gravity");
  if (gravity.norm() == 0.0) {
    return;
  }
  const Vec<2> up = -gravity.normalized();
  for (std::size_t w = 0; w < spec.walls.size(); ++w) {
    const std::vector<Coordinates>& points = spec.walls[w].points;
    if (spec.walls[w].shape != WallShape::polyline) {
      continue;
    }
    const auto height = [&](std::size_t k) { return up.dot(Vec<2>(points[k][0], points[k][1])); };
    const std::size_t last = points.size() - 1;
    double rim = -infinite;
    if (height(0) > height(1)) rim = height(0);
    if (height(last) > height(last - 1)) rim = std::max(rim, height(last));
    if (rim == -infinite) {
      continue;  // ends that lie, as at an open end
    }
    for (const WallFace<2>& face : boundary.faces) {
      // The water stands on faces that look up.
      if (face.wall != static_cast<int>(w) || up.dot(face.normal) < 0.01) {
        continue;
      }
      for (const Vec<2>& corner : face.corners) {
        const bool is_end = std::ranges::any_of(std::array{0ul, last}, [&](std::size_t k) {
          return (corner - Vec<2>(points[k][0], points[k][1])).norm() <= corner_tolerance * spec.particles.spacing;
        });
        if (!is_end && up.dot(corner) >= rim) {
          error(findings,
                "{} has a crest at {} as high as its ends, {:.6g} m over the higher one: water would run over the ends "
                "before it passes the crest; make the ends higher or the crest lower",
                wall_label(boundary, static_cast<int>(w)), place(corner), up.dot(corner) - rim);
          return;
        }
      }
    }
  }
}

/// Is this a body that stands in the water? Where it rests on another wall, the two touch back to back and stay dry.
bool is_obstacle(const WallTable& wall) {
  return wall.fluid_side == FluidSide::outside || (wall.shape == WallShape::box && wall.fluid_side == FluidSide::right);
}

/// Looks straight through every wall, from points of its wet side spaced dx (at most 50 per edge).
template <int Dim>
void check_thickness(const CaseSpec& spec, const Boundary<Dim>& boundary, std::vector<Finding>& findings) {
  const double dx = spec.particles.spacing;
  const double tolerance = corner_tolerance * dx;
  const double needed = dummy_layers(spec) * dx;
  std::map<std::pair<int, int>, bool> is_reported;
  for (const WallFace<Dim>& face : boundary.faces) {
    const double edge = (face.corners[1] - face.corners[0]).norm();
    const int samples = std::clamp(static_cast<int>(std::ceil(edge / dx)), 1, 50);
    for (const WallFace<Dim>& other : boundary.faces) {
      const double facing = -face.normal.dot(other.normal);
      const bool is_neighbour = facing < 0.999 && shares_corner(face, other, tolerance);
      if (&other == &face || facing <= 0.0 || is_neighbour) {
        continue;
      }
      for (int k = 0; k < samples; ++k) {
        const double share = (k + 0.5) / samples;
        Vec<Dim> foot = face.corners[0] + share * (face.corners[1] - face.corners[0]);
        if constexpr (Dim == 3) {
          foot += 0.5 * (1.0 - share) * (face.corners[2] - face.corners[0]);
        }
        // From just before the wall, so that a wall without thickness is passed as well.
        if (!crosses(other, Vec<Dim>(foot + 2.0 * tolerance * face.normal), Vec<Dim>(foot - needed * face.normal),
                     tolerance)) {
          continue;
        }
        const double thickness = std::max(0.0, -other.height(foot) / facing);
        const bool rests_on_it =
            thickness <= 2.0 * tolerance && (is_obstacle(spec.walls[face.wall]) || is_obstacle(spec.walls[other.wall]));
        const std::pair<int, int> walls = std::minmax(face.wall, other.wall);
        if (!rests_on_it && thickness < needed - tolerance && !std::exchange(is_reported[walls], true)) {
          error(findings,
                "{} is only {:.3g} m thick at {}, with {} on its other side: its {} layers of wall particles "
                "need {:.6g} m; make it thicker or the spacing smaller",
                wall_label(boundary, face.wall), thickness, place(foot),
                face.wall == other.wall ? "the water" : wall_label(boundary, other.wall), dummy_layers(spec), needed);
        }
        break;
      }
    }
  }
}

template <int Dim>
void check_periodic(const CaseSpec& spec, std::vector<Finding>& findings) {
  const double support = spec.scheme.support * spec.particles.spacing;
  for (int axis = 0; axis < Dim; ++axis) {
    const std::vector<double>& range = periodic_range(spec.domain, axis);
    if (range.size() == 2 && range[1] - range[0] < (4.0 - corner_tolerance) * support) {
      error(findings,
            "periodic_{} from {:.6g} to {:.6g} is {:.6g} m wide, less than four kernel supports of {:.6g} m, so "
            "that a particle would meet its own image: make it at least {:.6g} m wide, or the spacing at most {:.6g} m",
            "xyz"[axis], range[0], range[1], range[1] - range[0], support, 4.0 * support,
            (range[1] - range[0]) / (4.0 * spec.scheme.support));
    }
  }
}

/// Points `first`, ..., `last` with at most `step` (m) between them; at most 200.
template <int Dim>
std::vector<Vec<Dim>> points_along(const Vec<Dim>& first, const Vec<Dim>& last, double step) {
  const int pieces = std::clamp(static_cast<int>(std::ceil((last - first).norm() / step)), 1, 200);
  std::vector<Vec<Dim>> points;
  for (int k = 0; k <= pieces; ++k) points.push_back(first + (static_cast<double>(k) / pieces) * (last - first));
  return points;
}

/// The rim of an outlet, points at most dx apart, but for its top: there it may be open to the air.
template <int Dim>
std::vector<Vec<Dim>> closed_rim(const Outlet<Dim>& outlet, const Vec<Dim>& gravity, double dx) {
  std::vector<Vec<Dim>> rim;
  if constexpr (Dim == 2) {
    rim = {outlet.corner, outlet.corner + outlet.edges[0]};
  } else {
    for (int k = 0; k < 2; ++k) {
      for (const Vec<3>& start : {outlet.corner, Vec<3>(outlet.corner + outlet.edges[1 - k])}) {
        const std::vector<Vec<3>> side = points_along<3>(start, start + outlet.edges[k], dx);
        rim.insert(rim.end(), side.begin(), side.end());
      }
    }
  }
  const auto depth_of = [&](const Vec<Dim>& x) { return gravity.dot(x); };
  const auto [top, bottom] = std::minmax_element(
      rim.begin(), rim.end(), [&](const Vec<Dim>& a, const Vec<Dim>& b) { return depth_of(a) < depth_of(b); });
  const double open_above = depth_of(*top) + corner_tolerance * dx * gravity.norm();
  if (depth_of(*bottom) > open_above) std::erase_if(rim, [&](const Vec<Dim>& x) { return depth_of(x) <= open_above; });
  return rim;
}

/// Places before an outlet, and in it, as far upstream as `depth` (m), dx/2 apart and away from the rim.
template <int Dim>
std::vector<Vec<Dim>> places_before(const Outlet<Dim>& outlet, double depth, double dx) {
  const double step = 0.5 * dx;
  std::vector<Vec<Dim>> places = points_along<Dim>(outlet.corner, outlet.corner - depth * outlet.normal, step);
  for (const Vec<Dim>& edge : outlet.edges) {
    const double length = edge.norm();
    if (length <= 2.0 * step) return {};
    const Vec<Dim> along = edge / length;
    std::vector<Vec<Dim>> more;
    for (const Vec<Dim>& x : places) {
      const std::vector<Vec<Dim>> row = points_along<Dim>(x + step * along, x + (length - step) * along, step);
      more.insert(more.end(), row.begin(), row.end());
    }
    places = std::move(more);
  }
  return places;
}

template <int Dim>
void check_outlets(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid,
                   std::vector<Finding>& findings) {
  constexpr double rim_tolerance = 0.1;    // dx
  constexpr double wall_clearance = 0.25;  // dx
  const double dx = spec.particles.spacing;
  const Vec<Dim> gravity = to_vec<Dim>(spec.physics.gravity, "[physics]", "gravity");
  for (const Outlet<Dim>& outlet : make_outlets<Dim>(spec)) {
    const std::string name = fmt::format("outlet '{}'", outlet.name);
    for (int axis = 0; axis < Dim; ++axis) {
      if (!periodic_range(spec.domain, axis).empty() && std::abs(outlet.normal[axis]) > corner_tolerance) {
        error(findings,
              "{} at {} lets water out in {}, a periodic direction, in which it comes back: take one of them out", name,
              place(outlet.corner), "xyz"[axis]);
      }
    }

    for (const Vec<Dim>& x : closed_rim(outlet, gravity, dx)) {
      const NearestWall<Dim> wall = boundary.nearest(x, infinite);
      if (wall.face < 0) {
        error(findings, "{} has its rim at {}, but the case has no wall: end a bed there", name, place(x));
        break;
      }
      if (std::abs(wall.signed_distance) > rim_tolerance * dx) {
        error(findings,
              "{} {} at {}: the nearest place of {} is {}, {:.6g} m away; put the outlet's end on the wall there", name,
              wall.signed_distance > 0.0 ? "leaves a gap to the walls" : "reaches behind the walls", place(x),
              wall_label(boundary, boundary.faces[wall.face].wall), place(wall.point), std::abs(wall.signed_distance));
        break;
      }
    }

    for (const Vec<Dim>& x : places_before(outlet, spec.scheme.support * dx, dx)) {
      const NearestWall<Dim> wall = boundary.nearest(x, wall_clearance * dx);
      if (wall.face >= 0) {
        error(findings,
              "{} overlaps {} at {}: nothing may stand in it, nor in the last {:.6g} m before it; leave that piece of "
              "wall "
              "out (of a box: open = [...]), or move the outlet",
              name, wall_label(boundary, boundary.faces[wall.face].wall), place(wall.point), spec.scheme.support * dx);
        break;
      }
    }

    std::size_t passed = 0;
    std::size_t first = 0;
    for (std::size_t i = 0; i < fluid.position.size(); ++i) {
      const Vec<Dim>& x = fluid.position[i];
      if (outlet.beyond(x) > corner_tolerance * dx && outlet.spans(x) && passed++ == 0) first = i;
    }
    if (passed > 0) {
      error(
          findings,
          "{} cuts through {}: {} particles lie beyond it at the start, the first at {}; end the block at the outlet, "
          "move the outlet, or turn its direction round",
          name, fluid_name(spec, fluid.block[first]), passed, place(fluid.position[first]));
    }
  }
}

template <int Dim>
void check_leaks(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid,
                 std::vector<Finding>& findings) {
  const bool has_gravity =
      std::any_of(spec.physics.gravity.begin(), spec.physics.gravity.end(), [](double g) { return g != 0.0; });
  if (!has_gravity || boundary.faces.empty() || fluid.position.empty()) {
    return;
  }
  // Outlets count as closed.
  std::vector<WallFace<Dim>> faces = boundary.faces;
  for (const Outlet<Dim>& outlet : make_outlets<Dim>(spec)) {
    const std::vector<WallFace<Dim>> closing = outlet.as_faces();
    faces.insert(faces.end(), closing.begin(), closing.end());
  }
  constexpr double most_cells = 4e6;
  const CellSpace<Dim> space(spec, std::move(faces), fluid.position, most_cells);
  const Vec<Dim> down = to_vec<Dim>(spec.physics.gravity, "[physics]", "gravity").normalized();
  if (const auto leak = spread(space, cells_of<Dim>(space, fluid.position), down).way_out) {
    const NearestWall<Dim> wall = boundary.nearest(*leak, infinite);
    error(findings, "the water would pour out of the case at {}, near {}: close the wall there, or make it higher",
          place(*leak), wall_label(boundary, boundary.faces[wall.face].wall));
  }
}

}  // namespace

template <int Dim>
std::vector<Finding> check_geometry(const CaseSpec& spec, const Boundary<Dim>& boundary,
                                    const FluidParticles<Dim>& fluid) {
  std::vector<Finding> findings;
  check_blocks(spec, fluid, findings);
  check_periodic<Dim>(spec, findings);
  if constexpr (Dim == 2) {
    check_crossings(spec, boundary, findings);
    check_humps(spec, boundary, findings);
  }
  check_thickness(spec, boundary, findings);
  check_overlaps(spec, fluid, findings);
  check_contact(spec, boundary, fluid, findings);
  check_outlets(spec, boundary, fluid, findings);
  check_leaks(spec, boundary, fluid, findings);
  const std::vector<Finding> of_motion = check_motion(spec, boundary, fluid);
  findings.insert(findings.end(), of_motion.begin(), of_motion.end());
  return findings;
}

template <int Dim>
ParticleCount expected_particle_count(const CaseSpec& spec) {
  const double dx = spec.particles.spacing;
  ParticleCount count;
  for (std::size_t b = 0; b < spec.fluid.size(); ++b) {
    const FluidTable& block = spec.fluid[b];
    const std::string name = fluid_name(spec, static_cast<int>(b));
    if (block.shape == BlockShape::polygon) {
      count.fluid += block.points.empty() ? 0.0 : std::abs(signed_area(block.points)) / power<Dim>(dx);
    } else {
      const Vec<Dim> extent = to_vec<Dim>(block.max, name, "max") - to_vec<Dim>(block.min, name, "min");
      count.fluid += (extent / dx).array().round().max(1.0).prod();
    }
  }
  const int layers = spec.scheme.walls == WallTreatment::pressure_rows ? 1 : dummy_layers(spec);
  for (const WallFace<Dim>& face : make_boundary<Dim>(spec).faces) {
    count.wall += layers * face.measure() * dx / power<Dim>(dx);
  }
  return count;
}

template <int Dim>
double neighbours_in_support(double support) {
  return std::numbers::pi * (Dim == 2 ? 1.0 : 4.0 / 3.0) * power<Dim>(support);
}

/// bytes; what a run takes without any particle, libraries included
constexpr double program_memory = 5e7;

template <int Dim>
double memory_estimate(double particles, double walls, double neighbours) {
  constexpr double number = sizeof(double);
  constexpr double index = 4.0;
  // Position, velocity, their predicted and old values, force and shift; pressure, volume, viscosity and the like;
  // twice, for the state before the step and the solver's vectors.
  constexpr double fields = 2.0 * (6 * Dim + 10) * number;
  // Per pair: the neighbour's index, unit vector, distance, kernel and its derivative; a row entry of the matrix with
  // its place, and one of its factors.
  constexpr double pair = index + (Dim + 3) * number + 3.0 * index + 2.0 * number;
  // Rows of dummies hold the fluid's half of their neighbourhood.
  const double pairs = (particles + 0.5 * walls) * neighbours;
  // Lists grow by doubling and libraries keep buffers: summary.json's peak, less the program, is 1.8 times the arrays
  // for cases/zhou1999 at dx = 0.003 m (422 MB) and 1.3 times for a 3D tank of 12 800 fluid particles (322 MB).
  constexpr double slack = 1.9;
  return program_memory + slack * ((particles + walls) * fields + pairs * pair);
}

double available_memory() {
  std::ifstream file("/proc/meminfo");
  std::string key, unit;
  for (double kibibytes = 0.0; file >> key >> kibibytes;) {
    std::getline(file, unit);
    if (key == "MemAvailable:") {
      return 1024.0 * kibibytes;
    }
  }
  throw IoError("/proc/meminfo has no line MemAvailable: cannot tell whether the case fits into memory");
}

template <int Dim>
std::vector<Finding> check_memory(const CaseSpec& spec, double available) {
  const ParticleCount count = expected_particle_count<Dim>(spec);
  const double needed = memory_estimate<Dim>(count.fluid, count.wall, neighbours_in_support<Dim>(spec.scheme.support));
  std::vector<Finding> findings;
  if (needed > available) {
    // The particles' memory grows like dx^-Dim.
    const double too_much = (needed - program_memory) / std::max(available - program_memory, 1.0);
    const double fitting = spec.particles.spacing * std::pow(too_much, 1.0 / Dim);
    error(findings,
          "a spacing of {:.6g} m makes {:.3g} fluid and {:.3g} wall particles, which need {:.3g} GB of memory; "
          "{:.3g} GB are free: use a spacing of at least {:.3g} m",
          spec.particles.spacing, count.fluid, count.wall, needed / 1e9, available / 1e9, fitting);
  }
  return findings;
}

#define TAILWATER_INSTANTIATE(Dim)                                                                                 \
  template std::vector<Finding> check_geometry(const CaseSpec&, const Boundary<Dim>&, const FluidParticles<Dim>&); \
  template ParticleCount expected_particle_count<Dim>(const CaseSpec&);                                            \
  template double neighbours_in_support<Dim>(double);                                                              \
  template double memory_estimate<Dim>(double, double, double);                                                    \
  template std::vector<Finding> check_memory<Dim>(const CaseSpec&, double);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
