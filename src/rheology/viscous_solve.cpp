#include "rheology/viscous_solve.h"

#include "base/for_each.h"

namespace tailwater {
namespace {

template <int Dim>
using Field = std::vector<Vec<Dim>>;

/// Over all ranks. Collective.
template <int Dim>
double product(const Flow<Dim>& flow, const Field<Dim>& a, const Field<Dim>& b) {
  const std::size_t owned = flow.state.particles.owned;
  return flow.setup.ranks.sum(sum_over(owned, 0.0, [&](std::size_t i) { return a[i].dot(b[i]); }));
}

/// The system of one step, with its diagonal.
template <int Dim>
struct ViscousSystem {
  const Flow<Dim>& flow;
  const ViscousOperator<Dim>& forces;
  std::span<const double> inertia;
  std::vector<double> diagonal;

  /// Collective.
  void multiply(Field<Dim>& velocity, Field<Dim>& result) const {
    forces.find_forces(flow, velocity, result);
    for_each(result.size(), [&](std::size_t i) { result[i] = inertia[i] * velocity[i] - result[i]; });
  }
  /// Divides a field of owned particles by the diagonal; that of walls is 0.
  void divide(const Field<Dim>& field, Field<Dim>& result) const {
    for_each(field.size(), [&](std::size_t i) {
      result[i] = diagonal[i] > 0.0 ? Vec<Dim>(field[i] / diagonal[i]) : Vec<Dim>(Vec<Dim>::Zero());
    });
  }
};

}  // namespace

template <int Dim>
ViscousReport solve_viscous_step(const Flow<Dim>& flow, const ViscousOperator<Dim>& forces,
                                 std::span<const double> inertia, std::span<const Vec<Dim>> rhs, double tolerance,
                                 int iterations, std::vector<Vec<Dim>>& velocity) {
  const std::size_t owned = flow.state.particles.owned;
  ViscousSystem<Dim> system{flow, forces, inertia, std::vector<double>(owned)};
  forces.find_diagonal(flow, system.diagonal);
  for_each(owned, [&](std::size_t i) { system.diagonal[i] += inertia[i]; });

  Field<Dim> residual(rhs.begin(), rhs.end());
  Field<Dim> divided(owned);
  Field<Dim> product_of_matrix(owned);
  system.divide(residual, divided);
  const double goal = tolerance * tolerance * product(flow, residual, divided);
  system.multiply(velocity, product_of_matrix);
  for_each(owned, [&](std::size_t i) { residual[i] -= product_of_matrix[i]; });
  system.divide(residual, divided);
  Field<Dim> direction = divided;
  double left = product(flow, residual, divided);
  ViscousReport report;
  while (left > goal && report.iterations < iterations) {
    system.multiply(direction, product_of_matrix);
    const double step = left / product(flow, direction, product_of_matrix);
    for_each(owned, [&](std::size_t i) {
      velocity[i] += step * direction[i];
      residual[i] -= step * product_of_matrix[i];
    });
    system.divide(residual, divided);
    const double before = left;
    left = product(flow, residual, divided);
    for_each(owned, [&](std::size_t i) { direction[i] = divided[i] + left / before * direction[i]; });
    ++report.iterations;
  }
  report.has_converged = left <= goal;
  flow.halo().exchange(velocity);
  return report;
}

#define TAILWATER_INSTANTIATE(Dim)                                                                                  \
  template ViscousReport solve_viscous_step(const Flow<Dim>&, const ViscousOperator<Dim>&, std::span<const double>, \
                                            std::span<const Vec<Dim>>, double, int, std::vector<Vec<Dim>>&);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
