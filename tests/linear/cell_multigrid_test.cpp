// The multigrid on cells and Orthomin around it: iterations do not grow with the number of unknowns, and no row
// prevents convergence. The systems are those of tanks with spacing 1: jittered water, layers of wall around it, and
// dry walls above it.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include "base/fp_traps.h"
#include "linear/find_cells.h"
#include "linear/orthomin.h"
#include "neighbours/pair_lanes.h"
#include "support/dimensions.h"
#include "support/particle_set.h"
#include "support/pressure_system.h"

namespace tailwater {
namespace {

constexpr double tolerance = 1e-6;
constexpr double cell_edge = 2.0;
constexpr double layers = 2.0;

PressureSolverTable multigrid_settings() {
  PressureSolverTable settings;
  settings.preconditioner = PreconditionerName::cell_multigrid;
  settings.tolerance = tolerance;
  return settings;
}

enum class Top { surface, lid };

/// Water in a tank `edge` particles wide and deep, with the rows of a pressure equation and the source whose solution
/// has the longest waves.
template <int Dim>
struct Tank {
  Tank(int edge, Top top) : set(points(edge, top), make_kernel<Dim>(KernelName::wendland_c2, 2.6), 1.0) {
    const Pairs<Dim>& pairs = set.pairs();
    std::vector<double> sum(set.size(), 0.0);
    for (std::size_t i = 0; i < set.size(); ++i) {
      weights.emplace_back(pairs.end(i) - pairs.begin(i), 0.0);
      for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
        if (!is_water[i] && !is_water[pairs.j[k]]) continue;  // walls couple to water only
        weights[i][k - pairs.begin(i)] = static_cast<float>(is_water[i] ? pairs.F(i, k) : pairs.value(i, k));
        sum[i] += weights[i][k - pairs.begin(i)];
      }
    }
    const double full = *std::max_element(sum.begin(), sum.end());
    for (std::size_t i = 0; i < set.size(); ++i) {
      // The deficit near a surface is air, p = 0. Under a lid only a small compressibility fixes the pressure.
      const double own = top == Top::surface ? std::max(0.0, 0.7 * full - sum[i]) : 1e-4 * full;
      diagonal.push_back(is_water[i] ? sum[i] + own : sum[i]);
      rhs.push_back(is_water[i] ? 1.0 : 0.0);
    }
  }

  void pose(LinearSystem& system) const {
    system.set_pattern(set.pairs().row_begin, set.pairs().j);
    system.set_cells(find_cells<Dim>(std::span(set.particles.position), cell_edge,
                                     [&](std::size_t i) { return static_cast<bool>(is_water[i]); }));
    for (std::size_t i = 0; i < set.size(); ++i) {
      PressureSystem::Row row = system.row(i);
      if (diagonal[i] == 0.0) {
        row.finish_as_zero();
        continue;
      }
      row.set_weights([&, first = set.pairs().begin(i)](std::size_t k) { return weights[i][k - first]; });
      row.finish(diagonal[i], diagonal[i] * rhs[i]);
    }
  }

  SolveReport solve(std::vector<double>& solution, const PressureSolverTable& settings) const {
    PressureSystem system(settings);
    pose(system);
    solution.assign(set.size(), 0.0);
    return system.solve(solution);
  }

  std::vector<Vec<Dim>> points(int edge, Top top) {
    std::array<int, Dim> count;
    count.fill(edge + 2 * static_cast<int>(layers));
    if (top == Top::surface) count[Dim - 1] = 2 * edge;
    std::vector<Vec<Dim>> all;
    Noise noise(7);
    for (const Vec<Dim>& x : lattice_points<Dim>(Vec<Dim>::Constant(0.5 - layers), count, 1.0)) {
      const Vec<Dim - 1> across = x.template head<Dim - 1>();
      const bool is_beside = x[Dim - 1] < 0.0 || across.minCoeff() < 0.0 || across.maxCoeff() > edge;
      const bool is_above = x[Dim - 1] > edge;
      if (top == Top::surface && is_above && !is_beside) continue;
      is_water.push_back(!is_beside && !is_above);
      all.push_back(is_water.back() ? Vec<Dim>(x + 0.1 * noise.vector<Dim>()) : x);
    }
    return all;
  }

  std::vector<char> is_water;
  ParticleSet<Dim> set;
  std::vector<std::vector<double>> weights;
  std::vector<double> diagonal;
  std::vector<double> rhs;
};

template <int Dim>
int iterations_in(const Tank<Dim>& tank, PreconditionerName preconditioner = PreconditionerName::cell_multigrid) {
  PressureSolverTable settings = multigrid_settings();
  settings.preconditioner = preconditioner;
  std::vector<double> solution;
  const SolveReport report = tank.solve(solution, settings);
  EXPECT_LE(report.residual, tolerance);
  EXPECT_EQ(report.restarts, 0U);
  return report.iterations;
}

/// For systems up to 15 times as large as the first of these.
constexpr int max_iterations = 12;

TEST(CellMultigrid, IterationsDoNotGrowWithDepth) {
  for (const int edge : {25, 50, 100}) {
    EXPECT_LE(iterations_in(Tank<2>(edge, Top::surface)), max_iterations) << edge << " rows deep";
  }
  for (const int edge : {8, 12, 20}) {
    EXPECT_LE(iterations_in(Tank<3>(edge, Top::surface)), max_iterations) << edge << " rows deep";
  }
  // The iterations of SSOR grow, which shows that the systems are large enough:
  EXPECT_GT(iterations_in(Tank<2>(100, Top::surface), PreconditionerName::ssor), 2 * max_iterations);
}

TEST(CellMultigrid, AClosedTankIsNoHarder) {
  EXPECT_LE(iterations_in(Tank<2>(50, Top::lid)), max_iterations);
  EXPECT_LE(iterations_in(Tank<3>(12, Top::lid)), max_iterations);
}

TEST(CellMultigrid, WaterFarFromTheOriginIsNoHarder) {
  Tank<2> flat(50, Top::surface);
  for (Vec<2>& x : flat.set.particles.position) x += Vec<2>(-6e6, 5.3e6);
  EXPECT_LE(iterations_in(flat), max_iterations);
  Tank<3> solid(12, Top::surface);
  for (Vec<3>& x : solid.set.particles.position) x += Vec<3>(6e6, 5.3e6, -4e6);
  EXPECT_LE(iterations_in(solid), max_iterations);
}

/// Iterations for a tank in which some rows near the surface have larger diagonals, as where tension is limited. The
/// initial guess is `share_of_solution` times the solution before. The multigrid is that of the previous solve, or a
/// new one.
int iterations_after_division(double share_of_solution, bool has_solved_before) {
  constexpr int edge = 40;
  const Tank<2> tank(edge, Top::surface);
  std::vector<double> start;
  tank.solve(start, multigrid_settings());
  PressureSystem system(multigrid_settings());
  tank.pose(system);
  std::vector<double> solution(system.size(), 0.0);
  if (has_solved_before) system.solve(solution);
  for (std::size_t i = 0; i < system.size(); ++i) {
    const Vec<2>& x = tank.set.particles.position[i];
    const double share = 0.1 * static_cast<double>(i % 3);
    solution[i] = share_of_solution * start[i];
    if (!tank.is_water[i] || x[1] < edge - 2.0 || std::fmod(x[0], 10.0) > 2.0) continue;
    system.divide_diagonal(i, share);
    solution[i] *= share;
  }
  const SolveReport report = system.solve(solution);
  EXPECT_LE(report.residual, tolerance);
  EXPECT_EQ(report.restarts, 0U);
  return report.iterations;
}

TEST(CellMultigrid, FollowsDividedDiagonals) {
  // Near the solution the first level of the multigrid follows the change; without this the solve stagnates.
  EXPECT_LE(iterations_after_division(1.0, true), 3 * iterations_after_division(1.0, false) / 2);
  // Far from the solution the multigrid is built anew.
  EXPECT_EQ(iterations_after_division(0.0, true), iterations_after_division(0.0, false));
}

TEST(CellMultigrid, TheSameSystemHasTheSameSolutionBitForBit) {
  const Tank<2> tank(30, Top::surface);
  std::vector<double> first;
  std::vector<double> second;
  tank.solve(first, multigrid_settings());
  tank.solve(second, multigrid_settings());
  EXPECT_EQ(first, second);
}

/// Rows for a ring of n unknowns with spacing 1, each coupled with its neighbours by 1, and the cells of their
/// positions. The system borrows `columns`.
void pose_ring(PressureSystem& system, int n, double own, std::vector<std::int32_t>& columns) {
  std::vector<std::size_t> row_begin{0};
  std::vector<Vec<2>> position;
  for (int i = 0; i < n; ++i) {
    for (const int j : std::set{(i + 1) % n, (i + n - 1) % n}) columns.push_back(j);
    row_begin.push_back(columns.size());
    position.emplace_back(i, 0.0);
  }
  system.set_pattern(row_begin, columns);
  system.set_cells(find_cells<2>(std::span<const Vec<2>>(position), cell_edge, [](std::size_t) { return true; }));
  Noise noise(5);
  for (int i = 0; i < n; ++i) {
    PressureSystem::Row row = system.row(i);
    row.set_weights([](std::size_t) { return 1.0; });
    row.finish(2.0 + own, noise());
  }
}

TEST(CellMultigrid, AFreeConstantStaysOut) {
  PressureSystem system(multigrid_settings());
  system.set_constant_is_free(true);
  std::vector<std::int32_t> columns;
  pose_ring(system, 1000, 0.0, columns);
  std::vector<double> solution(1000, 0.0);
  const SolveReport report = system.solve(solution);
  EXPECT_LE(report.residual, tolerance);
  double sum = 0.0;
  double largest = 0.0;
  for (const double value : solution) {
    sum += value;
    largest = std::max(largest, std::abs(value));
  }
  EXPECT_NEAR(sum, 0.0, 1e-10 * largest * 1000);
}

TEST(CellMultigrid, RowsWithoutNeighboursAndFewRowsAreSolved) {
  for (const std::size_t count : {1, 2, 3}) {  // lone particles, far apart
    PressureSystem system(multigrid_settings());
    system.set_pattern(std::vector<std::size_t>(count + 1, 0), {});
    std::vector<Vec<2>> position;
    for (std::size_t i = 0; i < count; ++i) position.emplace_back(1e9 * static_cast<double>(i), -1e9);
    system.set_cells(find_cells<2>(std::span<const Vec<2>>(position), cell_edge, [](std::size_t) { return true; }));
    for (std::size_t i = 0; i < count; ++i) system.row(i).finish(2.0, 6.0);
    std::vector<double> solution(count, 0.0);
    EXPECT_LE(system.solve(solution).residual, tolerance);
    for (const double value : solution) EXPECT_NEAR(value, 3.0, 3.0 * tolerance);
  }
  PressureSystem system(multigrid_settings());
  std::vector<std::int32_t> columns;
  pose_ring(system, 3, 1.0, columns);
  std::vector<double> solution(3, 0.0);
  EXPECT_LE(system.solve(solution).residual, tolerance);
}

TEST(CellMultigrid, ManyDropsAreSolvedLikeOneBody) {
  // Separate pieces of the ring: every fifth particle has p = 0, like air.
  PressureSystem system(multigrid_settings());
  std::vector<std::int32_t> columns;
  pose_ring(system, 1000, 0.0, columns);
  for (std::size_t i = 0; i < 1000; i += 5) system.row(i).finish_as_zero();
  std::vector<double> solution(1000, 0.0);
  const SolveReport report = system.solve(solution);
  EXPECT_LE(report.residual, tolerance);
  EXPECT_LE(report.iterations, max_iterations);
}

double norm(const std::vector<double>& x) { return std::sqrt(std::inner_product(x.begin(), x.end(), x.begin(), 0.0)); }

Goal goal_of(double residual) { return {.tolerance = residual, .residual = residual, .iterations = 500}; }

TEST(Orthomin, ItsResidualIsThatOfItsSolutionAndNeverGrows) {
  const Tank<2> tank(30, Top::surface);
  LinearSystem system;
  tank.pose(system);
  std::vector<double> x(system.size(), 1.0);
  Iterate iterate{x, std::vector<double>(system.size())};
  const auto find_residual = [&] {
    system.multiply(x, iterate.residual);
    for (std::size_t i = 0; i < x.size(); ++i) iterate.residual[i] = system.rhs()[i] - iterate.residual[i];
  };
  find_residual();
  const double start = norm(iterate.residual);
  KeptMultigrid multigrid;
  Orthomin method(multigrid);
  method.begin(system, 1.0);
  const MethodOutcome outcome = method.improve(system, goal_of(1e-6 * start), iterate);
  EXPECT_EQ(outcome.end, MethodOutcome::End::converged);
  ASSERT_TRUE(outcome.residual.has_value());
  EXPECT_LE(*outcome.residual, 1e-6 * start);
  EXPECT_DOUBLE_EQ(*outcome.residual, norm(iterate.residual));
  find_residual();
  EXPECT_NEAR(*outcome.residual, norm(iterate.residual), 1e-12 * start);
  ASSERT_EQ(outcome.history.size(), static_cast<std::size_t>(outcome.iterations) + 1);
  EXPECT_DOUBLE_EQ(outcome.history[0], start);
  for (std::size_t k = 1; k < outcome.history.size(); ++k) EXPECT_LE(outcome.history[k], outcome.history[k - 1]);
}

/// Iterations after the tension of the three rows at the surface was limited. The multigrid was built before and has
/// followed the change, or was built after it.
int iterations_with_held_surface(bool has_followed) {
  constexpr int edge = 40;
  constexpr double depth = 3.0;
  const Tank<2> tank(edge, Top::surface);
  LinearSystem system;
  tank.pose(system);
  KeptMultigrid multigrid;
  Orthomin method(multigrid);
  if (has_followed) method.begin(system, 1.0);
  for (std::size_t i = 0; i < system.size(); ++i) {
    const Vec<2>& x = tank.set.particles.position[i];
    if (tank.is_water[i] && x[1] > edge - depth) system.divide_diagonal(i, 0.1 * static_cast<double>(i % 3));
  }
  method.begin(system, 0.0);  // so near to the solution a multigrid follows the change
  std::vector<double> x(system.size(), 0.0);
  Iterate iterate{x, {system.rhs().begin(), system.rhs().end()}};
  return method.improve(system, goal_of(tolerance * norm(iterate.residual)), iterate).iterations;
}

TEST(CellMultigrid, CoarseLevelsFollow) {
  // If only the first level follows, 13 iterations instead of 9.
  EXPECT_LE(iterations_with_held_surface(true), 5 * iterations_with_held_surface(false) / 4);
}

TEST(Orthomin, SaysWhenItIsStuck) {
  // x_i - 3 x_(i+1) = b_i on a ring. The multigrid is made for diagonals larger than the sum of the other weights and
  // does not solve this system.
  constexpr int n = 1000;
  std::vector<std::size_t> row_begin{0};
  std::vector<std::int32_t> columns;
  Cells cells{.dimension = 2, .number = {}};
  for (int i = 0; i < n; ++i) {
    columns.push_back((i + 1) % n);
    row_begin.push_back(columns.size());
    cells.number.push_back(i / 4);
  }
  LinearSystem system;
  system.set_pattern(row_begin, columns);
  system.set_cells(cells);
  Noise noise(3);
  for (int i = 0; i < n; ++i) {
    LinearSystem::Row row = system.row(i);
    row.set_weights([](std::size_t) { return 3.0; });
    row.finish(1.0, noise());
  }
  const SuspendFpTraps suspended;  // the cycles diverge
  KeptMultigrid multigrid;
  Orthomin method(multigrid);
  method.begin(system, 1.0);
  std::vector<double> x(n, 0.0);
  Iterate iterate{x, {system.rhs().begin(), system.rhs().end()}};
  const double start = norm(iterate.residual);
  const MethodOutcome outcome = method.improve(system, goal_of(1e-6 * start), iterate);
  EXPECT_EQ(outcome.end, MethodOutcome::End::broke_down);
  EXPECT_NE(outcome.reason.find("Orthomin"), std::string::npos) << outcome.reason;
  EXPECT_LE(norm(iterate.residual), start);
}

template <class Dimension>
class FindCells : public testing::Test {};
TYPED_TEST_SUITE(FindCells, Dimensions);

TYPED_TEST(FindCells, CellsMakeUpLargerOnes) {
  constexpr int Dim = TypeParam::value;
  const std::vector<Vec<Dim>> positions = jittered_cube<Dim>(8, 1.0, 0.4);
  const auto everywhere = [](std::size_t) { return true; };
  double edge = 1.0;
  const Cells small = find_cells<Dim>(std::span<const Vec<Dim>>(positions), edge, everywhere);
  EXPECT_EQ(small.dimension, Dim);
  for (int level = 0; level < 4; ++level, edge *= 2.0) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        bool is_same = true;
        for (int d = 0; d < Dim; ++d) {
          is_same = is_same && std::floor(positions[i][d] / edge) == std::floor(positions[j][d] / edge);
        }
        EXPECT_EQ(small.number[i] >> (level * Dim) == small.number[j] >> (level * Dim), is_same);
      }
    }
  }
  const Cells none = find_cells<Dim>(std::span<const Vec<Dim>>(positions), 1.0, [](std::size_t) { return false; });
  for (const std::uint64_t number : none.number) EXPECT_EQ(number, Cells::none);
}

}  // namespace
}  // namespace tailwater
