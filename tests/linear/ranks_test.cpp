// The pressure system on several ranks: unknowns are distributed unevenly, with and without empty ranks. The right-hand
// side is computed from a known solution.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "case/choices.h"
#include "linear/find_cells.h"
#include "support/pressure_system.h"

namespace tailwater {
namespace {

constexpr int small_edge = 24;  // unknowns of a square grid with zeros around it

/// The cell of an unknown; cells are two unknowns wide.
std::uint64_t cell_of(int number, int edge) {
  return spread_bits<2>(number % edge / 2) | spread_bits<2>(number / edge / 2) << 1;
}

double exact(int number) { return std::sin(0.3 * number) + 0.01 * number; }

std::vector<int> neighbours_of(int number, int edge) {
  std::vector<int> neighbours;
  const int x = number % edge;
  const int y = number / edge;
  if (x > 0) neighbours.push_back(number - 1);
  if (x < edge - 1) neighbours.push_back(number + 1);
  if (y > 0) neighbours.push_back(number - edge);
  if (y < edge - 1) neighbours.push_back(number + edge);
  return neighbours;
}

/// The rows of this rank, and the exchange plan for the unknowns that they couple to.
struct Share {
  int edge = small_edge;
  std::vector<int> own;     ///< numbers of the rank's own unknowns
  std::vector<int> ghosts;  ///< numbers of unknowns of other ranks, in the order of their arrival
  ExchangePlan halo;
  std::vector<std::size_t> row_begin{0};
  std::vector<std::int32_t> columns;
};

/// `owner(number)` returns the rank that has an unknown.
template <class Owner>
Share make_share(const Communicator& ranks, Owner&& owner, int edge = small_edge) {
  Share share;
  share.edge = edge;
  std::vector<int> place(edge * edge, -1);
  std::vector<std::vector<std::int32_t>> sent(ranks.size());
  for (int number = 0; number < edge * edge; ++number) {
    if (owner(number) != ranks.rank()) continue;
    place[number] = static_cast<int>(share.own.size());
    share.own.push_back(number);
  }
  for (int rank = 0; rank < ranks.size(); ++rank) {
    for (int number = 0; rank != ranks.rank() && number < edge * edge; ++number) {
      bool is_wanted = false;  // by a row of `rank`
      bool is_needed = false;  // by a row of this rank
      for (const int other : neighbours_of(number, share.edge)) {
        is_wanted = is_wanted || owner(other) == rank;
        is_needed = is_needed || owner(other) == ranks.rank();
      }
      if (owner(number) == ranks.rank() && is_wanted) sent[rank].push_back(place[number]);
      if (owner(number) == rank && is_needed) share.ghosts.push_back(number);
    }
  }
  for (std::size_t k = 0; k < share.ghosts.size(); ++k) {
    place[share.ghosts[k]] = static_cast<int>(share.own.size() + k);
  }
  share.halo = ExchangePlan(ranks, share.own.size(), sent);
  for (const int number : share.own) {
    for (const int other : neighbours_of(number, share.edge)) share.columns.push_back(place[other]);
    std::sort(share.columns.begin() + static_cast<std::ptrdiff_t>(share.row_begin.back()), share.columns.end());
    share.row_begin.push_back(share.columns.size());
  }
  return share;
}

void pass_values(const Share& share, PressureSystem& system) {
  Cells cells{.dimension = 2, .number = {}};
  for (const int number : share.own) cells.number.push_back(cell_of(number, share.edge));
  system.set_cells(std::move(cells));
  for (std::size_t i = 0; i < share.own.size(); ++i) {
    const int number = share.own[i];
    const double scale = 1.0 + number % 5;
    PressureSystem::Row row = system.row(i);
    double rhs = 4.0 * scale * exact(number);
    row.set_weights([&](std::size_t) { return scale; });
    for (const int other : neighbours_of(number, share.edge)) rhs -= scale * exact(other);
    row.finish(4.0 * scale, rhs);
  }
}

class SystemOfRanks : public testing::TestWithParam<PreconditionerName> {};

TEST_P(SystemOfRanks, IsSolvedWhoeverHasTheRows) {
  const Communicator ranks = Communicator::world();
  PressureSolverTable settings;
  settings.preconditioner = GetParam();
  settings.tolerance = 1e-9;
  settings.max_iterations = 2000;
  PressureSystem system(settings, ranks);
  const auto in_slabs = [&](int number) { return number * ranks.size() / (small_edge * small_edge); };
  const auto scattered = [&](int number) { return number % 7 % ranks.size(); };
  const auto all_at_the_last = [&](int) { return ranks.size() - 1; };
  const auto expect_solved = [&](auto&& owner) {
    const Share share = make_share(ranks, owner);
    system.set_pattern(share.row_begin, share.columns, share.halo);
    pass_values(share, system);
    std::vector<double> solution(share.own.size(), 0.0);
    EXPECT_LE(system.solve(solution).residual, settings.tolerance);
    // Rows scaled to unit diagonal: |A^-1|_inf <= edge^2/2 for this grid (the parabola's height), |b|_2 <= 2 |x| n.
    const double bound =
        0.5 * small_edge * small_edge * settings.tolerance * 2.0 * exact(small_edge * small_edge) * small_edge;
    for (std::size_t i = 0; i < share.own.size(); ++i) EXPECT_NEAR(solution[i], exact(share.own[i]), bound);
  };
  expect_solved(in_slabs);
  expect_solved(scattered);
  expect_solved(all_at_the_last);
}

TEST_P(SystemOfRanks, RowsChangedInPlaceReachTheSolver) {
  const Communicator ranks = Communicator::world();
  PressureSolverTable settings;
  settings.preconditioner = GetParam();
  settings.tolerance = 1e-9;
  PressureSystem system(settings, ranks);
  const Share share = make_share(ranks, [&](int number) { return number * ranks.size() / (small_edge * small_edge); });
  system.set_pattern(share.row_begin, share.columns, share.halo);
  pass_values(share, system);
  std::vector<double> solution(share.own.size(), 0.0);
  system.solve(solution);
  for (std::size_t i = 0; i < share.own.size(); ++i) system.divide_diagonal(i, 0.0);  // x = 0
  system.solve(solution);
  for (const double value : solution) EXPECT_EQ(value, 0.0);
}

TEST(SystemOfRanksThatFails, AllFailTogether) {
  const Communicator ranks = Communicator::world();
  PressureSolverTable settings;
  settings.preconditioner = PreconditionerName::jacobi;
  settings.tolerance = 1e-12;
  settings.max_iterations = 2;
  PressureSystem system(settings, ranks);
  const Share share = make_share(ranks, [&](int number) { return number * ranks.size() / (small_edge * small_edge); });
  system.set_pattern(share.row_begin, share.columns, share.halo);
  pass_values(share, system);
  std::vector<double> solution(share.own.size(), 0.0);
  EXPECT_THROW(system.solve(solution), SolverError);
}

TEST(CellMultigridOfRanks, IterationsDoNotGrowWithRanksAndResultsAreRepeatable) {
  // Large enough that several levels are distributed over the ranks before one is gathered.
  constexpr int edge = 160;
  const Communicator ranks = Communicator::world();
  PressureSolverTable settings;
  settings.preconditioner = PreconditionerName::cell_multigrid;
  settings.tolerance = 1e-6;
  const Share share = make_share(
      ranks, [&](int number) { return number * ranks.size() / (edge * edge); }, edge);
  const auto solve = [&] {
    PressureSystem system(settings, ranks);
    system.set_pattern(share.row_begin, share.columns, share.halo);
    pass_values(share, system);
    std::vector<double> solution(share.own.size(), 0.0);
    const SolveReport report = system.solve(solution);
    EXPECT_LE(report.residual, settings.tolerance);
    EXPECT_LE(report.iterations, 15);
    return solution;
  };
  EXPECT_EQ(solve(), solve());
}

INSTANTIATE_TEST_SUITE_P(Ranks, SystemOfRanks,
                         testing::Values(PreconditionerName::ssor, PreconditionerName::cell_multigrid,
                                         PreconditionerName::ilu, PreconditionerName::boomeramg,
                                         PreconditionerName::gamg, PreconditionerName::jacobi),
                         [](const auto& test) {
                           std::string name(name_of(test.param));
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace tailwater
