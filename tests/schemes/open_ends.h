// Tanks and channels with open ends, and how a run goes on with them.
#pragma once

#include "neighbours/decomposition.h"
#include "open_ends/open_ends.h"
#include "schemes/cases.h"

namespace tailwater {

/// m; the spacing of these cases.
constexpr double end_spacing = 0.05;

/// Opens the tank of tank_case at high x, with an outlet there.
inline OutletTable& open_end(CaseSpec& spec) {
  WallTable& tank = spec.walls[0];
  tank.open.emplace_back("+x");
  OutletTable end;
  end.from = tank.min;
  end.from[0] = tank.max[0];
  end.to = tank.max;
  end.direction = Coordinates(tank.min.size(), 0.0);
  end.direction[0] = 1.0;
  return spec.outlets.emplace_back(end);
}

/// Opens the tank of tank_case at low x, with an inlet there.
inline InletTable& open_start(CaseSpec& spec) {
  WallTable& tank = spec.walls[0];
  tank.open.emplace_back("-x");
  InletTable start;
  start.from = tank.min;
  start.to = tank.max;
  start.to[0] = tank.min[0];
  start.direction = Coordinates(tank.min.size(), 0.0);
  start.direction[0] = 1.0;
  return spec.inlets.emplace_back(start);
}

/// The tank of tank_case with its end at high x open.
template <int Dim>
CaseSpec open_tank(double width, double depth) {
  CaseSpec spec = tank_case<Dim>(end_spacing, width, depth);
  open_end(spec);
  return spec;
}

/// The tank of tank_case with both ends in x open: an inlet at low x, an outlet at high x.
template <int Dim>
CaseSpec channel(double width, double depth) {
  CaseSpec spec = open_tank<Dim>(width, depth);
  open_start(spec);
  return spec;
}

/// Lets water out and in, and takes a step, as a run does.
template <int Dim>
void pass_and_step(Flow<Dim>& flow) {
  if (flow.state.step % 5 == 0) repartition(flow);
  remove_outflow(flow);
  add_inflow(flow);
  advance(flow, next_time_step(flow));
}

template <int Dim>
const OpenEndState& state_of_end(const Flow<Dim>& flow, std::size_t end) {
  return flow.template part<OpenEnds<Dim>>().states().at(end);
}

template <int Dim>
WaterAmount arrived_at(const Flow<Dim>& flow, std::size_t end) {
  return state_of_end(flow, end).arrived;
}

template <int Dim>
WaterAmount sump_of(const Flow<Dim>& flow, int circuit) {
  return flow.template part<OpenEnds<Dim>>().sump(circuit, flow.setup.liquid.density);
}

}  // namespace tailwater
