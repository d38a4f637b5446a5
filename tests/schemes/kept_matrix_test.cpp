// The matrix of a second projection serves the next step too, and changes nothing.
#include <gtest/gtest.h>

#include "flow/pressure_equation.h"
#include "schemes/cases.h"
#include "support/dimensions.h"

namespace tailwater {
namespace {

template <class D>
class KeptMatrixTest : public testing::Test {};
TYPED_TEST_SUITE(KeptMatrixTest, Dimensions);

/// Jittered water in a tank that is pushed more and more: what walls ask for changes from solve to solve.
template <int Dim>
CaseSpec pushed_tank(PreconditionerName preconditioner) {
  CaseSpec spec = tank_case<Dim>(0.1, 0.8, 0.5);
  spec.particles.jitter = 0.2;
  spec.scheme.integrator = Integrator::implicit_projection;
  spec.pressure_solver.preconditioner = preconditioner;
  spec.walls[0].displacement = VectorField(Dim, 0.0);
  spec.walls[0].displacement[0] = "2*t^3";
  return spec;
}

/// The flow after so many steps. Calls before_step(flow) before each.
template <int Dim, class BeforeStep>
std::vector<Vec<Dim>> velocity_after(const CaseSpec& spec, int steps, BeforeStep&& before_step) {
  Flow<Dim> flow = make_flow<Dim>(spec);
  for (int n = 0; n < steps; ++n) {
    before_step(flow);
    step(flow);
  }
  return flow.state.particles.velocity;
}

TYPED_TEST(KeptMatrixTest, IsThatOfTheNextStep) {
  constexpr int Dim = TypeParam::value;
  constexpr int steps = 13;  // particles are sorted at the first and the eleventh
  for (const PreconditionerName preconditioner : {PreconditionerName::ssor, PreconditionerName::cell_multigrid}) {
    const CaseSpec spec = pushed_tank<Dim>(preconditioner);
    int kept = 0;
    const auto with =
        velocity_after<Dim>(spec, steps, [&](const Flow<Dim>& flow) { kept += flow.equation->has_matrix ? 1 : 0; });
    const auto without = velocity_after<Dim>(spec, steps, [](Flow<Dim>& flow) { flow.equation->forget_matrix(); });
    EXPECT_EQ(kept, steps - 1);
    EXPECT_EQ(with, without);
  }
}

TYPED_TEST(KeptMatrixTest, IsNotKeptByTheExplicitStep) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = pushed_tank<Dim>(PreconditionerName::ssor);
  spec.scheme.integrator = Integrator::explicit_projection;
  velocity_after<Dim>(spec, 3, [](const Flow<Dim>& flow) { EXPECT_FALSE(flow.equation->has_matrix); });
}

}  // namespace
}  // namespace tailwater
