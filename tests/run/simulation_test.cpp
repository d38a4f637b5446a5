#include "run/simulation.h"
#include "flow/saved_flow.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "io/temporary_folder.h"
#include "neighbours/decomposition.h"
#include "parts/script_loads.h"
#include "support/dimensions.h"
#include "support/pond.h"

namespace tailwater {
namespace {

constexpr int steps = 12;  // past the second time that particles are repartitioned

template <int Dim>
struct Moments final : RunObserver<Dim> {
  std::string told;
  void started(const Flow<Dim>&) override { told += "started "; }
  void before_step(const Flow<Dim>&) override { told += "before "; }
  void repartitioned(const Flow<Dim>&, const Repartition&) override { told += "shared "; }
  void can_go_on(const Flow<Dim>&, double) override { told += "complete "; }
  void stepped(const Flow<Dim>&, const StepReport&) override { told += "stepped "; }
};

template <class Dimension>
class SimulationTest : public testing::Test {
 protected:
  CaseSpec spec = pond_case<Dimension::value>();
};
TYPED_TEST_SUITE(SimulationTest, Dimensions);

TYPED_TEST(SimulationTest, GoesTheSameWayWhetherItIsObservedOrNot) {
  constexpr int Dim = TypeParam::value;
  this->spec.particles.jitter = 0.1;
  const TemporaryFolder temporary;
  const RunFolder folder = RunFolder::create(temporary.path(), false);
  Simulation<Dim> alone(this->spec);
  Simulation<Dim> observed(this->spec);
  Moments<Dim> moments;
  observed.observe(moments, folder);
  alone.start();
  observed.start();
  for (int k = 0; k < steps; ++k) {
    alone.step();
    observed.prepare();
    observed.prepare();  // nothing is left to do
    observed.step();
  }
  EXPECT_EQ(alone.flow().state.time, observed.flow().state.time);
  EXPECT_EQ(alone.flow().state.particles.position, observed.flow().state.particles.position);
  const std::string with_sharing = "before shared complete stepped ";
  EXPECT_TRUE(moments.told.starts_with("started " + with_sharing + "before stepped ")) << moments.told;
  EXPECT_EQ(moments.told.find(with_sharing, 20), moments.told.rfind("before shared")) << moments.told;
}

// A force that is equal everywhere has no divergence: free water takes it up whole, and there is no pressure.
TYPED_TEST(SimulationTest, LoadsActInOneStep) {
  constexpr int Dim = TypeParam::value;
  Simulation<Dim> simulation(this->spec);
  simulation.start();
  const double dt = simulation.prepare();
  script_loads(simulation.flow()).acceleration.assign(simulation.flow().state.particles.owned, Vec<Dim>::Unit(0));
  simulation.step();
  EXPECT_TRUE(script_loads(simulation.flow()).acceleration.empty());
  simulation.step();
  for (const Vec<Dim>& velocity : simulation.flow().state.particles.velocity) EXPECT_NEAR(velocity[0], dt, 1e-13 * dt);
}

TYPED_TEST(SimulationTest, AFlowWithLoadsGoesOnFromASavedFlowWithoutThem) {
  constexpr int Dim = TypeParam::value;
  Simulation<Dim> alone(this->spec);
  alone.start();
  alone.step();
  Simulation<Dim> loaded(this->spec);
  script_loads(loaded.flow());
  SavedFlow<Dim> saved;
  alone.flow().save(saved);
  ASSERT_TRUE(loaded.flow().restore(std::move(saved)));
  EXPECT_EQ(loaded.flow().state.time, alone.flow().state.time);
}

TYPED_TEST(SimulationTest, FailsWithoutAFolderToo) {
  constexpr int Dim = TypeParam::value;
  Simulation<Dim> simulation(this->spec);
  simulation.start();
  simulation.prepare();
  script_loads(simulation.flow())
      .acceleration.assign(simulation.flow().state.particles.owned,
                           Vec<Dim>::Constant(std::numeric_limits<double>::quiet_NaN()));
  const std::string message = message_of<SolverError>([&] { simulation.step(); });
  EXPECT_TRUE(message.starts_with("step 0 from t = 0 s failed: ")) << message;
  EXPECT_EQ(message.find("report"), std::string::npos) << message;
}

}  // namespace
}  // namespace tailwater
