// The sweeps of SSOR beside their definitions, with whole matrices.
#include "linear/triangular_sweeps.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>
#include <span>
#include <vector>

namespace tailwater {
namespace {

constexpr double omega = 1.35;
constexpr double eps = std::numeric_limits<double>::epsilon();

/// A matrix of 0 to 6 entries beside the diagonal, 1, in each row, and its compressed rows.
struct SparseRows {
  explicit SparseRows(int rows) : whole(Eigen::MatrixXd::Identity(rows, rows)) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> weight(-0.2, 0.1);
    begin.push_back(0);
    for (int i = 0; i < rows; ++i) {
      for (int n = i % 7; n > 0; --n) whole(i, (i + 11 * n) % rows) = weight(random);
      whole(i, i) = 1.0;
      for (int j = 0; j < rows; ++j) {
        if (whole(i, j) == 0.0) continue;
        if (i == j) diagonal.push_back(static_cast<int>(column.size()));
        column.push_back(j);
        value.push_back(whole(i, j));
      }
      begin.push_back(static_cast<int>(column.size()));
    }
    sweeps.take(begin, column, diagonal, value);
  }

  Eigen::MatrixXd lower() const {
    return Eigen::MatrixXd(whole.triangularView<Eigen::StrictlyLower>()) + diagonal_matrix();
  }
  Eigen::MatrixXd upper() const {
    return Eigen::MatrixXd(whole.triangularView<Eigen::StrictlyUpper>()) + diagonal_matrix();
  }
  Eigen::MatrixXd diagonal_matrix() const { return Eigen::MatrixXd::Identity(whole.rows(), whole.cols()) / omega; }

  Eigen::MatrixXd whole;
  std::vector<int> begin;
  std::vector<int> column;
  std::vector<int> diagonal;
  std::vector<double> value;
  TriangularSweeps sweeps;
};

std::span<const double> entries(const Eigen::VectorXd& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}
std::span<double> entries(Eigen::VectorXd& vector) { return {vector.data(), static_cast<std::size_t>(vector.size())}; }

TEST(TriangularSweeps, SolveWithTheLowerAndTheUpperTriangle) {
  const SparseRows rows(40);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(40, -1.0, 2.0);
  Eigen::VectorXd x(40);
  rows.sweeps.forward(omega, entries(b), entries(x));
  EXPECT_LT((rows.lower() * x - b).lpNorm<Eigen::Infinity>(), 20.0 * eps);
  rows.sweeps.backward(omega, entries(b), entries(x));
  EXPECT_LT((rows.upper() * x - b).lpNorm<Eigen::Infinity>(), 20.0 * eps);
}

TEST(TriangularSweeps, EisenstatsFormIsTheProductBetweenTwoSweeps) {
  SparseRows rows(40);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(40, -1.0, 2.0);
  Eigen::VectorXd x(40);
  rows.sweeps.eisenstat(omega, entries(b), entries(x));
  const Eigen::VectorXd product = rows.whole * rows.upper().partialPivLu().solve(b);
  EXPECT_LT((rows.lower() * x - product).lpNorm<Eigen::Infinity>(), 100.0 * eps);
}

TEST(TriangularSweeps, TakeAnotherMatrixOfAnotherSize) {
  SparseRows rows(40);
  const SparseRows others(13);
  rows.sweeps.take(others.begin, others.column, others.diagonal, others.value);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(13, 1.0, 2.0);
  Eigen::VectorXd x(13);
  rows.sweeps.backward(omega, entries(b), entries(x));
  EXPECT_LT((others.upper() * x - b).lpNorm<Eigen::Infinity>(), 20.0 * eps);
}

}  // namespace
}  // namespace tailwater
