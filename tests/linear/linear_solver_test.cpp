// The solver against a dense solve, its starting guess, its errors, and systems that determine differences only.
#include "support/pressure_system.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "base/error.h"
#include "linear/petsc.h"
#include "linear/solver_choice.h"
#include "support/particle_set.h"

namespace tailwater {
namespace {

PressureSolverTable solver_settings(double tolerance) {
  PressureSolverTable settings;
  settings.tolerance = tolerance;
  return settings;
}

/// A random system in the class's own form, diagonal_i x_i - sum_k weight_ik x_j = rhs_i.
struct SmallSystem {
  std::vector<std::size_t> row_begin{0};
  std::vector<std::int32_t> columns;
  std::vector<double> weights;  // that single precision holds
  std::vector<double> diagonal;
  std::vector<double> rhs;

  std::size_t size() const { return diagonal.size(); }

  /// Patterns ascend.
  void sort_rows() {
    for (std::size_t i = 0; i < size(); ++i) {
      std::sort(columns.data() + row_begin[i], columns.data() + row_begin[i + 1]);
    }
  }

  void pass_values_to(PressureSystem& system) const {
    for (std::size_t i = 0; i < size(); ++i) {
      PressureSystem::Row row = system.row(i);
      row.set_weights([&](std::size_t k) { return weights[k]; });
      row.finish(diagonal[i], rhs[i]);
    }
  }

  void pose_in(PressureSystem& system) const {
    system.set_pattern(row_begin, columns);
    pass_values_to(system);
  }

  Eigen::VectorXd dense_solution() const {
    const auto n = static_cast<Eigen::Index>(size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t i = 0; i < size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      matrix(row, row) += diagonal[i];
      for (std::size_t k = row_begin[i]; k < row_begin[i + 1]; ++k) matrix(row, columns[k]) -= weights[k];
    }
    return matrix.partialPivLu().solve(Eigen::Map<const Eigen::VectorXd>(rhs.data(), n));
  }
};

/// Rows of very different scale, not symmetric, strictly diagonally dominant: sum |w| <= d/2.
SmallSystem random_system(std::size_t size, std::uint64_t seed) {
  SmallSystem system;
  Noise noise(seed);
  for (std::size_t i = 0; i < size; ++i) {
    const double scale = std::pow(10.0, 4.0 * noise()) * (i % 3 == 0 ? -1.0 : 1.0);
    for (const std::size_t offset : {7, 1, 19, 4}) {
      system.columns.push_back(static_cast<std::int32_t>((i + offset) % size));
      system.weights.push_back(static_cast<float>(0.125 * scale * noise()));
    }
    system.row_begin.push_back(system.columns.size());
    system.diagonal.push_back(scale);
    system.rhs.push_back(scale * noise());
  }
  system.sort_rows();
  return system;
}

/// With unit diagonal and off-diagonal sums <= 1/2 the inverse is bounded by 2 in the maximum norm, so a residual of
/// tolerance |b|_2 leaves an error below 2 tolerance |b|_2 <= 2 tolerance sqrt(n).
double error_bound(double tolerance, std::size_t size) {
  return 2.0 * tolerance * std::sqrt(static_cast<double>(size));
}

void expect_near(const std::vector<double>& solution, const Eigen::VectorXd& expected, double bound) {
  for (std::size_t i = 0; i < solution.size(); ++i) {
    ASSERT_NEAR(solution[i], expected[static_cast<Eigen::Index>(i)], bound) << "row " << i;
  }
}

TEST(PressureSystem, SolvesWhatADenseSolverSolves) {
  const double tolerance = 1e-10;
  for (const KrylovMethod method :
       {KrylovMethod::automatic, KrylovMethod::bicgstab, KrylovMethod::gmres, KrylovMethod::fgmres}) {
    for (const PreconditionerName preconditioner :
         {PreconditionerName::automatic, PreconditionerName::ssor, PreconditionerName::cell_multigrid,
          PreconditionerName::ilu, PreconditionerName::jacobi}) {
      PressureSolverTable settings = solver_settings(tolerance);
      settings.method = method;
      settings.preconditioner = preconditioner;
      PressureSystem system(settings);
      const SmallSystem small = random_system(60, 1);
      system.set_pattern(small.row_begin, small.columns);
      EXPECT_EQ(system.size(), small.size());
      Cells cells{.dimension = 2, .number = {}};
      for (std::size_t i = 0; i < small.size(); ++i) cells.number.push_back(i % 7 == 0 ? Cells::none : i * i % 40);
      system.set_cells(cells);
      small.pass_values_to(system);
      std::vector<double> solution(small.size(), 0.0);
      const SolveReport report = system.solve(solution);
      EXPECT_GT(report.iterations, 0);
      EXPECT_LE(report.residual, tolerance);
      expect_near(solution, small.dense_solution(), error_bound(tolerance, small.size()));
    }
  }
}

TEST(PressureSystem, TakesANewRightHandSideAlone) {
  SmallSystem small = random_system(60, 3);
  PressureSystem system(solver_settings(1e-10));
  small.pose_in(system);
  system.row(5).finish_as_zero();
  std::vector<double> solution(small.size(), 0.0);
  system.solve(solution);
  const std::vector<double> before = solution;
  for (std::size_t i = 0; i < small.size(); ++i) system.set_rhs(i, 2.0 * small.rhs[i]);
  system.solve(solution);
  EXPECT_EQ(solution[5], 0.0);
  for (std::size_t i = 0; i < small.size(); ++i) {
    EXPECT_NEAR(solution[i], 2.0 * before[i], 3.0 * error_bound(1e-10, small.size())) << "row " << i;
  }
}

TEST(PressureSystem, DividedDiagonalsAreThoseOfTheSystem) {
  SmallSystem small = random_system(60, 7);
  PressureSystem system(solver_settings(1e-10));
  small.pose_in(system);
  std::vector<double> solution(small.size(), 0.0);
  system.solve(solution);  // the preconditioner is from before
  for (const std::size_t i : {3, 8, 40}) {
    system.divide_diagonal(i, 0.25);
    small.diagonal[i] /= 0.25;
  }
  system.divide_diagonal(11, 0.0);
  system.solve(solution);
  for (std::size_t k = small.row_begin[11]; k < small.row_begin[12]; ++k) small.weights[k] = 0.0;
  small.diagonal[11] = 1.0;
  small.rhs[11] = 0.0;
  expect_near(solution, small.dense_solution(), error_bound(1e-10, small.size()));
}

TEST(PressureSystem, RowsWithEqualColumnsAreSolvedLikeAnyOther) {
  // Drops that fly apart: in each every unknown couples with every other, so whole blocks of rows have equal columns,
  // for which PETSc has operations of its own.
  constexpr std::size_t drop = 4;
  SmallSystem small;
  Noise noise(9);
  for (std::size_t i = 0; i < 15 * drop; ++i) {
    for (std::size_t k = 0; k < drop; ++k) {
      const std::size_t j = i / drop * drop + k;
      if (j == i) continue;
      small.columns.push_back(static_cast<std::int32_t>(j));
      small.weights.push_back(static_cast<float>(0.125 * noise()));
    }
    small.row_begin.push_back(small.columns.size());
    small.diagonal.push_back(1.0);
    small.rhs.push_back(noise());
  }
  PressureSystem system(solver_settings(1e-10));
  small.pose_in(system);
  std::vector<double> solution(small.size(), 0.0);
  system.solve(solution);
  expect_near(solution, small.dense_solution(), error_bound(1e-10, small.size()));
}

TEST(SolverChoice, TheRuleFillsInWhatTheCaseLeavesOpen) {
  const PressureSolverTable open;
  for (const double rows_deep : {shallow, deep}) {
    const SolverChoice choice = choose_solver(open, {.rows_deep = rows_deep});
    EXPECT_NE(choice.method, KrylovMethod::automatic);
    EXPECT_NE(choice.preconditioner, PreconditionerName::automatic);
  }
  EXPECT_EQ(choose_solver(open, {.rows_deep = shallow}).preconditioner, PreconditionerName::ssor);
  EXPECT_EQ(choose_solver(open, {.rows_deep = deep}).preconditioner, PreconditionerName::boomeramg);
  const SolverChoice on_cells = choose_solver(open, {.rows_deep = deep, .has_cells = true});
  EXPECT_EQ(on_cells.preconditioner, PreconditionerName::cell_multigrid);
  EXPECT_EQ(on_cells.method, KrylovMethod::fgmres);
  // A cycle costs less in 3D, beside a product.
  constexpr double depth = 30.0;
  EXPECT_EQ(choose_solver(open, {.rows_deep = depth, .has_cells = true}).preconditioner, PreconditionerName::ssor);
  EXPECT_EQ(choose_solver(open, {.rows_deep = depth, .dimension = 3, .has_cells = true}).preconditioner,
            PreconditionerName::cell_multigrid);
  // Three solves with one matrix pay for its set-up sooner than two.
  EXPECT_EQ(choose_solver(open, {.rows_deep = depth, .solves = 3, .has_cells = true}).preconditioner,
            PreconditionerName::cell_multigrid);
  // Zhou's dam break at 0.015 m, jittered or not.
  EXPECT_EQ(choose_solver(open, {.rows_deep = 39.8, .has_cells = true}).preconditioner,
            PreconditionerName::cell_multigrid);
  PressureSolverTable chosen;
  chosen.method = KrylovMethod::fgmres;
  chosen.preconditioner = PreconditionerName::jacobi;
  const SolverChoice choice = choose_solver(chosen, {.rows_deep = deep});
  EXPECT_EQ(choice.method, KrylovMethod::fgmres);
  EXPECT_EQ(choice.preconditioner, PreconditionerName::jacobi);
}

TEST(PressureSystem, ATinySourceIsSolvedLikeAnyOther) {
  SmallSystem small = random_system(60, 8);
  for (double& value : small.rhs) value *= 1e-60;
  PressureSystem system(solver_settings(1e-10));
  small.pose_in(system);
  std::vector<double> solution(small.size(), 0.0);
  EXPECT_LE(system.solve(solution).residual, 1e-10);
  expect_near(solution, small.dense_solution(), 1e-60 * error_bound(1e-10, small.size()));
}

TEST(PressureSystem, AGuessWorseThanNoneDoesNoHarm) {
  const SmallSystem small = random_system(60, 9);
  PressureSystem system(solver_settings(1e-10));
  small.pose_in(system);
  std::vector<double> solution(small.size(), 1e17);
  system.solve(solution);
  expect_near(solution, small.dense_solution(), error_bound(1e-10, small.size()));
}

TEST(PressureSystem, TakesNewValuesAndNewPatterns) {
  const double tolerance = 1e-10;
  PressureSystem system(solver_settings(tolerance));
  const SmallSystem first = random_system(60, 2);
  system.set_pattern(first.row_begin, first.columns);
  std::vector<double> solution(first.size(), 0.0);
  for (const std::uint64_t seed : {2, 3}) {  // the same pattern, other values
    const SmallSystem other = random_system(60, seed);
    other.pass_values_to(system);
    system.solve(solution);
    expect_near(solution, other.dense_solution(), error_bound(tolerance, other.size()));
  }
  // Another pattern with as many rows, then another number of rows.
  for (const std::size_t size : {60, 45}) {
    SmallSystem small = random_system(size, 4);
    for (std::int32_t& column : small.columns) column = static_cast<std::int32_t>((column + 2) % size);
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t k = small.row_begin[i]; k < small.row_begin[i + 1]; ++k) {
        if (small.columns[k] == static_cast<std::int32_t>(i))
          small.columns[k] = static_cast<std::int32_t>((i + 30) % size);
      }
    }
    small.sort_rows();
    small.pose_in(system);
    solution.assign(size, 0.0);
    system.solve(solution);
    expect_near(solution, small.dense_solution(), error_bound(tolerance, size));
  }
}

TEST(PressureSystem, IdentityRowsAreZero) {
  PressureSystem system(solver_settings(1e-10));
  SmallSystem small = random_system(60, 5);
  small.pose_in(system);
  for (std::size_t i = 0; i < small.size(); i += 5) {
    system.row(i).finish_as_zero();
    for (std::size_t k = small.row_begin[i]; k < small.row_begin[i + 1]; ++k) small.weights[k] = 0.0;
    small.rhs[i] = 0.0;
  }
  std::vector<double> solution(small.size(), 1.0);
  system.solve(solution);
  const double bound = error_bound(1e-10, small.size());
  expect_near(solution, small.dense_solution(), bound);
  for (std::size_t i = 0; i < small.size(); i += 5) EXPECT_NEAR(solution[i], 0.0, bound);
}

TEST(PressureSystem, NothingDrivesNothing) {
  PressureSystem system(solver_settings(1e-6));
  SmallSystem small = random_system(20, 6);
  std::fill(small.rhs.begin(), small.rhs.end(), 0.0);
  small.pose_in(system);
  std::vector<double> solution(small.size(), 3.0);
  system.solve(solution);
  for (const double value : solution) EXPECT_EQ(value, 0.0);
}

/// Five-point Laplacian on n x n points; with `is_periodic` it wraps round, else p = 0 outside.
SmallSystem five_point(int n, bool is_periodic) {
  SmallSystem system;
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const int i = x + dx;
        const int j = y + dy;
        if (!is_periodic && (i < 0 || j < 0 || i == n || j == n)) continue;
        system.columns.push_back((i + n) % n + n * ((j + n) % n));
        system.weights.push_back(1.0);
      }
      system.row_begin.push_back(system.columns.size());
      system.diagonal.push_back(4.0);
      system.rhs.push_back(std::sin(2.0 * std::numbers::pi * (x + 1.0) / n) + 0.1 * (x + 2 * y) / n);
    }
  }
  system.sort_rows();
  return system;
}

TEST(PressureSystem, AWarmStartCostsNoMoreThanAColdOne) {
  const SmallSystem grid = five_point(40, false);
  PressureSystem system(solver_settings(1e-8));
  grid.pose_in(system);
  std::vector<double> solution(grid.size(), 0.0);
  const int cold = system.solve(solution).iterations;
  EXPECT_GT(cold, 3);
  // The tolerance is relative to the right-hand side, not to the first residual: starting from the answer, none or the
  // one iteration is due that rounding may ask for.
  EXPECT_LE(system.solve(solution).iterations, 1);
  for (double& value : solution) value *= 1.001;
  EXPECT_LE(system.solve(solution).iterations, cold);
}

TEST(PressureSystem, NoConvergenceIsAnErrorWithItsHistory) {
  const SmallSystem grid = five_point(40, false);
  PressureSolverTable settings = solver_settings(1e-12);
  settings.max_iterations = 3;
  PressureSystem system(settings);
  grid.pose_in(system);
  std::vector<double> solution(grid.size(), 0.0);
  try {
    system.solve(solution);
    FAIL() << "three iterations cannot solve 1600 equations to 1e-12";
  } catch (const SolverError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("after 3 iterations"), std::string::npos) << message;
    EXPECT_NE(message.find("1600 unknowns"), std::string::npos) << message;
    EXPECT_NE(message.find("pressure_solver.max_iterations"), std::string::npos) << message;
    // From a zero start the first residual is the right-hand side: relative size 1; three iterations make four numbers.
    const std::size_t history = message.find("Residuals on the way: 1.00e+00, ");
    ASSERT_NE(history, std::string::npos) << message;
    const std::string numbers = message.substr(history, message.find('.', message.find("Remedy")) - history);
    EXPECT_GE(std::count(numbers.begin(), numbers.begin() + static_cast<long>(numbers.find("Remedy")), ','), 3)
        << message;
  }
}

TEST(PressureSystem, MethodsSpeakForThemselves) {
  const SmallSystem grid = five_point(40, false);
  const auto message = [&](KrylovMethod method) {
    PressureSolverTable settings = solver_settings(1e-12);
    settings.max_iterations = 3;
    settings.method = method;
    PressureSystem system(settings);
    grid.pose_in(system);
    std::vector<double> solution(grid.size(), 0.0);
    try {
      system.solve(solution);
    } catch (const SolverError& error) {
      return std::string(error.what());
    }
    return std::string("three iterations cannot solve 1600 equations to 1e-12");
  };
  EXPECT_NE(message(KrylovMethod::automatic).find("BiCGStab was still on its way"), std::string::npos);
  EXPECT_NE(message(KrylovMethod::gmres).find("PETSc's gmres ended with DIVERGED_ITS"), std::string::npos);
}

TEST(PressureSystem, AMethodThatOnlySaysThatItConvergedIsAnError) {
  const SmallSystem grid = five_point(40, false);
  PressureSolverTable settings = solver_settings(1e-12);
  // Squares of the preconditioned residual, by which PETSc goes, vanish.
  const struct ForgetOptions {
    ~ForgetOptions() { PetscOptionsClear(nullptr); }
  } forget_options;
  settings.petsc_options = "-pressure_ksp_type gmres -pressure_ksp_pc_side left -pressure_pc_sor_omega 1e-300";
  PressureSystem system(settings);
  grid.pose_in(system);
  std::vector<double> solution(grid.size(), 0.0);
  try {
    system.solve(solution);
    FAIL() << "a preconditioner of 1e-300 solves nothing";
  } catch (const SolverError& error) {
    EXPECT_NE(std::string(error.what()).find("ended with CONVERGED"), std::string::npos) << error.what();
  }
}

TEST(PressureSystem, ABreakdownIsNoFailure) {
  // x_0 - 3 x_1 = 1, x_1 + x_0 = 1: with no preconditioner (the diagonal is 1) the first residual r = (1, 1) is
  // orthogonal to A r, by whose product with it BiCGStab divides.
  SmallSystem small;
  small.row_begin = {0, 1, 2};
  small.columns = {1, 0};
  small.weights = {3.0, -1.0};
  small.diagonal = {1.0, 1.0};
  small.rhs = {1.0, 1.0};
  PressureSolverTable settings = solver_settings(1e-10);
  settings.method = KrylovMethod::bicgstab;
  settings.preconditioner = PreconditionerName::jacobi;
  PressureSystem system(settings);
  system.set_pattern(small.row_begin, small.columns);
  for (int solve = 0; solve < 2; ++solve) {  // the second begins with BiCGStab again
    small.pass_values_to(system);
    std::vector<double> solution(2, 0.0);
    const SolveReport report = system.solve(solution);
    EXPECT_EQ(report.restarts, 1U);
    EXPECT_LE(report.residual, 1e-10);
    EXPECT_NEAR(solution[0], 1.0, 1e-9);
    EXPECT_NEAR(solution[1], 0.0, 1e-9);
  }
}

TEST(PressureSystem, ANonFiniteSourceIsAnError) {
  SmallSystem small = random_system(20, 7);
  small.rhs[3] = std::numeric_limits<double>::infinity();
  PressureSystem system(solver_settings(1e-6));
  small.pose_in(system);
  std::vector<double> solution(small.size(), 0.0);
  EXPECT_THROW(system.solve(solution), SolverError);
}

/// The periodic Laplacian knows differences only, and its source here has a mean, which must be taken out first.
class FreeConstant : public testing::TestWithParam<PreconditionerName> {};

TEST_P(FreeConstant, GivesMeanZero) {
  SmallSystem grid = five_point(40, true);
  const double tolerance = 1e-10;
  PressureSolverTable settings = solver_settings(tolerance);
  settings.preconditioner = GetParam();
  PressureSystem system(settings);
  system.set_constant_is_free(true);
  grid.pose_in(system);
  std::vector<double> solution(grid.size(), 5.0);
  system.solve(solution);

  double sum = 0.0;
  double rhs_sum = 0.0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    sum += solution[i];
    rhs_sum += grid.rhs[i];
  }
  const auto count = static_cast<double>(grid.size());
  EXPECT_NEAR(sum / count, 0.0, 1e-12);
  // |b| <= 1.3 sqrt(n); residuals are of rows scaled by 1/4.
  const double bound = 1.3 * std::sqrt(count) * tolerance * 4.0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    double left = grid.diagonal[i] * solution[i];
    for (std::size_t k = grid.row_begin[i]; k < grid.row_begin[i + 1]; ++k) {
      left -= grid.weights[k] * solution[grid.columns[k]];
    }
    EXPECT_NEAR(left, grid.rhs[i] - rhs_sum / count, bound);
  }
}

INSTANTIATE_TEST_SUITE_P(PressureSystem, FreeConstant,
                         testing::Values(PreconditionerName::ssor, PreconditionerName::boomeramg),
                         [](const auto& test) { return std::string(name_of(test.param)); });

}  // namespace
}  // namespace tailwater
