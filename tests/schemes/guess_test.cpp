// Initial guesses of the pressure solves of a step.
#include <gtest/gtest.h>

#include "schemes/cases.h"

namespace tailwater {
namespace {

constexpr int steps = 12;

/// Iterations in the second half of the steps of a dam break, and the pressure after it. Calls before_step(particles)
/// before each step.
template <class BeforeStep>
std::pair<int, std::vector<double>> run_steps(Integrator integrator, PreconditionerName preconditioner,
                                              BeforeStep&& before_step) {
  CaseSpec spec = zhou_case(0.03, integrator);
  spec.pressure_solver.preconditioner = preconditioner;
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  int iterations = 0;
  for (int n = 0; n < steps; ++n) {
    before_step(flow.state.particles);
    const StepReport report = step(flow);
    if (n >= steps / 2) iterations += report.iterations;
  }
  return {iterations, flow.state.particles.pressure};
}

class GuessTest : public testing::TestWithParam<PreconditionerName> {};

TEST_P(GuessTest, OfWallsIsWhatTheyMakeOfTheWater) {
  for (const Integrator integrator : {Integrator::explicit_projection, Integrator::implicit_projection}) {
    const auto usual = run_steps(integrator, GetParam(), [](Particles<2>&) {});
    const auto spoilt = run_steps(integrator, GetParam(), [](Particles<2>& particles) {
      for (std::size_t i = 0; i < particles.owned; ++i) {
        if (!particles.is_fluid(i)) particles.pressure[i] = particles.second_pressure[i] = 1e6;
      }
    });
    EXPECT_EQ(usual, spoilt);
  }
}

TEST_P(GuessTest, OfEachProjectionIsWhatItFoundLast) {
  const auto usual = run_steps(Integrator::implicit_projection, GetParam(), [](Particles<2>&) {});
  const auto forgetful = run_steps(Integrator::implicit_projection, GetParam(), [](Particles<2>& particles) {
    std::fill(particles.second_pressure.begin(), particles.second_pressure.end(), 0.0);
  });
  EXPECT_LT(usual.first, 0.8 * forgetful.first);
}

INSTANTIATE_TEST_SUITE_P(Preconditioners, GuessTest,
                         testing::Values(PreconditionerName::ssor, PreconditionerName::cell_multigrid),
                         [](const auto& test) {
                           return test.param == PreconditionerName::ssor ? "ssor" : "multigrid";
                         });

}  // namespace
}  // namespace tailwater
