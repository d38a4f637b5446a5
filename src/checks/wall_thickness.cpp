#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/box.h"
#include "checks/cell_space.h"
#include "checks/checks.h"
#include "checks/face_samples.h"
#include "geometry/crossing.h"
#include "geometry/face_grid.h"
#include "geometry/from_spec.h"
#include "geometry/images.h"
#include "geometry/opening.h"
#include "geometry/wall_label.h"

namespace tailwater {
namespace {

/// -n_a.n_b of two faces back to back; above it they count as parallel.
constexpr double max_facing_of_wedge = 0.999;
/// Least thickness beside a lip over that of the wedge which its two faces make. A curve towards the lip makes a wall
/// thinner than the wedge, but hardly so where both are thinner than the layers.
constexpr double min_fraction_of_wedge = 0.5;

/// The corners of `a` that are corners of `b` too.
template <int Dim>
std::vector<Vec<Dim>> shared_corners(const WallFace<Dim>& a, const WallFace<Dim>& b, double tolerance) {
  std::vector<Vec<Dim>> shared;
  for (const Vec<Dim>& p : a.corners) {
    if (std::ranges::any_of(b.corners, [&](const Vec<Dim>& q) { return (p - q).norm() <= tolerance; })) {
      shared.push_back(p);
    }
  }
  return shared;
}

/// A sharp edge at which two faces meet, or in 3D a point.
template <int Dim>
struct Lip {
  std::pair<int, int> walls;  ///< of the two faces, ascending
  Vec<Dim> begin, end;        ///< m
  double slope;               ///< tangent of the angle between the faces: thickness over distance

  double distance(const Vec<Dim>& x) const {
    const Vec<Dim> along = end - begin;
    const double squared = along.squaredNorm();
    const double share = squared > 0.0 ? std::clamp((x - begin).dot(along) / squared, 0.0, 1.0) : 0.0;
    return (begin + share * along - x).norm();
  }
};

/// Whether this is a body in the water. Where it rests on another wall, the two touch back to back and stay dry.
bool is_obstacle(const WallTable& wall) {
  return wall.fluid_side == FluidSide::outside || (wall.shape == WallShape::box && wall.fluid_side == FluidSide::right);
}

/// The faces and cells that water can reach, from its start and from open ends. The open ends, and the box around all
/// walls, count as closed.
template <int Dim>
class WetFaces {
 public:
  WetFaces(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid)
      : domain_(boundary.domain),
        ends_(make_open_ends<Dim>(spec)),
        space_(spec, faces_with(boundary, ends_), fluid.box(), max_cells_of_case),
        is_wet_(space_.count(), false) {
    std::vector<typename CellSpace<Dim>::Cell> start = cells_of<Dim>(space_, fluid);
    for (const Opening<Dim>& end : ends_) {
      Vec<Dim> middle = end.corner;
      for (const Vec<Dim>& edge : end.edges) middle += 0.5 * edge;
      start.push_back(space_.cell_of(middle - 0.5 * spec.particles.spacing * end.normal));
    }
    const Spread<Dim> reached = spread(space_, start, Vec<Dim>(Vec<Dim>::Zero()), Edge::holds);
    wet_ = reached.wet;
    for (const auto& cell : reached.cells) is_wet_[space_.index(cell)] = true;
  }

  /// Whether water can reach the front of a face, of this index, at the place x on it.
  bool holds(int index, const WallFace<Dim>& face, const Vec<Dim>& x) const {
    const Vec<Dim> in_front = wrapped<Dim>(domain_, Vec<Dim>(x + space_.edge() * face.normal));
    return wet_[index] && is_wet_[space_.index(space_.cell_of(in_front))];
  }

 private:
  PeriodicDomain<Dim> domain_;
  std::vector<Opening<Dim>> ends_;
  CellSpace<Dim> space_;
  std::vector<bool> wet_;     ///< by face
  std::vector<bool> is_wet_;  ///< by cell
};

/// A face, or its image in the next period.
template <int Dim>
struct FaceOrImage {
  int index;  ///< into Boundary::faces
  WallFace<Dim> face;
  bool is_image;
};

/// Lists the faces that may be behind others, or meet them.
template <int Dim>
class FacesBehind {
 public:
  /// `reach` [m]: search distance behind a face
  FacesBehind(const Boundary<Dim>& boundary, double reach) : grid_(reach) {
    const Box<Dim> space = space_around<Dim>(boundary.domain, reach);
    boundary.visit_plain_faces([&](int f) {
      faces_.push_back({f, boundary.faces[f], false});
      visit_images<Dim>(boundary.domain, boundary.faces[f].box(), space, [&](const Vec<Dim>& moved) {
        faces_.push_back({f, boundary.faces[f].moved(moved), true});
      });
    });
    for (int k = 0; k < static_cast<int>(faces_.size()); ++k) {
      const WallFace<Dim>& face = faces_[k].face;
      const Box<Dim> box = face.box();
      grid_.add(k, box.min(), box.max(), [&](const Vec<Dim>& x) { return (closest_point(face, x) - x).norm(); });
    }
  }

  /// The faces near the sampled places of the face, in their order.
  std::vector<FaceOrImage<Dim>> of(const WallFace<Dim>& face, double dx) const {
    std::set<int> found;
    const int samples = samples_along(face, dx);
    for (int k = 0; k < samples; ++k) {
      const std::span<const int> near = grid_.near(sample_of(face, k, samples));
      found.insert(near.begin(), near.end());
    }
    return listed(found);
  }
  /// The faces that may meet the face at its corners, in their order.
  std::vector<FaceOrImage<Dim>> at_corners_of(const WallFace<Dim>& face) const {
    std::set<int> found;
    for (const Vec<Dim>& corner : face.corners) {
      const std::span<const int> near = grid_.near(corner);
      found.insert(near.begin(), near.end());
    }
    return listed(found);
  }

 private:
  std::vector<FaceOrImage<Dim>> listed(const std::set<int>& found) const {
    std::vector<FaceOrImage<Dim>> list;
    for (const int k : found) list.push_back(faces_[k]);
    return list;
  }

  std::vector<FaceOrImage<Dim>> faces_;
  FaceGrid<Dim> grid_;
};

/// The lips of all walls but plates.
template <int Dim>
std::vector<Lip<Dim>> find_lips(const Boundary<Dim>& boundary, const FacesBehind<Dim>& faces, double tolerance) {
  std::vector<Lip<Dim>> lips;
  boundary.visit_plain_faces([&](int f) {
    const WallFace<Dim>& face = boundary.faces[f];
    for (const FaceOrImage<Dim>& beside : faces.at_corners_of(face)) {
      const int g = beside.index;
      const WallFace<Dim>& other = beside.face;
      const double facing = -face.normal.dot(other.normal);
      if (g <= f || facing <= 0.0 || facing >= max_facing_of_wedge) continue;
      const std::vector<Vec<Dim>> shared = shared_corners(face, other, tolerance);
      if (shared.empty()) continue;
      const std::pair<int, int> walls = std::minmax(face.wall, other.wall);
      lips.push_back({walls, shared.front(), shared.back(), std::sqrt(1.0 - facing * facing) / facing});
    }
  });
  return lips;
}

/// The first sample of `face` that has the back of `other` behind it within `depth` and for which `is_thin` holds.
template <int Dim, class IsThin>
std::optional<Vec<Dim>> place_with_other_behind(const WallFace<Dim>& face, const WallFace<Dim>& other, double depth,
                                                double dx, IsThin&& is_thin) {
  const double tolerance = corner_tolerance * dx;
  const int samples = samples_along(face, dx);
  for (int k = 0; k < samples; ++k) {
    const Vec<Dim> foot = sample_of(face, k, samples);
    // Starts just in front of the wall, so that a wall without thickness is passed as well.
    if (crosses(other, Vec<Dim>(foot + 2.0 * tolerance * face.normal), Vec<Dim>(foot - depth * face.normal),
                tolerance) &&
        is_thin(foot)) {
      return foot;
    }
  }
  return std::nullopt;
}

/// The finding at a place of a face with another one behind it.
template <int Dim>
Finding thin_wall(const CaseSpec& spec, const Boundary<Dim>& boundary, const WallFace<Dim>& face,
                  const FaceOrImage<Dim>& behind, const Vec<Dim>& where, double width) {
  const int layers = dummy_layers(spec);
  const double needed = layers * spec.particles.spacing;
  const Amount thickness{width, "m"};
  const CaseLabel owner = wall_label(boundary, face.wall);
  const int other = behind.face.wall;
  const std::string beyond = face.wall == other ? "the water" : wall_label(boundary, other).text();
  if (behind.is_image) {
    return Finding::error(
        "wall-between-periods",
        {"{} is only {:.3g} thick at {}, with {} of the next period on its other side: its {} layers of wall "
         "particles need {:.6g} m",
         owner, thickness, place(where), beyond, layers, needed},
        {"leave the wall out there (of a box: open = [...]), because the case repeats itself, or remove "
         "domain.periodic_*"});
  }
  return Finding::error(
      "wall-too-thin",
      {"{} is only {:.3g} thick at {}, with {} on its other side: its {} layers of wall particles need {:.6g} m", owner,
       thickness, place(where), beyond, layers, needed},
      {"make it thicker, or the spacing smaller, or draw it without thickness, with shape = \"plate\""});
}

}  // namespace

template <int Dim>
Findings check_wall_thickness(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  const double dx = spec.particles.spacing;
  const double tolerance = corner_tolerance * dx;
  const double needed = dummy_layers(spec) * dx;
  Findings findings;
  std::set<std::pair<int, int>> reported;
  std::optional<WetFaces<Dim>> wet;  // computed on demand
  // Another wall ends the layers of a wall, even if it stays dry (sampling/wall_layers.h).
  const auto leaves_out_layers = [&](const WallFace<Dim>& face, const WallFace<Dim>& other, const Vec<Dim>& x) {
    return face.wall != other.wall && !cross_near<Dim>(boundary, face.wall, other.wall, x, needed);
  };
  const FacesBehind<Dim> faces_behind(boundary, needed + 3.0 * tolerance);
  std::optional<std::vector<Lip<Dim>>> lips;  // computed on demand
  // Beside a sharp edge a wall is a wedge, whether its sides are straight or made of short pieces.
  const auto is_wedge = [&](const std::pair<int, int>& walls, const Vec<Dim>& foot, double thickness) {
    if (!lips) lips = find_lips(boundary, faces_behind, tolerance);
    return std::ranges::any_of(*lips, [&](const Lip<Dim>& lip) {
      return lip.walls == walls && thickness >= min_fraction_of_wedge * lip.slope * lip.distance(foot);
    });
  };
  boundary.visit_plain_faces([&](int f) {
    const WallFace<Dim>& face = boundary.faces[f];
    for (const FaceOrImage<Dim>& behind_face : faces_behind.of(face, dx)) {
      const int g = behind_face.index;
      const WallFace<Dim>& other = behind_face.face;
      const double facing = -face.normal.dot(other.normal);
      const std::pair<int, int> walls = std::minmax(face.wall, other.wall);
      const bool is_plate = boundary.walls[face.wall].is_plate || boundary.walls[other.wall].is_plate;
      if (g == f || facing <= 0.0 || is_plate || reported.contains(walls)) continue;
      const bool may_be_wedge = facing < max_facing_of_wedge;
      if (may_be_wedge && !shared_corners(face, other, tolerance).empty()) continue;
      const bool is_obstacle_on_wall = is_obstacle(spec.walls[face.wall]) || is_obstacle(spec.walls[other.wall]);
      const auto thickness_at = [&](const Vec<Dim>& foot) { return std::max(0.0, -other.height(foot) / facing); };
      const std::optional<Vec<Dim>> foot = place_with_other_behind(face, other, needed, dx, [&](const Vec<Dim>& x) {
        const double thickness = thickness_at(x);
        const bool rests_on_it = is_obstacle_on_wall && thickness <= 2.0 * tolerance;
        const bool is_thin = !rests_on_it && thickness < needed - tolerance;
        if (!is_thin || (may_be_wedge && is_wedge(walls, x, thickness))) return false;
        // A body that reaches through the bed does no harm: there is no water below.
        if (!wet) wet.emplace(spec, boundary, fluid);
        if (!wet->holds(f, face, x)) return false;
        return leaves_out_layers(face, other, x) || wet->holds(g, other, Vec<Dim>(x - thickness * face.normal));
      });
      if (!foot) continue;
      reported.insert(walls);
      findings.push_back(thin_wall(spec, boundary, face, behind_face, *foot, thickness_at(*foot)));
    }
  });
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_wall_thickness);

}  // namespace tailwater
