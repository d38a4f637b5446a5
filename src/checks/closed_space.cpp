#include <fmt/ranges.h>

#include <set>

#include "checks/cell_space.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"
#include "motion/channel_end.h"

namespace tailwater {
namespace {

constexpr int moments_of_inflow = 1000;

/// Total volume that an end brings into a full space, m^Dim.
template <int Dim>
double inflow_of(const ChannelEnd<Dim>& end, double last) {
  double sum = 0.0;
  for (int k = 0; k < moments_of_inflow; ++k) {
    sum += end.discharge_per_width(last * (k + 0.5) / moments_of_inflow, end.height);
  }
  return sum / moments_of_inflow * last * end.width;
}

/// The water at the start in the reached cells, m^Dim. Collective.
template <int Dim>
double water_in(const Spread<Dim>& reached, const CellSpace<Dim>& space, const FluidParticles<Dim>& fluid) {
  std::vector<bool> is_reached(space.count(), false);
  for (const auto& cell : reached.cells) is_reached[space.index(cell)] = true;
  double volume = 0.0;
  for (std::size_t i = 0; i < fluid.position.size(); ++i) {
    if (is_reached[space.index(space.cell_of(fluid.position[i]))]) volume += fluid.volume[i];
  }
  return fluid.ranks.sum(volume);
}

/// Adds an error if water that enters at an end has no way out and too little space.
template <int Dim>
void check_space_of(const ChannelEnd<Dim>& end, const CellSpace<Dim>& space, const Boundary<Dim>& boundary,
                    const FluidParticles<Dim>& fluid, double last, Findings& findings) {
  const Vec<Dim> middle = end.low + 0.5 * (end.height * end.rise + end.width * end.aside);
  const auto start = cell_inside(space, end.mouth, end.on_mouth(middle));
  if (!start) return;
  const Spread<Dim> reached = spread(space, {*start}, Vec<Dim>(Vec<Dim>::Zero()));
  // A cell at a wall counts whole or not at all, so up to half a cell may be missing per side.
  const double room =
      space.volume() * (static_cast<double>(reached.cells.size()) + 0.5 * static_cast<double>(reached.sides)) -
      water_in(reached, space, fluid);
  const double inflow = inflow_of(end, last);
  if (reached.way_out || inflow <= room) return;
  std::set<std::string> walls;
  for (std::size_t f = 0; f < boundary.faces.size(); ++f) {
    const int wall = boundary.faces[f].wall;
    if (!reached.met[f]) continue;
    if (boundary.walls[wall].moves()) return;  // it may open
    walls.insert(wall_label(boundary, wall).text());
  }
  findings.push_back(Finding::error(
      "closed-space-overfilled",
      {"{} adds {:.3g} by t = {:.6g} s to the space closed by {}, which has no outlet: it can hold at most {:.3g} m^{} "
       "more",
       end.opening.label(), Amount{inflow, fmt::format("m^{}", Dim)}, last, fmt::join(walls, " and "), room, Dim},
      {"open it (of a box: open = [...]), give it an outlet, or let less enter"}));
}

}  // namespace

template <int Dim>
Findings check_closed_space(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  const std::vector<ChannelEnd<Dim>> ends = make_channel_ends<Dim>(spec);
  std::vector<Opening<Dim>> feeding;  // outflow through the other ends leaves the space
  for (const ChannelEnd<Dim>& end : ends) {
    if (end.flow.feeds()) feeding.push_back(end.mouth);
  }
  if (feeding.empty()) return {};
  const CellSpace<Dim> space(spec, faces_with(boundary, feeding), fluid.box(), max_cells_of_case);
  Findings findings;
  for (const ChannelEnd<Dim>& end : ends) {
    if (end.flow.feeds() && end.circuit < 0) check_space_of(end, space, boundary, fluid, spec.time.end, findings);
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_closed_space);

}  // namespace tailwater
