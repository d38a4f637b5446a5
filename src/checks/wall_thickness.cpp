#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "checks/checks.h"
#include "checks/face_samples.h"
#include "geometry/from_spec.h"

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

/// The first sample of `face` that has the back of `other` behind it within `depth`.
template <int Dim>
std::optional<Vec<Dim>> place_with_other_behind(const WallFace<Dim>& face, const WallFace<Dim>& other, double depth,
                                                double dx) {
  const double tolerance = corner_tolerance * dx;
  const int samples = samples_along(face, dx);
  for (int k = 0; k < samples; ++k) {
    const double share = (k + 0.5) / samples;
    Vec<Dim> foot = face.corners[0] + share * (face.corners[1] - face.corners[0]);
    if constexpr (Dim == 3) {
      foot += 0.5 * (1.0 - share) * (face.corners[2] - face.corners[0]);
    }
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
Findings check_wall_thickness(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const double dx = spec.particles.spacing;
  const double tolerance = corner_tolerance * dx;
  const double needed = dummy_layers(spec) * dx;
  Findings findings;
  std::set<std::pair<int, int>> reported;
  boundary.visit_plain_faces([&](int f) {
    const WallFace<Dim>& face = boundary.faces[f];
    boundary.visit_plain_faces([&](int g) {
      const WallFace<Dim>& other = boundary.faces[g];
      const double facing = -face.normal.dot(other.normal);
      const bool is_neighbour = facing < 0.999 && shares_corner(face, other, tolerance);
      const bool is_plate = boundary.walls[face.wall].is_plate || boundary.walls[other.wall].is_plate;
      if (&other == &face || facing <= 0.0 || is_neighbour || is_plate) return;
      const std::optional<Vec<Dim>> foot = place_with_other_behind(face, other, needed, dx);
      if (!foot) return;
      const double thickness = std::max(0.0, -other.height(*foot) / facing);
      const bool rests_on_it =
          thickness <= 2.0 * tolerance && (is_obstacle(spec.walls[face.wall]) || is_obstacle(spec.walls[other.wall]));
      if (rests_on_it || thickness >= needed - tolerance) return;
      const std::pair<int, int> walls = std::minmax(face.wall, other.wall);
      if (!reported.insert(walls).second) return;
      findings.push_back(Finding::error(
          "{} is only {:.3g} m thick at {}, with {} on its other side: its {} layers of wall particles need {:.6g} m; "
          "make it thicker, or the spacing smaller",
          wall_label(boundary, face.wall), thickness, place(*foot),
          face.wall == other.wall ? "the water" : wall_label(boundary, other.wall), dummy_layers(spec), needed));
    });
  });
  return findings;
}

template Findings check_wall_thickness(const CaseSpec&, const Boundary<2>&);
template Findings check_wall_thickness(const CaseSpec&, const Boundary<3>&);

}  // namespace tailwater
