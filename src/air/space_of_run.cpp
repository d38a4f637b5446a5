#include "air/space_of_run.h"

#include <cmath>

#include "geometry/opening.h"
#include "motion/wall_motion.h"

namespace tailwater {
namespace {

/// Number of times in a run at which walls are evaluated, for the box around all their places.
constexpr int looks_at_moving_walls = 1000;

}  // namespace

template <int Dim>
Box<Dim> box_of_run(const CaseSpec& spec, const Setup<Dim>& setup, const Boundary<Dim>& boundary) {
  Box<Dim> box = box_around(boundary.faces);
  for (const Opening<Dim>& opening : make_open_ends<Dim>(spec)) box.extend(box_around(opening.as_faces()));
  const Vec<Dim> drawn = box.isEmpty() ? Vec<Dim>(Vec<Dim>::Zero()) : box.min();
  const MotionState<Dim> start = initial_motion<Dim>(spec);
  for (const auto& moving : setup.wall_motion->moving()) {
    if (moving.body >= 0) continue;  // it stays where water is
    for (int k = 0; k <= looks_at_moving_walls; ++k) {
      const AffineMap<Dim> placement = moving.at(spec.time.end * k / looks_at_moving_walls, start);
      for (const WallFace<Dim>& face : boundary.faces) {
        if (face.wall == moving.wall) box.extend(moved(placement, face).box());
      }
    }
  }
  if (box.isEmpty()) return box;
  const double cell = 0.5 * spec.particles.spacing;
  Vec<Dim> low = drawn;
  for (int d = 0; d < Dim; ++d) low[d] -= cell * std::ceil((drawn[d] - box.min()[d]) / cell - 1e-6);
  box.extend(low);
  return box;
}

TAILWATER_IN_2D_AND_3D(box_of_run);

}  // namespace tailwater
