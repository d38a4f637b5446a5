#include "rheology/viscous_solve.h"

#include <algorithm>
#include <type_traits>

#include "base/for_each.h"
#include "neighbours/halo.h"
#include "rheology/viscous_preconditioner.h"

namespace tailwater {
namespace {

/// The preconditioner lacks the transposed term of the forces. Its corrections are about right for shear, and up to
/// twice the error for expansion: this part of the last one leaves a third of either.
constexpr double part_of_last_correction = 2.0 / 3.0;

/// Numbers as vectors in the same memory, and vectors as their components.
template <int Dim, class Number>
auto as_vectors(std::span<Number> numbers) {
  using Vector = std::conditional_t<std::is_const_v<Number>, const Vec<Dim>, Vec<Dim>>;
  return std::span(reinterpret_cast<Vector*>(numbers.data()), numbers.size() / Dim);
}
template <class Vector>
auto as_numbers(std::span<Vector> vectors) {
  using Number = std::conditional_t<std::is_const_v<Vector>, const double, double>;
  return std::span(reinterpret_cast<Number*>(vectors.data()), vectors.size() * Vector::count);
}

template <int Dim>
class ViscousSystem final : public ShellSystem {
 public:
  ViscousSystem(const Flow<Dim>& flow, ViscousOperator<Dim>& forces, std::span<const double> inertia)
      : flow_(flow),
        forces_(forces),
        inertia_(inertia),
        preconditioner_(flow, forces, inertia),
        with_ghosts_(flow.state.particles.size(), Vec<Dim>::Zero()),
        last_correction_(inertia.size(), Vec<Dim>::Zero()) {}

  void multiply(std::span<const double> x, std::span<double> y) override {
    std::ranges::copy(as_vectors<Dim>(x), with_ghosts_.begin());
    const std::span<Vec<Dim>> result = as_vectors<Dim>(y);
    forces_.find_forces(flow_, with_ghosts_, result);
    for_each(result.size(), [&](std::size_t i) {
      if (is_claimed(flow_.role[i])) result[i].setZero();
      result[i] = inertia_[i] * with_ghosts_[i] - result[i];
    });
  }
  void precondition(std::span<const double> residual, std::span<double> correction) override {
    const std::span<Vec<Dim>> result = as_vectors<Dim>(correction);
    preconditioner_.apply(as_vectors<Dim>(residual), result);
    std::ranges::copy(result, last_correction_.begin());
  }
  /// The correction for the residual that ended the solve. The norm of this residual is computed from it.
  const std::vector<Vec<Dim>>& last_correction() const { return last_correction_; }

 private:
  const Flow<Dim>& flow_;
  ViscousOperator<Dim>& forces_;
  std::span<const double> inertia_;
  ViscousPreconditioner<Dim> preconditioner_;
  std::vector<Vec<Dim>> with_ghosts_;
  std::vector<Vec<Dim>> last_correction_;
};

}  // namespace

template <int Dim>
ShellReport solve_viscous_step(const Flow<Dim>& flow, ViscousOperator<Dim>& forces, std::span<const double> inertia,
                               std::span<const Vec<Dim>> rhs, const ShellGoal& goal, std::vector<Vec<Dim>>& velocity) {
  ViscousSystem<Dim> system(flow, forces, inertia);
  const std::span<Vec<Dim>> owned = std::span(velocity).first(rhs.size());
  std::vector<Vec<Dim>> with_claimed(rhs.begin(), rhs.end());
  for_each(rhs.size(), [&](std::size_t i) {
    if (is_claimed(flow.role[i])) with_claimed[i] = inertia[i] * owned[i];
  });
  const ShellReport report = solve_by_shell(flow.setup.ranks, system, goal,
                                            as_numbers(std::span<const Vec<Dim>>(with_claimed)), as_numbers(owned));
  for_each(owned.size(), [&](std::size_t i) { owned[i] += part_of_last_correction * system.last_correction()[i]; });
  flow.halo().exchange(velocity);
  return report;
}

#define TAILWATER_INSTANTIATE(Dim)                                                                          \
  template ShellReport solve_viscous_step(const Flow<Dim>&, ViscousOperator<Dim>&, std::span<const double>, \
                                          std::span<const Vec<Dim>>, const ShellGoal&, std::vector<Vec<Dim>>&);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
