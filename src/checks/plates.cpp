#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "case/formulation.h"
#include "checks/checks.h"
#include "checks/face_samples.h"
#include "geometry/plate_shape.h"
#include "geometry/wall_label.h"

namespace tailwater {
namespace {

constexpr double lying_on = 0.1;                   // dx; smaller gaps between plates are not drawn on purpose
constexpr double reach_of_plate_along_wall = 0.5;  // dx; a narrower gap between a plate and a wall counts as closed
constexpr double parallel_cosine = 0.999;          // within 2.6 degrees

/// Whether a place of a plate with this normal lies on a face of another wall.
template <int Dim>
bool lies_on_plate(const WallFace<Dim>& face, const Vec<Dim>& x, const Vec<Dim>& normal, double dx) {
  return std::abs(face.normal.dot(normal)) > parallel_cosine && (closest_point(face, x) - x).norm() <= lying_on * dx;
}

/// The finding about a place of a plate that lies on another wall, which may be a plate as well.
template <int Dim>
Finding finding_on_wall(const Boundary<Dim>& boundary, int plate, int other, const Vec<Dim>& where) {
  const CaseLabel a = wall_label(boundary, plate);
  const CaseLabel b = wall_label(boundary, other);
  if (boundary.walls[other].is_plate) {
    return Finding::warning(
        "plates-overlap",
        {"{} and {} lie on each other at {}, so a force probe cannot separate their forces", a, b, place(where)},
        {"draw only one of them there, or let force probes read both"});
  }
  Finding finding = Finding::error(
      "plate-along-wall",
      {"{} lies along {} at {}, without water between them: still water beside such a plate does not stay at rest", a,
       b, place(where)},
      {"remove this part of the plate, or end the plate where it meets the wall"});
  // A plate that moves may leave the wall.
  if (boundary.walls[plate].body != boundary.walls[other].body) finding.severity = Severity::warning;
  return finding;
}

/// Plates that lie on other plates or along walls, one finding for each two walls.
template <int Dim>
Findings find_plates_on_walls(const Boundary<Dim>& boundary, double dx) {
  Findings findings;
  std::set<std::pair<int, int>> reported;
  const auto report = [&](int plate, int other, const Vec<Dim>& where) {
    if (reported.insert({std::min(plate, other), std::max(plate, other)}).second)
      findings.push_back(finding_on_wall(boundary, plate, other, where));
  };
  const Vec<Dim> margin = Vec<Dim>::Constant(lying_on * dx);
  for (const WallPlate& plate : boundary.plates) {
    for (int f = plate.first_face; f < plate.first_face + plate.pieces; ++f) {
      const WallFace<Dim>& face = boundary.faces[f];
      const Box<Dim> box = face.box();
      const Box<Dim> around(Vec<Dim>(box.min() - margin), Vec<Dim>(box.max() + margin));
      std::vector<int> plates_near;
      for (const WallPlate& other : boundary.plates) {
        if (other.wall == plate.wall) continue;
        for (int g = other.first_face; g < other.first_face + other.pieces; ++g) {
          if (around.intersects(boundary.faces[g].box())) plates_near.push_back(g);
        }
      }
      const int samples = samples_along(face, dx);
      for (int k = 0; k < samples; ++k) {
        const Vec<Dim> x = sample_of(face, k, samples);
        for (const int g : plates_near) {
          if (lies_on_plate(boundary.faces[g], x, face.normal, dx)) report(plate.wall, boundary.faces[g].wall, x);
        }
        const WallBesidePlate beside = wall_beside_plate(boundary, x);
        if (beside.face < 0 || std::abs(beside.distance) > reach_of_plate_along_wall * dx) continue;
        const WallFace<Dim>& wall = boundary.faces[beside.face];
        // Beyond the end of a wall the plate may go on in the same direction.
        const bool is_above = std::abs(wall.height(x)) >= std::abs(beside.distance) - lying_on * dx;
        if (is_above && std::abs(wall.normal.dot(face.normal)) > parallel_cosine) report(plate.wall, wall.wall, x);
      }
    }
  }
  return findings;
}

}  // namespace

template <int Dim>
Findings check_plates(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  if (boundary.plates.empty()) return {};
  if (!traits_of(spec).walls.on_wall) return find_plates_on_walls<Dim>(boundary, spec.particles.spacing);
  return {Finding::error(
      "plate-needs-robust",
      {"{} is a plate, and the published formulation puts particles on the wall itself: the water on both sides "
       "would interact with them",
       wall_label(boundary, boundary.plates.front().wall)},
      {"choose scheme.formulation = \"robust\", or draw a wall with two faces"})};
}

TAILWATER_IN_2D_AND_3D(check_plates);

}  // namespace tailwater
