// The state is all that a run needs to go on: a flow made of the case and of a state goes on bit for bit.
#include <gtest/gtest.h>

#include <string>

#include "flow/saved_flow.h"
#include "schemes/open_ends.h"
#include "support/liquids.h"

namespace tailwater {
namespace {

struct Variant {
  const char* name;
  CaseSpec spec;
};

CaseSpec dam_break(Integrator integrator) {
  CaseSpec spec = zhou_case(0.06, integrator);
  spec.particles.jitter = 0.1;
  return spec;
}

CaseSpec two_step_case() {
  CaseSpec spec = dam_break(Integrator::explicit_projection);
  spec.scheme.name = SchemeName::farmani2020;
  apply_formulation(spec.scheme);
  return spec;
}

CaseSpec published_case() {
  CaseSpec spec = dam_break(Integrator::implicit_projection);
  spec.scheme.formulation = Formulation::published;
  apply_formulation(spec.scheme);
  return spec;
}

CaseSpec gate_case() {
  CaseSpec spec = dam_break(Integrator::implicit_projection);
  WallTable gate;
  gate.points = {{1.2, 0.0}, {1.2, 0.9}};
  gate.displacement = {"0.3*t", 0.0};
  spec.walls.push_back(gate);
  return spec;
}

CaseSpec outlet_case() {
  CaseSpec spec = dam_break(Integrator::explicit_projection);
  spec.walls[0].points = {{0.0, 3.0}, {0.0, 0.0}, {1.5, 0.0}};
  OutletTable end;
  end.from = {1.5, 0.0};
  end.to = {1.5, 3.0};
  end.direction = {1.0, 0.0};
  spec.outlets = {end};
  return spec;
}

CaseSpec inlet_case() {
  CaseSpec spec = outlet_case();
  spec.walls[0].points = {{0.0, 0.0}, {1.5, 0.0}};
  InletTable start;
  start.from = {0.0, 0.0};
  start.to = {0.0, 3.0};
  start.direction = {1.0, 0.0};
  start.discharge = "0.3*(1 + sin(20*t))";
  spec.inlets = {start};
  spec.outlets[0].level = 0.3;
  return spec;
}

CaseSpec rough_case() {
  CaseSpec spec = dam_break(Integrator::explicit_projection);
  spec.walls[0].slip = Slip::no_slip;
  spec.walls[0].roughness = 0.01;
  return spec;
}

CaseSpec yielding_case() {
  CaseSpec spec = dam_break(Integrator::explicit_projection);
  fill_with(spec, bingham(10.0, 50.0));
  for (WallTable& wall : spec.walls) {
    wall.slip = Slip::no_slip;
    wall.friction = 1.0;
  }
  spec.time.end_at_rest = 1e-3;
  return spec;
}

CaseSpec porous_case() {
  CaseSpec spec = dam_break(Integrator::explicit_projection);
  PorousTable rock;
  rock.min = {1.0, -1.0};
  rock.max = {1.5, 3.0};
  rock.porosity = 0.5;
  rock.grain_size = 0.03;
  rock.added_mass = 0.34;
  spec.porous = {rock};
  return spec;
}

class StateTest : public testing::TestWithParam<Variant> {};

void expect_same(const Flow<2>& a, const Flow<2>& b) {
  ASSERT_EQ(a.state.particles.owned, b.state.particles.owned);
  EXPECT_EQ(a.state.time, b.state.time);
  EXPECT_EQ(a.state.step, b.state.step);
  EXPECT_EQ(a.state.last_step.approach, b.state.last_step.approach);
  EXPECT_EQ(a.state.last_step.energy_rise, b.state.last_step.energy_rise);
  EXPECT_EQ(a.state.last_step.density_share, b.state.last_step.density_share);
  for (std::size_t i = 0; i < a.state.particles.owned; ++i) {
    ASSERT_EQ(a.state.particles.id[i], b.state.particles.id[i]);
    ASSERT_EQ(a.state.particles.position[i], b.state.particles.position[i]);
    ASSERT_EQ(a.state.particles.volume[i], b.state.particles.volume[i]);
    ASSERT_EQ(a.state.particles.velocity[i], b.state.particles.velocity[i]);
    ASSERT_EQ(a.state.particles.pressure[i], b.state.particles.pressure[i]);
    ASSERT_EQ(a.state.particles.second_pressure[i], b.state.particles.second_pressure[i]);
    ASSERT_EQ(a.state.particles.layer_viscosity[i], b.state.particles.layer_viscosity[i]);
    ASSERT_EQ(a.state.particles.wall_distance[i], b.state.particles.wall_distance[i]);
  }
}

/// As a run does: sorted and repartitioned every few steps, when lists are forgotten.
void take_steps(Flow<2>& flow, int count) {
  for (int n = 0; n < count; ++n) pass_and_step(flow);
}

TEST_P(StateTest, IsAllThatARunNeedsToGoOn) {
  const CaseSpec& spec = GetParam().spec;
  Flow<2> whole = make_flow<2>(spec);
  start(whole);
  take_steps(whole, 40);
  Flow<2> resumed = make_flow<2>(spec);
  SavedFlow<2> saved;
  whole.save(saved);
  ASSERT_TRUE(resumed.restore(std::move(saved)));
  take_steps(whole, 20);
  take_steps(resumed, 20);
  expect_same(whole, resumed);
}

INSTANTIATE_TEST_SUITE_P(Cases, StateTest,
                         testing::Values(Variant{"explicit", dam_break(Integrator::explicit_projection)},
                                         Variant{"implicit", dam_break(Integrator::implicit_projection)},
                                         Variant{"two_step", two_step_case()}, Variant{"published", published_case()},
                                         Variant{"moving_wall", gate_case()}, Variant{"outlet", outlet_case()},
                                         Variant{"inlet", inlet_case()}, Variant{"rough", rough_case()},
                                         Variant{"porous", porous_case()}, Variant{"yielding", yielding_case()}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace tailwater
