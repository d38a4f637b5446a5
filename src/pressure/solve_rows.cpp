#include "pressure/solve_rows.h"

#include "base/for_each.h"
#include "flow/pressure_equation.h"
#include "neighbours/halo.h"

namespace tailwater {

template <int Dim>
SolveReport solve_rows(Flow<Dim>& flow, std::vector<double>& pressure, double tolerance) {
  const std::size_t owned = flow.state.particles.owned;
  flow.halo().exchange(pressure);
  {
    const std::vector<double> guess = pressure;  // rows of some wall models depend on each other
    for_each(owned, [&](std::size_t i) {
      if (!has_equation(flow.role[i])) pressure[i] = flow.equation->rows.answer(i, guess.data());
    });
  }
  return flow.equation->solver.solve(flow.equation->rows, std::span(pressure).first(owned), tolerance);
}

PressureReport report_of(const SolveReport& solved) {
  PressureReport report{.iterations = solved.iterations, .residual = solved.residual, .interventions = {}};
  report.interventions.restarted_solves = solved.restarts;
  return report;
}

TAILWATER_IN_2D_AND_3D(solve_rows);

}  // namespace tailwater
