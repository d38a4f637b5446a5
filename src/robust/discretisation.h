// The default formulation: conservative operators, air instead of a detected surface, dummies behind walls. For water
// at i, with the pair vectors a_ij of operators/pair_vectors.h and the weights c_ij of operators/laplacian_morris.h,
//
//   grad p_i = sum_j w_j (p_i + p_j) a_ij                                            gradient.cpp
//   div u_i  = sum_j w_j (u_j - u_i) . a_ij
//   sum_j c_ij (p_i - p_j) + a_i p_i =                                               rows.cpp
//       -(rho/dt) (div u_star - target) + gamma rho (s_i (C/C_0 - 1) + o_i)/dt^2     source.cpp
//   viscous force: Newtonian, and one that damps noise only                          viscous_force.cpp
//
// Between liquids of different density the rows have c_ij/rho_ij, and the gradient p_ij (operators/interfaces.h).
// docs/theory/schemes.md and robustness.md give the reasons. docs/theory/devices.md lists the terms beyond the
// equations of the flow.
#pragma once

#include "case/choices.h"
#include "closures/air.h"
#include "closures/shifting.h"
#include "flow/flow.h"

namespace tailwater {

/// Parameters of the operators for one case.
struct RobustLaws {
  PairVectors pair_vectors = PairVectors::corrected;
  AirLaw air;
  ShiftingLaw shifting;
  double density_relaxation = 0.0;  ///< gamma: density relaxation per dx travelled at the speed of the time-step rule
};

template <int Dim>
class RobustDiscretisation final : public Discretisation<Dim> {
 public:
  explicit RobustDiscretisation(const RobustLaws& laws) : laws_(laws) {}

  void find_surface(Flow<Dim>& flow, SurfaceMarks marks) override;
  void find_pair_vectors(Flow<Dim>& flow) override;
  void add_viscous_force(const Flow<Dim>& flow, std::span<const Mat<Dim>> velocity_gradient,
                         std::vector<Vec<Dim>>& acceleration) const override;
  std::size_t write_rows(Flow<Dim>& flow) const override;
  PressureSource find_source(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity, std::span<const double> target,
                             double dt) const override;
  void find_divergence(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity,
                       std::span<double> divergence) const override;
  void find_gradient(const Flow<Dim>& flow, const std::vector<double>& pressure,
                     std::span<Vec<Dim>> gradient) const override;
  void find_air_weights(const Flow<Dim>& flow, std::span<const std::size_t> particles,
                        std::span<double> weights) const override;
  void find_gradient_at(const Flow<Dim>& flow, std::span<const std::size_t> particles,
                        const std::vector<double>& pressure, std::span<Vec<Dim>> gradient) const override;
  void wall_reactions(const Flow<Dim>& flow, std::span<const std::size_t> walls, const std::vector<double>& pressure,
                      std::span<Vec<Dim>> pushes) const override;
  void reactions_seen_by_water(const Flow<Dim>& flow, std::span<const std::size_t> water, std::span<const double> share,
                               const std::vector<double>& pressure, std::span<Vec<Dim>> pushes) const override;
  std::size_t find_shifts(Flow<Dim>& flow, double dt, std::vector<Vec<Dim>>& shifts) const override;

 private:
  double closing_weight(const Flow<Dim>& flow, std::size_t i, double sum) const;

  RobustLaws laws_;
};

}  // namespace tailwater
