#include "run/step_guard.h"
#include "neighbours/neighbourhood.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"
#include "flow/stages.h"
#include "io/temporary_folder.h"
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

TYPED_TEST(StepGuardTest, PassesOnWhatTheSolverSays) {
  const std::string message = message_of<SolverError>(
      [&] { this->guard.attempt(save_step_start(this->flow), [] { throw SolverError("it did not converge"); }); });
  EXPECT_NE(message.find("it did not converge"), std::string::npos) << message;
}

}  // namespace
}  // namespace tailwater
