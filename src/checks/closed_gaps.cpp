#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "checks/checks.h"
#include "checks/face_samples.h"
#include "geometry/from_spec.h"
#include "geometry/mesh_surface.h"
#include "geometry/plate_shape.h"

namespace tailwater {
namespace {

constexpr double closed = 0.5;   // dx; a plate that ends as near to a wall leaves no opening (Boundary::hang_screens)
constexpr double touches = 0.1;  // dx; nobody would draw as narrow an opening

/// Rows of particles that an opening should have.
constexpr double least_rows_in_gap = 4.0;

/// Walls that face each other within 45 degrees.
constexpr double least_facing_of_gap = 0.7;

/// An opening between two walls that is too narrow for water.
template <int Dim>
struct Gap {
  int wall;
  int other;
  double width;  ///< m
  Vec<Dim> where;
};

/// The edges at which a plate ends, as points at most dx apart.
std::vector<std::vector<Vec<2>>> ends_of(const Boundary<2>& boundary, const WallPlate& plate, double /*dx*/) {
  return {{boundary.faces[plate.first_face].corners[0]},
          {boundary.faces[plate.first_face + plate.pieces - 1].corners[1]}};
}

std::vector<Vec<3>> points_of_edge(const Vec<3>& from, const Vec<3>& to, double dx) {
  const int pieces = std::max(1, static_cast<int>(std::ceil((to - from).norm() / dx)));
  std::vector<Vec<3>> points;
  for (int k = 0; k <= pieces; ++k) points.push_back(from + k * (to - from) / pieces);
  return points;
}

std::vector<std::vector<Vec<3>>> ends_of(const Boundary<3>& boundary, const WallPlate& plate, double dx) {
  std::vector<std::vector<Vec<3>>> edges;
  if (plate.sheet) {
    const TriangleMesh& mesh = plate.sheet->mesh();
    for (int t = 0; t < plate.pieces; ++t) {
      for (int e = 0; e < 3; ++e) {
        if (plate.sheet->neighbours()[t][e] >= 0) continue;
        edges.push_back(points_of_edge(mesh.corner(t, e), mesh.corner(t, (e + 1) % 3), dx));
      }
    }
    return edges;
  }
  const std::array<Vec<3>, 3>& first = boundary.faces[plate.first_face].corners;
  const std::array<Vec<3>, 4> corners{first[0], first[1], first[2], boundary.faces[plate.first_face + 1].corners[2]};
  for (int e = 0; e < 4; ++e) edges.push_back(points_of_edge(corners[e], corners[(e + 1) % 4], dx));
  return edges;
}

/// Where an edge of a plate is all along so near to a wall that it counts as closed, and is not on it.
template <int Dim>
std::optional<Gap<Dim>> gap_beside(const Boundary<Dim>& boundary, int plate, const std::vector<Vec<Dim>>& edge,
                                   double dx) {
  std::optional<Gap<Dim>> widest;
  for (const Vec<Dim>& x : edge) {
    const WallBesidePlate beside = wall_beside_plate(boundary, x);
    if (beside.distance > closed * dx) return std::nullopt;
    if (!widest || beside.distance > widest->width) widest = Gap<Dim>{plate, beside.wall, beside.distance, x};
  }
  if (!widest || widest->width <= touches * dx) return std::nullopt;
  return widest;
}

/// Where a face looks straight at another that is as near.
template <int Dim>
std::optional<Gap<Dim>> gap_between(const WallFace<Dim>& face, const WallFace<Dim>& other, double dx) {
  const double facing = -face.normal.dot(other.normal);
  if (facing < least_facing_of_gap || face.box().exteriorDistance(other.box()) > closed * dx) return std::nullopt;
  const double tolerance = corner_tolerance * dx;
  const int samples = samples_along(face, dx);
  for (int k = 0; k < samples; ++k) {
    const Vec<Dim> foot = sample_of(face, k, samples);
    const double width = other.height(foot) / facing;
    if (width <= touches * dx || width > closed * dx) continue;
    const Vec<Dim> hit = foot + width * face.normal;
    if ((closest_point(other, hit) - hit).norm() <= tolerance) return Gap<Dim>{face.wall, other.wall, width, foot};
  }
  return std::nullopt;
}

/// Between walls of one body that are no plates: near a corner, and in a fold, they are as near.
template <int Dim>
std::vector<Gap<Dim>> gaps_of(const Boundary<Dim>& boundary, double dx) {
  std::vector<Gap<Dim>> gaps;
  for (const WallPlate& plate : boundary.plates) {
    if (boundary.walls[plate.wall].moves()) continue;
    for (const std::vector<Vec<Dim>>& edge : ends_of(boundary, plate, dx)) {
      if (const auto gap = gap_beside<Dim>(boundary, plate.wall, edge, dx)) gaps.push_back(*gap);
    }
  }
  boundary.visit_plain_faces([&](int f) {
    const WallFace<Dim>& face = boundary.faces[f];
    if (boundary.walls[face.wall].moves()) return;
    boundary.visit_plain_faces([&](int g) {
      const WallFace<Dim>& other = boundary.faces[g];
      if (other.wall == face.wall || boundary.walls[other.wall].moves()) return;
      if (const auto gap = gap_between<Dim>(face, other, dx)) gaps.push_back(*gap);
    });
  });
  return gaps;
}

}  // namespace

template <int Dim>
Findings check_closed_gaps(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const double dx = spec.particles.spacing;
  Findings findings;
  std::set<std::pair<int, int>> reported;
  for (const Gap<Dim>& gap : gaps_of<Dim>(boundary, dx)) {
    if (!reported.insert(std::minmax(gap.wall, gap.other)).second) continue;
    findings.push_back(Finding::warning(
        "the gap of {:.3g} m between {} and {} at {} counts as closed, because it is narrower than half a spacing: "
        "let them touch if that is meant; for water that passes use a spacing of at most {:.3g} m",
        gap.width, wall_label(boundary, gap.wall), wall_label(boundary, gap.other), place(gap.where),
        gap.width / least_rows_in_gap));
  }
  return findings;
}

template Findings check_closed_gaps(const CaseSpec&, const Boundary<2>&);
template Findings check_closed_gaps(const CaseSpec&, const Boundary<3>&);

}  // namespace tailwater
