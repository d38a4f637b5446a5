// Conjugate gradients for a system that is known by its products.
#include "linear/shell_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tailwater {
namespace {

/// Numbers in a chain, each coupled to the two beside it and held by `hold`; divided by its diagonal as preconditioner.
class Chain final : public ShellSystem {
 public:
  explicit Chain(double hold) : hold_(hold) {}
  void multiply(std::span<const double> x, std::span<double> y) override {
    for (std::size_t i = 0; i < x.size(); ++i) {
      y[i] = (2.0 + hold_) * x[i] - (i > 0 ? x[i - 1] : 0.0) - (i + 1 < x.size() ? x[i + 1] : 0.0);
    }
  }
  void precondition(std::span<const double> residual, std::span<double> correction) override {
    for (std::size_t i = 0; i < residual.size(); ++i) correction[i] = residual[i] / (2.0 + hold_);
  }
  /// sqrt(r . P r) of the residual r.
  double residual(std::span<const double> rhs, std::span<const double> x) {
    std::vector<double> product(x.size());
    multiply(x, product);
    double sum = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += std::pow(rhs[i] - product[i], 2) / (2.0 + hold_);
    return std::sqrt(sum);
  }

 private:
  double hold_;
};

struct ShellSolver : testing::Test {
  Chain chain{0.1};
  std::vector<double> rhs = std::vector<double>(50, 1.0);
  std::vector<double> x = std::vector<double>(50, 0.0);
};

// The residual that the method updates may differ from that of x by rounding alone.
TEST_F(ShellSolver, EndsAtTheResidual) {
  const ShellReport report = solve_by_shell({}, chain, {.residual = 1e-8, .reduction = 0.0, .iterations = 100}, rhs, x);
  EXPECT_TRUE(report.has_converged);
  EXPECT_LT(chain.residual(rhs, x), 1.001e-8);
}

TEST_F(ShellSolver, EndsAtTheReductionOfTheGuess) {
  x.assign(50, 9.0);
  const double first = chain.residual(rhs, x);
  const ShellReport report = solve_by_shell({}, chain, {.residual = 0.0, .reduction = 0.1, .iterations = 100}, rhs, x);
  EXPECT_TRUE(report.has_converged);
  EXPECT_LT(chain.residual(rhs, x), 0.1001 * first);
  EXPECT_GT(chain.residual(rhs, x), 1e-4 * first);
}

TEST_F(ShellSolver, LeavesAGoodGuess) {
  solve_by_shell({}, chain, {.residual = 1e-8, .reduction = 0.0, .iterations = 100}, rhs, x);
  const std::vector<double> before = x;
  EXPECT_EQ(solve_by_shell({}, chain, {.residual = 1e-7, .reduction = 0.0, .iterations = 100}, rhs, x).iterations, 0);
  EXPECT_EQ(x, before);
}

TEST_F(ShellSolver, ReportsThatItDidNotConverge) {
  const ShellReport report = solve_by_shell({}, chain, {.residual = 1e-8, .reduction = 0.0, .iterations = 3}, rhs, x);
  EXPECT_FALSE(report.has_converged);
  EXPECT_EQ(report.iterations, 3);
}

}  // namespace
}  // namespace tailwater
