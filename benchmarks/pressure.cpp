#include <algorithm>
#include <memory>

#include "bench.h"
#include "flow/pressure_equation.h"

namespace tailwater {
namespace {

constexpr double cold_tolerance = 1e-6;
/// Reached by the first iteration, so that a solve to it is the set-up and little else.
constexpr double next_to_nothing = 0.999;

/// The whole rows of a system, one behind the other, each with its diagonal first.
struct WholeRows {
  explicit WholeRows(const LinearSystem& system) {
    const LinearSystem::Part row = system.whole();
    for (std::size_t i = 0; i < system.size(); ++i) {
      column.push_back(static_cast<int>(i));
      value.push_back(1.0);
      for (std::size_t k = row.begin[i]; k < row.end[i]; ++k) {
        column.push_back(row.column[k]);
        value.push_back(-system.scale(i) * row.weight[k]);
      }
      begin.push_back(static_cast<int>(column.size()));
    }
  }

  std::vector<int> begin{0};
  std::vector<int> column;
  std::vector<double> value;
};

/// y = A x: the yardstick. A plain loop over whole rows, so that it stays the same whatever the solver does.
void multiply(const WholeRows& rows, const std::vector<double>& x, std::vector<double>& y) {
  for (std::size_t i = 0; i < y.size(); ++i) {
    double sum = 0.0;
    for (int k = rows.begin[i]; k < rows.begin[i + 1]; ++k) sum += rows.value[k] * x[rows.column[k]];
    y[i] = sum;
  }
}

/// Solves from 0, a new equation each time, as every step has one.
template <int Dim>
void add_cold_solve(Stage<Dim>& stage, const std::string& name, double tolerance) {
  const auto pressure = std::make_shared<std::vector<double>>();
  const auto iterations = std::make_shared<int>(0);
  add_benchmark(
      name,
      [&stage, pressure, iterations, tolerance] {
        *iterations = stage.flow.equation->solver.solve(stage.flow.equation->rows, *pressure, tolerance).iterations;
      },
      [&stage, pressure] {
        stage.pose();
        pressure->assign(stage.flow.equation->rows.size(), 0.0);
      },
      [iterations](benchmark::UserCounters& counters) { counters["iterations_of_solve"] = *iterations; });
}

}  // namespace

template <int Dim>
void add_pressure(Stage<Dim>& stage) {
  const std::size_t size = stage.flow.equation->rows.size();
  const auto x = std::make_shared<std::vector<double>>(size, 1.0);
  const auto y = std::make_shared<std::vector<double>>(size);
  const auto rows = std::make_shared<WholeRows>(stage.flow.equation->rows);
  add_benchmark(
      "pressure/product", [rows, x, y] { multiply(*rows, *x, *y); }, {},
      [rows](benchmark::UserCounters& counters) {
        counters["rows"] = static_cast<double>(rows->begin.size() - 1);
        counters["bytes"] = static_cast<double>(rows->column.size()) * (sizeof(int) + sizeof(double));
      });
  add_cold_solve(stage, "pressure/set_up", next_to_nothing);
  add_cold_solve(stage, "pressure/cold", cold_tolerance);
  // From the pressure of the step before, as steps solve it.
  const auto before = std::make_shared<std::vector<double>>(stage.flow.state.particles.pressure);
  const auto iterations = std::make_shared<int>(0);
  add_benchmark(
      "pressure/step",
      [&stage, iterations] { *iterations = solve(stage.flow, stage.equation, stage.drive).iterations; },
      [&stage, before] {
        stage.pose();
        stage.flow.state.particles.pressure = *before;
      },
      [iterations](benchmark::UserCounters& counters) { counters["iterations_of_solve"] = *iterations; });
}

template void add_pressure<2>(Stage<2>&);
template void add_pressure<3>(Stage<3>&);

}  // namespace tailwater
