#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "case/largest_tension.h"
#include "checks/cell_space.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/opening.h"
#include "geometry/wall_label.h"

namespace tailwater {
namespace {

/// [edge of a cell]; minimum height above its surface at which water counts as hanging.
constexpr double min_height = 2.0;

struct ConnectedWater {
  double surface = -std::numeric_limits<double>::infinity();  ///< m, upwards; highest place beside air
  double ceiling = -std::numeric_limits<double>::infinity();  ///< m; highest place below a wall
  int face_above = -1;                                        ///< face of that wall
  std::size_t cell_below = 0;
  bool is_at_end = false;  ///< an open end may press on it
};

/// Follows the water from a cell, and marks the cells that it reaches.
template <int Dim>
ConnectedWater follow(const CellSpace<Dim>& space, std::size_t first, const Vec<Dim>& up, std::size_t walls,
                      const std::vector<bool>& is_wet, std::vector<bool>& is_known) {
  ConnectedWater water;
  std::vector<std::size_t> found{first};
  is_known[first] = true;
  for (std::size_t k = 0; k < found.size(); ++k) {
    const auto c = space.cell(found[k]);
    const double height = up.dot(space.centre(c));
    for (int move = 0; move < 2 * Dim; ++move) {
      const int axis = move / 2;
      const int step = move % 2 == 0 ? -1 : 1;
      if (const int face = space.face_beside(c, axis, step); face >= 0) {
        water.is_at_end = water.is_at_end || static_cast<std::size_t>(face) >= walls;
        if (step * up[axis] > 0.5 && height > water.ceiling) {
          water.ceiling = height;
          water.face_above = face;
          water.cell_below = found[k];
        }
        continue;
      }
      const auto beside = space.next(c, axis, step);
      if (!beside || !is_wet[space.index(*beside)]) {
        // A single dry cell before a wall is the rest of one that the wall cuts.
        const bool is_cut = beside && space.face_beside(*beside, axis, step) >= 0;
        if (!is_cut) water.surface = std::max(water.surface, height);
      } else if (!is_known[space.index(*beside)]) {
        is_known[space.index(*beside)] = true;
        found.push_back(space.index(*beside));
      }
    }
  }
  return water;
}

}  // namespace

template <int Dim>
Findings check_hanging_water(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  if (gravity.isZero(0.0) || fluid.all == 0) return {};
  const CellSpace<Dim> space(spec, faces_with(boundary, make_open_ends<Dim>(spec)), fluid.box(), max_cells_of_case);
  std::vector<bool> is_wet(space.count(), false);
  std::vector<bool> is_known(space.count(), false);
  const auto water = cells_of<Dim>(space, fluid);
  for (const auto& c : water) is_wet[space.index(c)] = true;
  Findings findings;
  if (spec.physics.tension > largest_tension) {
    findings.push_back(Finding::warning(
        "tension-above-atmosphere",
        {"{} = {:.3g} is more than the pressure of the atmosphere, {:.0e} Pa: real water boils at this tension",
         CaseLabel("physics").with_key("tension"), Amount{spec.physics.tension, "Pa"}, largest_tension},
        {"give at most {:.0e} Pa", largest_tension}));
  }
  for (const auto& c : water) {
    if (is_known[space.index(c)]) continue;
    const ConnectedWater connected =
        follow(space, space.index(c), Vec<Dim>(-gravity.normalized()), boundary.faces.size(), is_wet, is_known);
    const bool has_surface = connected.surface > -std::numeric_limits<double>::infinity();
    if (connected.is_at_end || !has_surface) continue;
    const double above = connected.ceiling - connected.surface;
    if (above < min_height * space.edge()) continue;
    const double tension = spec.physics.density * gravity.norm() * above;
    if (tension <= spec.physics.tension) continue;
    const auto remedy = tension <= largest_tension
                            ? Clause("fill it no higher, or give physics.tension = {:.2g}", 1.2 * tension)
                            : Clause("fill it no higher");
    findings.push_back(Finding::warning(
        "hanging-water-separates",
        {"the water below {} at {} stands {:.3g} above the free surface that it is connected to, as in a siphon, and "
         "will separate, because walls hold water up to {:.3g} below the pressure of the atmosphere (physics.tension)",
         wall_label(boundary, boundary.faces[connected.face_above].wall),
         place(space.centre(space.cell(connected.cell_below))), Amount{above, "m"}, Amount{spec.physics.tension, "Pa"}},
        remedy));
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_hanging_water);

}  // namespace tailwater
