#include "run/step_guard.h"
#include "neighbours/neighbourhood.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "case/reader.h"
#include "flow/stages.h"
#include "io/temporary_folder.h"
#include "run/simulation.h"
#include "support/dimensions.h"
#include "support/pond.h"

namespace tailwater {
namespace {

template <class Dimension>
class StepGuardTest : public testing::Test {
 protected:
  static constexpr int Dim = Dimension::value;

  TemporaryFolder temporary;
  RunFolder folder = RunFolder::create(temporary.path(), false);
  Flow<Dim> flow = make_flow<Dim>(pond_case<Dim>());
  StepGuard<Dim> guard{flow};

  void SetUp() override {
    guard.report_to(folder);
    locate(flow);
  }
};

TYPED_TEST_SUITE(StepGuardTest, Dimensions);

TYPED_TEST(StepGuardTest, LetsSoundStepsPass) {
  this->guard.attempt(save_step_start(this->flow), [&] { this->flow.state.particles.velocity[5][0] = 1.0; });
  EXPECT_EQ(this->flow.state.particles.velocity[5][0], 1.0);
}

TYPED_TEST(StepGuardTest, NamesTheParticleThatIsNotFiniteAndPutsTheGoodStateBack) {
  const auto spoil = [&] {
    this->flow.state.particles.velocity[5][0] = std::numeric_limits<double>::quiet_NaN();
    throw SolverError("the source of the pressure equation is not finite");  // it follows from the particle
  };
  const std::string message = message_of<SolverError>([&] { this->guard.attempt(save_step_start(this->flow), spoil); });
  EXPECT_NE(message.find("particle 5, which was at ("), std::string::npos) << message;
  EXPECT_NE(message.find("has a value that is not finite"), std::string::npos) << message;
  EXPECT_EQ(this->flow.state.particles.velocity[5][0], 0.0);
  EXPECT_TRUE(text_of(this->folder.path() / "failure" / "report.txt").starts_with("step 0 from t = 0 s failed: "));
  EXPECT_TRUE(std::filesystem::exists(this->folder.path() / "failure" / "last_good.vtp"));
}

// As in the first step of a resumed run, which has no lists yet.
TYPED_TEST(StepGuardTest, NamesAParticleThatIsTooFastBeforeNeighboursAreKnown) {
  this->flow.neighbourhood->forget(this->flow.state.particles);
  this->flow.state.particles.velocity[5][0] = 1e15;
  const std::string message =
      message_of<SolverError>([&] { this->guard.require_sound_step(next_time_step(this->flow)); });
  EXPECT_NE(message.find("particle 5"), std::string::npos) << message;
  const std::string report = text_of(this->folder.path() / "failure" / "report.txt");
  EXPECT_NE(report.find("particle before the step: "), std::string::npos) << report;
  EXPECT_EQ(report.find("neighbours"), std::string::npos) << report;
}

/// A dry tray below an inlet that points downwards.
CaseSpec dry_fall(const std::string& changes) {
  return read_case_text(
      "particles.spacing = 0.02\ntime.end = 0.5\n[[wall]]\npoints = [[0, 0.1], [0, 0], [0.4, 0], [0.4, 0.1]]\n"
      "[[inlet]]\nfrom = [0.12, 0.8]\nto = [0.28, 0.8]\ndirection = [0, -1]\n" +
          changes,
      "case.toml");
}

TEST(StepGuardWithoutWater, LetsAnInletThatPointsDownwardsFillADryDomain) {
  for (const char* inflow : {"velocity = 0.3\n", "discharge = 0.048\n", "velocity = \"0.3*t\"\n"}) {
    Simulation<2> simulation(dry_fall(inflow), Communicator());
    simulation.start();
    for (int step = 0; step < 3; ++step) EXPECT_NO_THROW(simulation.step()) << inflow;
    // The reference speed is that of free fall from 0.8 m.
    EXPECT_NEAR(simulation.flow().setup.time_step_rule.reference_speed, std::sqrt(2.0 * 9.81 * 0.8), 0.02) << inflow;
  }
}

TEST(StepGuardWithoutWater, LetsAnInletFillADryDomainWithoutGravity) {
  for (const char* inflow : {"velocity = 0.3\n", "velocity = \"0.3*t\"\n"}) {
    Simulation<2> simulation(dry_fall(std::string(inflow) + "[physics]\ngravity = [0, 0]\n"), Communicator());
    simulation.start();
    for (int step = 0; step < 3; ++step) EXPECT_NO_THROW(simulation.step()) << inflow;
  }
}

TEST(StepGuardWithoutWater, HasACauseEvenIfThereIsNoParticleToName) {
  Flow<2> flow = make_flow<2>(dry_fall("velocity = 0.3\n"));
  StepGuard<2> guard(flow);
  guard.restore_reference_step(100.0);
  const std::string message = message_of<SolverError>([&] { guard.require_sound_step(next_time_step(flow)); });
  EXPECT_NE(message.find("failed: the time step collapsed to "), std::string::npos) << message;
  EXPECT_NE(message.find("inflow enters at 0.3 m/s"), std::string::npos) << message;
}

TYPED_TEST(StepGuardTest, PassesOnWhatTheSolverSays) {
  const std::string message = message_of<SolverError>(
      [&] { this->guard.attempt(save_step_start(this->flow), [] { throw SolverError("it did not converge"); }); });
  EXPECT_NE(message.find("it did not converge"), std::string::npos) << message;
}

}  // namespace
}  // namespace tailwater
