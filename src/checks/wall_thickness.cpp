#include <algorithm>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "base/box.h"
#include "checks/cell_space.h"
#include "checks/checks.h"
#include "checks/face_samples.h"
#include "geometry/face_grid.h"
#include "geometry/from_spec.h"
#include "geometry/opening.h"
#include "geometry/wall_label.h"

namespace tailwater {
namespace {

template <int Dim>
bool shares_corner(const WallFace<Dim>& a, const WallFace<Dim>& b, double tolerance) {
  return std::ranges::any_of(a.corners, [&](const Vec<Dim>& p) {
    return std::ranges::any_of(b.corners, [&](const Vec<Dim>& q) { return (p - q).norm() <= tolerance; });
  });
}

/// Whether this is a body in the water. Where it rests on another wall, the two touch back to back and stay dry.
bool is_obstacle(const WallTable& wall) {
  return wall.fluid_side == FluidSide::outside || (wall.shape == WallShape::box && wall.fluid_side == FluidSide::right);
}

/// The faces whose front water can reach, from its start and from open ends. The open ends, and the box around all
/// walls, count as closed.
template <int Dim>
std::vector<bool> wet_faces(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  const std::vector<Opening<Dim>> ends = make_open_ends<Dim>(spec);
  const CellSpace<Dim> space(spec, faces_with(boundary, ends), fluid.box(), max_cells_of_case);
  std::vector<typename CellSpace<Dim>::Cell> start = cells_of<Dim>(space, fluid);
  for (const Opening<Dim>& end : ends) {
    Vec<Dim> middle = end.corner;
    for (const Vec<Dim>& edge : end.edges) middle += 0.5 * edge;
    start.push_back(space.cell_of(middle - 0.5 * spec.particles.spacing * end.normal));
  }
  return spread(space, start, Vec<Dim>(Vec<Dim>::Zero()), Edge::holds).wet;
}

/// Lists the faces that may be behind others.
template <int Dim>
class FacesBehind {
 public:
  /// `reach` [m]: search distance behind a face
  FacesBehind(const Boundary<Dim>& boundary, double reach) : grid_(reach) {
    boundary.visit_plain_faces([&](int f) {
      const WallFace<Dim>& face = boundary.faces[f];
      const Box<Dim> box = face.box();
      grid_.add(f, box.min(), box.max(), [&](const Vec<Dim>& x) { return (closest_point(face, x) - x).norm(); });
    });
  }

  /// The faces near the sampled places of the face, in their order.
  std::vector<int> of(const WallFace<Dim>& face, double dx) const {
    std::set<int> found;
    const int samples = samples_along(face, dx);
    for (int k = 0; k < samples; ++k) {
      const std::span<const int> near = grid_.near(sample_of(face, k, samples));
      found.insert(near.begin(), near.end());
    }
    return {found.begin(), found.end()};
  }

 private:
  FaceGrid<Dim> grid_;
};

/// The first sample of `face` that has the back of `other` behind it within `depth`.
template <int Dim>
std::optional<Vec<Dim>> place_with_other_behind(const WallFace<Dim>& face, const WallFace<Dim>& other, double depth,
                                                double dx) {
  const double tolerance = corner_tolerance * dx;
  const int samples = samples_along(face, dx);
  for (int k = 0; k < samples; ++k) {
    const Vec<Dim> foot = sample_of(face, k, samples);
    // Starts just in front of the wall, so that a wall without thickness is passed as well.
    if (crosses(other, Vec<Dim>(foot + 2.0 * tolerance * face.normal), Vec<Dim>(foot - depth * face.normal),
                tolerance)) {
      return foot;
    }
  }
  return std::nullopt;
}

}  // namespace

template <int Dim>
Findings check_wall_thickness(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  const double dx = spec.particles.spacing;
  const double tolerance = corner_tolerance * dx;
  const double needed = dummy_layers(spec) * dx;
  Findings findings;
  std::set<std::pair<int, int>> reported;
  std::optional<std::vector<bool>> wet;  // by face; computed on demand
  const auto is_wet = [&](int face) {
    if (!wet) wet = wet_faces(spec, boundary, fluid);
    return wet->at(face);
  };
  const FacesBehind<Dim> faces_behind(boundary, needed + 3.0 * tolerance);
  boundary.visit_plain_faces([&](int f) {
    const WallFace<Dim>& face = boundary.faces[f];
    for (const int g : faces_behind.of(face, dx)) {
      const WallFace<Dim>& other = boundary.faces[g];
      const double facing = -face.normal.dot(other.normal);
      const bool is_neighbour = facing < 0.999 && shares_corner(face, other, tolerance);
      const bool is_plate = boundary.walls[face.wall].is_plate || boundary.walls[other.wall].is_plate;
      if (g == f || facing <= 0.0 || is_neighbour || is_plate) continue;
      const std::optional<Vec<Dim>> foot = place_with_other_behind(face, other, needed, dx);
      if (!foot) continue;
      const double thickness = std::max(0.0, -other.height(*foot) / facing);
      const bool rests_on_it =
          thickness <= 2.0 * tolerance && (is_obstacle(spec.walls[face.wall]) || is_obstacle(spec.walls[other.wall]));
      if (rests_on_it || thickness >= needed - tolerance) continue;
      const std::pair<int, int> walls = std::minmax(face.wall, other.wall);
      // A body that reaches through the bed does no harm: there is no water below.
      if (reported.contains(walls) || !is_wet(f) || !is_wet(g)) continue;
      reported.insert(walls);
      findings.push_back(Finding::error(
          "wall-too-thin",
          {"{} is only {:.3g} thick at {}, with {} on its other side: its {} layers of wall particles need {:.6g} m",
           wall_label(boundary, face.wall), Amount{thickness, "m"}, place(*foot),
           face.wall == other.wall ? "the water" : wall_label(boundary, other.wall).text(), dummy_layers(spec), needed},
          {"make it thicker, or the spacing smaller, or draw it without thickness, with shape = \"plate\""}));
    }
  });
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_wall_thickness);

}  // namespace tailwater
