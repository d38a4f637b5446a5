// In 3D slopes of pairs and the matrix are not in memory together, and what is taken away comes back as it was.
#include <gtest/gtest.h>

#include "base/error.h"
#include "schemes/cases.h"
#include "support/dimensions.h"

namespace tailwater {
namespace {

template <class D>
class LentSlopesTest : public testing::Test {};
TYPED_TEST_SUITE(LentSlopesTest, Dimensions);

/// Jittered, so that no two pairs are alike.
template <int Dim>
CaseSpec jittered_tank() {
  CaseSpec spec = tank_case<Dim>(0.1, 0.8, 0.5);
  spec.particles.jitter = 0.2;
  return spec;
}

/// Poses the pressure equation of the first step and solves it. Calls look(flow) between the two.
template <int Dim, class Look>
void project_once(Flow<Dim>& flow, Look&& look) {
  constexpr double dt = 0.001;
  const StepStart<Dim> start = remember(flow);
  WallDrive<Dim> drive = drive_walls(flow, start, dt);
  Prediction<Dim> predicted = predict(flow, start, drive, dt);
  const std::vector<double> target = aim(flow, std::move(predicted.velocity_gradient), dt);
  const PosedEquation equation = assemble(flow, predicted, target, drive, dt);
  look(flow);
  solve(flow, start, equation, dt, drive);
}

TYPED_TEST(LentSlopesTest, OnlyOneOfSlopesAndMatrixIsThereIn3D) {
  constexpr int Dim = TypeParam::value;
  Flow<Dim> flow(jittered_tank<Dim>());
  locate(flow);
  const Pairs<Dim> before = flow.pairs();
  project_once(flow, [&](const Flow<Dim>& posed) {
    EXPECT_EQ(posed.pairs().F.empty(), Dim == 3);
    EXPECT_EQ(posed.pressure_rows.entries(), before.j.size());
  });
  EXPECT_EQ(flow.pairs().F, before.F);
  EXPECT_EQ(flow.pressure_rows.entries(), 0u);
}

TYPED_TEST(LentSlopesTest, SlopesComeBackWhenTheSolveFails) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = jittered_tank<Dim>();
  spec.pressure_solver.max_iterations = 1;
  Flow<Dim> flow(spec);
  locate(flow);
  const auto before = flow.pairs().F;
  EXPECT_THROW(project_once(flow, [](const Flow<Dim>&) {}), SolverError);
  EXPECT_EQ(flow.pairs().F, before);
}

}  // namespace
}  // namespace tailwater
