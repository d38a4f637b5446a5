// Compares the sweeps of SSOR, and BiCGStab with them, with their definitions by full matrices.
#include "linear/triangular_sweeps.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "linear/bicgstab.h"
#include "support/rounding.h"

namespace tailwater {
namespace {

constexpr double omega = ssor_factor;

/// A matrix with unit diagonal and 0 to `most` other entries per row, as the rows of a system. Every third row also
/// couples to images: ghosts of this rank's first rows.
struct SparseRows {
  SparseRows(int rows, int images, int most = 6)
      : own(Eigen::MatrixXd::Identity(rows, rows)), of_ghosts(Eigen::MatrixXd::Zero(rows, rows)) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> weight(-0.1, 0.2);
    std::vector<std::size_t> row_begin{0};
    std::vector<double> weights;
    const auto add = [&](Eigen::MatrixXd& matrix, int i, int j, int column) {
      columns.push_back(column);
      weights.push_back(static_cast<float>(weight(random)));
      matrix(i, j) = -weights.back();
    };
    for (int i = 0; i < rows; ++i) {
      std::vector<bool> is_coupled(rows, false);
      for (int n = i % (most + 1); n > 0; --n) is_coupled[(i + 11 * n) % rows] = true;
      for (int j = 0; j < rows; ++j) {
        if (is_coupled[j] && j != i) add(own, i, j, j);
      }
      for (int k = 0; i % 3 == 0 && k < images; ++k) add(of_ghosts, i, k, rows + k);
      row_begin.push_back(columns.size());
    }
    std::vector<std::int32_t> sent(images);
    for (int k = 0; k < images; ++k) sent[k] = k;
    system.set_pattern(row_begin, columns, ExchangePlan({}, rows, {sent}));
    for (int i = 0; i < rows; ++i) {
      LinearSystem::Row row = system.row(i);
      row.set_weights([&](std::size_t k) { return weights[k]; });
      row.finish(1.0, 0.0);
    }
  }

  /// Gives this system the rows of another one, which must outlive it.
  void take_over(const SparseRows& other) {
    const LinearSystem::Part whole = other.system.whole();
    std::vector<std::size_t> row_begin(whole.begin.begin(), whole.begin.end());
    row_begin.push_back(other.columns.size());
    system.set_pattern(row_begin, other.columns);
    for (std::size_t i = 0; i < system.size(); ++i) {
      LinearSystem::Row row = system.row(i);
      row.set_weights([&](std::size_t k) { return whole.weight[k]; });
      row.finish(1.0, 0.0);
    }
  }

  Eigen::MatrixXd lower() const {
    return Eigen::MatrixXd(own.triangularView<Eigen::StrictlyLower>()) + diagonal_matrix();
  }
  Eigen::MatrixXd upper() const {
    return Eigen::MatrixXd(own.triangularView<Eigen::StrictlyUpper>()) + diagonal_matrix();
  }
  Eigen::MatrixXd whole() const { return own + of_ghosts; }
  Eigen::MatrixXd diagonal_matrix() const { return Eigen::MatrixXd::Identity(own.rows(), own.cols()) / omega; }

  Eigen::MatrixXd own;                ///< couplings to the rank's own unknowns
  Eigen::MatrixXd of_ghosts;          ///< couplings to images, in the columns of the unknowns that they copy
  std::vector<std::int32_t> columns;  ///< borrowed by the system
  LinearSystem system;
};

/// The beginnings of the parts of all rows, for a new pattern.
RowParts parts_of(const LinearSystem& system) {
  RowParts parts;
  parts.follow(system);
  return parts;
}

std::span<const double> entries(const Eigen::VectorXd& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}
std::span<double> entries(Eigen::VectorXd& vector) { return {vector.data(), static_cast<std::size_t>(vector.size())}; }

TEST(TriangularSweeps, SolveWithTheLowerAndTheUpperTriangle) {
  const SparseRows rows(40, 0);
  const RowParts parts = parts_of(rows.system);
  const TriangularSweeps sweeps(rows.system, parts);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(40, -1.0, 2.0);
  Eigen::VectorXd x(40);
  sweeps.forward(omega, entries(b), entries(x));
  EXPECT_LT((rows.lower() * x - b).lpNorm<Eigen::Infinity>(), 20.0 * eps);
  sweeps.backward(omega, entries(b), entries(x));
  EXPECT_LT((rows.upper() * x - b).lpNorm<Eigen::Infinity>(), 20.0 * eps);
  sweeps.times_lower(omega, entries(b), entries(x));
  EXPECT_LT((rows.lower() * b - x).lpNorm<Eigen::Infinity>(), 20.0 * eps);
}

TEST(TriangularSweeps, EisenstatsFormIsTheProductBetweenTwoSweeps) {
  for (const int images : {0, 5}) {
    const SparseRows rows(40, images);
    const RowParts parts = parts_of(rows.system);
    TriangularSweeps sweeps(rows.system, parts);
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(40, -1.0, 2.0);
    Eigen::VectorXd x(40);
    sweeps.eisenstat(omega, entries(b), entries(x));
    const Eigen::VectorXd product = rows.whole() * rows.upper().partialPivLu().solve(b);
    EXPECT_LT((rows.lower() * x - product).lpNorm<Eigen::Infinity>(), 100.0 * eps);
  }
}

/// Improves x by BiCGStab; `residual` is b - A x.
MethodOutcome improve(const LinearSystem& system, const Eigen::VectorXd& residual, double target, Eigen::VectorXd& x) {
  Iterate iterate{entries(x), {residual.begin(), residual.end()}};
  Bicgstab method;
  method.begin(system, residual.norm());
  return method.improve(system, {.tolerance = target, .residual = target, .iterations = 100}, iterate);
}

TEST(Bicgstab, ItsResidualIsThatOfItsSolution) {
  for (const int images : {0, 5}) {
    const SparseRows rows(40, images);
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(40, -1.0, 2.0);
    for (const double target : {1e-1, 1e-4, 1e-8}) {
      Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(40, 3.0, -2.0);
      const Eigen::VectorXd residual = b - rows.whole() * x;
      const MethodOutcome outcome = improve(rows.system, residual, target, x);
      EXPECT_EQ(outcome.end, MethodOutcome::End::converged);
      EXPECT_GT(outcome.iterations, 0);
      ASSERT_TRUE(outcome.residual.has_value());
      EXPECT_LE(*outcome.residual, target);
      EXPECT_NEAR((b - rows.whole() * x).norm(), *outcome.residual, 1e4 * eps);
      EXPECT_EQ(outcome.history.size(), static_cast<std::size_t>(outcome.iterations) + 1);
      EXPECT_DOUBLE_EQ(outcome.history[0], residual.norm());
    }
  }
}

TEST(Bicgstab, SolvesOnePatternAfterTheOther) {
  SparseRows rows(40, 5);
  const SparseRows other(40, 0, 22);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(40, -1.0, 2.0);
  Bicgstab method;
  const auto solution_error = [&](const Eigen::MatrixXd& matrix) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(40);
    Iterate iterate{entries(x), {b.begin(), b.end()}};
    method.begin(rows.system, 1.0);
    method.improve(rows.system, {.tolerance = 1e-10, .residual = 1e-10, .iterations = 100}, iterate);
    return (b - matrix * x).norm();
  };
  EXPECT_LT(solution_error(rows.whole()), 1e-10);
  rows.take_over(other);
  EXPECT_LT(solution_error(other.whole()), 1e-10);
}

TEST(Bicgstab, SaysWhenItBreaksDown) {
  // x_0 - 3 x_1 = b_0, x_1 - 3 x_0 = b_1. For some b the product of the preconditioned residual with its image is
  // positive, for others it is negative. Between them is a b for which BiCGStab would divide by 0 or nearly 0.
  LinearSystem system;
  const std::vector<std::int32_t> columns{1, 0};
  system.set_pattern(std::vector<std::size_t>{0, 1, 2}, columns);
  const double weights[] = {3.0, 3.0};
  for (int i = 0; i < 2; ++i) {
    LinearSystem::Row row = system.row(i);
    row.set_weights([&](std::size_t k) { return weights[k]; });
    row.finish(1.0, 0.0);
  }
  const RowParts parts = parts_of(system);
  TriangularSweeps sweeps(system, parts);
  const auto product_with_image = [&](double angle) {
    const Eigen::VectorXd v = Eigen::Vector2d(std::cos(angle), std::sin(angle));
    Eigen::VectorXd image(2);
    sweeps.eisenstat(ssor_factor, entries(v), entries(image));
    return v.dot(image);
  };
  double positive = 0.0;
  double negative = 0.0;
  while (product_with_image(positive) < 0.0) positive += 0.1;
  while (product_with_image(negative) > 0.0 && negative < 7.0) negative += 0.1;
  ASSERT_LT(product_with_image(negative), 0.0);
  for (int n = 0; n < 80; ++n) {
    const double middle = 0.5 * (positive + negative);
    (product_with_image(middle) > 0.0 ? positive : negative) = middle;
  }
  const Eigen::VectorXd v = Eigen::Vector2d(std::cos(positive), std::sin(positive));
  Eigen::VectorXd b(2);
  sweeps.times_lower(ssor_factor, entries(v), entries(b));
  Eigen::VectorXd x = Eigen::VectorXd::Zero(2);
  const MethodOutcome outcome = improve(system, b, 1e-10, x);
  EXPECT_EQ(outcome.end, MethodOutcome::End::broke_down);
  EXPECT_NE(outcome.reason.find("BiCGStab"), std::string::npos) << outcome.reason;
  EXPECT_EQ(x, Eigen::VectorXd::Zero(2));
}

TEST(LinearSystemProduct, IsThatOfTheWholeMatrix) {
  for (const int images : {0, 5}) {
    const SparseRows rows(40, images, 22);  // some rows are as long as several registers, with all possible remainders
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(40, -1.0, 2.0);
    Eigen::VectorXd y(40);
    std::vector<double> with_ghosts(x.begin(), x.end());
    rows.system.multiply(with_ghosts, entries(y));
    EXPECT_LT((rows.whole() * x - y).lpNorm<Eigen::Infinity>(), 20.0 * eps);
  }
}

TEST(LinearSystemRow, OfDifferencesIsExactAndSymmetricThoughWeightsAreRounded) {
  constexpr int rows = 23;
  std::vector<std::size_t> row_begin{0};
  std::vector<std::int32_t> columns;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < rows; ++j) {
      if (j != i) columns.push_back(j);
    }
    row_begin.push_back(columns.size());
  }
  LinearSystem system;
  system.set_pattern(row_begin, columns);
  for (int i = 0; i < rows; ++i) {
    LinearSystem::Row row = system.row(i);
    const double sum = row.set_weights([&](std::size_t k) { return 1.0 / (3.0 + i * columns[k]); });
    row.finish(sum, 0.0);
  }
  const auto product = [&](const Eigen::VectorXd& x) {
    Eigen::VectorXd y(rows);
    std::vector<double> factor(x.begin(), x.end());
    system.multiply(factor, entries(y));
    for (int i = 0; i < rows; ++i) y[i] /= system.scale(i);
    return y;
  };
  EXPECT_LT(product(Eigen::VectorXd::Constant(rows, 7.0)).lpNorm<Eigen::Infinity>(), 1000.0 * eps);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(rows, -1.0, 2.0);
  const Eigen::VectorXd y = x.cwiseProduct(x);
  EXPECT_NEAR(x.dot(product(y)), y.dot(product(x)), 1000.0 * eps);
}

TEST(LinearSystemRow, IsWrittenAtOnceAsOneByOne) {
  std::vector<std::size_t> row_begin{0};
  std::vector<std::int32_t> columns;
  constexpr int rows = 23;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < rows + 3; ++j) {
      if (j != i) columns.push_back(j);
    }
    row_begin.push_back(columns.size());
  }
  const ExchangePlan images({}, rows, {{0, 1, 2}});
  LinearSystem one_by_one;
  LinearSystem at_once;
  one_by_one.set_pattern(row_begin, columns, images);
  at_once.set_pattern(row_begin, columns, images);
  const auto weight = [](std::size_t k) { return 1.0 / (1.0 + static_cast<double>(k)); };
  for (std::size_t i = 0; i < rows; ++i) {
    LinearSystem::Row row = one_by_one.row(i);
    LinearSystem::Row same = at_once.row(i);
    const double sum = row.set_weights(weight);
    const double same_sum = same.write_weights([&](float* weights) {
      double total = 0.0;
      for (std::size_t k = row_begin[i]; k < row_begin[i + 1]; ++k) {
        total += weights[k - row_begin[i]] = static_cast<float>(weight(k));
      }
      return total;
    });
    EXPECT_EQ(same_sum, sum);
    EXPECT_EQ(at_once.sum_of_weights(i), sum);
    row.finish(2.0, 1.0);
    same.finish(2.0, 1.0);
  }
  const std::span weights(at_once.whole().weight, columns.size());
  EXPECT_TRUE(std::ranges::equal(weights, std::span(one_by_one.whole().weight, columns.size())));
}

TEST(RowParts, FollowEachOtherInEachPattern) {
  constexpr int rows = 40;
  const ExchangePlan images({}, rows, {{0, 1, 2}});
  LinearSystem system;
  RowParts parts;
  for (const int step : {2, 3}) {
    std::vector<std::size_t> row_begin{0};
    std::vector<std::int32_t> columns;
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < rows + 3; ++j) {
        if (j != i && (i + j) % step == 0) columns.push_back(j);
      }
      row_begin.push_back(columns.size());
    }
    system.set_pattern(row_begin, columns, images);
    parts.follow(system);
    ASSERT_EQ(system.entries(), columns.size());
    for (int i = 0; i < rows; ++i) {
      ASSERT_LE(row_begin[i], parts.behind_begin[i]);
      ASSERT_LE(parts.behind_begin[i], parts.ghosts_begin[i]);
      ASSERT_LE(parts.ghosts_begin[i], row_begin[i + 1]);
      for (std::size_t k = row_begin[i]; k < row_begin[i + 1]; ++k) {
        EXPECT_EQ(k < parts.behind_begin[i], columns[k] < i);
        EXPECT_EQ(k < parts.ghosts_begin[i], columns[k] < rows);
      }
    }
  }
}

}  // namespace
}  // namespace tailwater
