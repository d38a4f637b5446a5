// Starts PETSc for the whole life of a test program that solves pressure systems.
#include "linear/session.h"

#include <gtest/gtest.h>

#include <optional>

namespace tailwater {
namespace {

class LinearEnvironment : public testing::Environment {
 public:
  void SetUp() override { session_.emplace(); }
  void TearDown() override { session_.reset(); }

 private:
  std::optional<LinearSession> session_;
};

[[maybe_unused]] const testing::Environment* const environment =
    testing::AddGlobalTestEnvironment(new LinearEnvironment);

}  // namespace
}  // namespace tailwater
