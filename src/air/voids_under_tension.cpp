#include "air/voids_under_tension.h"

#include <algorithm>

#include "air/space_of_run.h"
#include "flow/measure.h"
#include "geometry/from_spec.h"
#include "io/messages.h"
#include "motion/wall_motion.h"

namespace tailwater {
namespace {

/// [dx]; edge of a cube as large as the least growth of a void before a warning. Bubbles among disordered particles
/// change by less.
constexpr double min_edge_of_growth = 3.0;

/// Growth of a void over its gas before a warning: the gas has lost a third of its pressure.
constexpr double min_growth = 0.5;

/// The case as if voids were a gas, so that they are searched for.
CaseSpec with_gas(CaseSpec spec) {
  spec.air.pockets = AirPockets::isothermal;
  spec.pockets.clear();
  spec.vents.clear();
  return spec;
}

}  // namespace

template <int Dim>
VoidsUnderTension<Dim>::VoidsUnderTension(const CaseSpec& spec, const Setup<Dim>& setup, const Boundary<Dim>& boundary)
    : spacing_(spec.particles.spacing),
      watch_(with_gas(spec), boundary.ducts, box_of_run(spec, setup, boundary), setup.domain) {}

/// m^Dim; without the cells near water, so at most the volume of the void.
template <int Dim>
double VoidsUnderTension<Dim>::volume_of(const AirPocket& pocket) const {
  double cells = 0.0;
  for (const CellRun& run : pocket.cells) cells += run.cells();
  return cells * watch_.grid().cell_volume();
}

template <int Dim>
const AirPocket* VoidsUnderTension<Dim>::find_grown() const {
  const auto has_grown = [&](const AirPocket& pocket) {
    return volume_of(pocket) - pocket.gas >
           std::max(min_growth * pocket.gas, power<Dim>(min_edge_of_growth * spacing_));
  };
  const auto grown = std::ranges::find_if(voids_.pockets, has_grown);
  return grown == voids_.pockets.end() ? nullptr : &*grown;
}

template <int Dim>
void VoidsUnderTension<Dim>::begin_step(Flow<Dim>& flow, double /*dt*/) {
  if (watch_.is_due(voids_)) watch_.look(flow.walls, {}, flow.state.particles, flow.setup.ranks, voids_);
}

/// The way of the fastest water counts in full, unlike that for gas (enclosed_air.cpp). Of a void that grows by half
/// between two searches the growth would count as air that was shut in.
template <int Dim>
void VoidsUnderTension<Dim>::correct(Flow<Dim>& flow, double dt) {
  const double time = flow.state.time;
  const double walls = flow.setup.wall_motion->largest_displacement(time, time + dt, flow.state.motion);
  const double water = dt * flow.setup.time_step_rule.limiting_speed(largest_speed(flow));
  voids_.displacement += std::max(water, walls);
}

template <int Dim>
void VoidsUnderTension<Dim>::warn(const Flow<Dim>& flow) {
  const AirPocket* const grown = is_told_ ? nullptr : find_grown();
  if (grown == nullptr) return;
  is_told_ = true;
  const VoidGrid<Dim>& grid = watch_.grid();
  Vec<Dim> sum = Vec<Dim>::Zero();
  double cells = 0.0;
  for (const CellRun& run : grown->cells) {
    for (int place = run.begin; place < run.end; ++place) sum += grid.centre(grid.cell(run.row, place));
    cells += run.cells();
  }
  tailwater::warn("void-under-tension",
                  "a void that no air can reach has grown to {:.3g} m^{} around {} by t = {:.4g} s; the run counts it "
                  "as air at the pressure of the atmosphere, so a siphon runs dry there; remedy: round the edge "
                  "beside it, or choose air.pockets = \"isothermal\" if it is enclosed air",
                  volume_of(*grown), Dim, place(Vec<Dim>(sum / cells)).text(), flow.state.time);
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_voids_under_tension(const CaseSpec& spec, const Setup<Dim>& setup,
                                                    const Boundary<Dim>& boundary) {
  if (spec.physics.tension == 0.0 || spec.air.pockets != AirPockets::none) return nullptr;
  return std::make_unique<VoidsUnderTension<Dim>>(spec, setup, boundary);
}

template class VoidsUnderTension<2>;
template class VoidsUnderTension<3>;
TAILWATER_IN_2D_AND_3D(make_voids_under_tension);

}  // namespace tailwater
