// Viscous forces as the negative derivative of a dissipation that is never negative,
//
//   Phi = 1/2 sum_i w_i mu_i s_i^2,
//   s_i^2 = k_i 2 D_i:D_i + sum_j w_j F_ij |z_ij|^2
//           + sum_w 2 (1 + b_iw) w_w F_iw (|P_w (u_i - V_w)|^2 + lambda_w |(I - P_w) (u_i - V_w)|^2),  P_w = n_w n_w^T.
//
// G_i = [ sum_j w_j F_ij (u_j - u_i) (r_j - r_i)^T ] M_i^-1 is the velocity gradient by least squares over the fluid j,
// with M_i = sum_j w_j F_ij (r_j - r_i) (r_j - r_i)^T and F = -(dW/dr)/r. D_i is its symmetric part, and
// z_ij = u_j - u_i - G_i (r_j - r_i) the rest that a linear field leaves, without which the force would not see what
// varies from particle to particle. The force on particle i is
//
//   f_i = w_i sum_j w_j F_ij [ (mu_i + mu_j) (u_j - u_i) + (Q_i + Q_j) (r_j - r_i) ] + those of walls,
//   Q_i = mu_i (2 k_i D_i M_i^-1 - G_i),
//
// which inside, where M = I and k = 1, is the two-point Laplacian (laplacian_morris.h) and the transposed term
// div(mu (grad u)^T) of closures/viscosity.h. Since s_i is exact for linear fields on any set of particles and 0 for
// rigid motion:
// - The operator is symmetric and dissipates, for any viscosity of the particles.
// - Linear and angular momentum are conserved, but for walls.
// - At a free surface the stress vanishes, the natural condition.
//
// Walls: between particle i at the distance d_i from a wall and a particle w of it, b_iw = d_w/d_i behind
// the wall, the velocity is linear and that of the wall on it. V_w is the velocity that the rigid motion of the wall
// has at r_i, so that a liquid that turns with a wall meets no force. lambda_w is the wall's friction, 0 of free
// slip. Across the wall the velocity is that of the wall whatever its friction. Otherwise v could lead through the
// wall, and mu div v, which corrects the pressure, would be wrong there (thick_liquid.h). k_i is the fraction of the
// least moment of neighbours that fluid alone has there, so that uniform shear beside a wall is in balance. Where fluid
// has too few neighbours for a gradient, as in spray, mu_i fades. Derivation: docs/theory/rheology.md.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "flow/flow.h"
#include "rheology/coulomb_friction.h"

namespace tailwater {

/// The numbers of a particle that the forces on its neighbours depend on.
template <int Dim>
struct alignas(Dim == 2 ? 32 : 64) StressEnd {
  std::array<float, Dim> velocity;          ///< m/s
  float viscosity;                          ///< Pa s
  std::array<float, Dim * Dim> transposed;  ///< Pa; Q, column by column
};

template <int Dim>
class ViscousOperator {
 public:
  /// Finds what depends on the positions and on the motion of the walls alone.
  void locate(const Flow<Dim>& flow, const WallRates<Dim>& walls);

  /// The shear rates s_i [1/s] of owned fluid. The velocity must be up to date on ghosts.
  void find_shear_rates(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity, std::span<double> rate) const;

  /// Lets the liquid slide along walls with Coulomb friction (coulomb_friction.h), which changes its shear rates. The
  /// viscosity must be that of the last pass. Collective.
  void slide(const Flow<Dim>& flow, const WallRates<Dim>& walls, const LawOfParticle& law,
             const std::vector<double>& pressure, std::span<const Vec<Dim>> velocity, std::span<double> rate);
  /// Whether `velocity`, the result of a pass, slides where the pass did not. Collective.
  bool has_changed_slip(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity) const;
  CoulombFriction<Dim>& coulomb() { return coulomb_; }
  const CoulombFriction<Dim>& coulomb() const { return coulomb_; }

  /// Sets the dynamic viscosity [Pa s] of owned fluid; 0 of walls. Collective.
  void set_viscosity(const Flow<Dim>& flow, std::span<const double> viscosity);
  /// The dynamic viscosity of all particles, ghosts too.
  const std::vector<double>& viscosity() const { return viscosity_; }
  /// Viscosity of all particles, reduced to 0 for those with so few neighbours that they have no gradient.
  const std::vector<double>& shared_viscosity() const { return shared_viscosity_; }

  /// The forces [N] of fluid at `velocity` on owned particles, and of walls as if these were at rest. Gets the ghosts
  /// of `velocity`. Collective.
  void find_forces(const Flow<Dim>& flow, std::vector<Vec<Dim>>& velocity, std::span<Vec<Dim>> force);

  /// The part of the force on owned particle i that comes from the motion of the walls, and does not depend on its
  /// velocity [N].
  Vec<Dim> drag_of_walls(const Flow<Dim>& flow, std::size_t i) const {
    const Vec<Dim> drag = friction_of_walls(flow, i) * wall_velocity_[i];
    if (!may_slip()) return drag;
    const Vec<Dim> rest = drag - relief_of_walls(flow, i) * wall_velocity_[i];
    return coulomb_.has_walls() ? Vec<Dim>(rest - coulomb_.offset(i)) : rest;
  }

  /// Writes w_i w_j F_ij (mu_i + mu_j) [N s/m] of the pairs of fluid particle i, 0 for walls. Returns their sum.
  double write_weights(const Flow<Dim>& flow, std::size_t i, float* weights) const;
  /// Force of walls at rest, if they are of no slip, on fluid particle i over its velocity [N s/m].
  double friction_of_walls(const Flow<Dim>& flow, std::size_t i) const {
    return flow.state.particles.volume[i] * viscosity_[i] * wall_weight_[i];
  }
  /// The friction along walls that particle i does not have because of their slip, over its velocity [N s/m].
  Mat<Dim> relief_of_walls(const Flow<Dim>& flow, std::size_t i) const {
    Mat<Dim> relief = Mat<Dim>::Zero();
    if (slips_) relief = flow.state.particles.volume[i] * viscosity_[i] * slip_weight_[i];
    return coulomb_.has_walls() ? Mat<Dim>(relief + coulomb_.relief(i)) : relief;
  }
  /// Whether walls have a fraction of the friction of no slip, or none; the same on all ranks.
  bool slips() const { return slips_; }
  /// Whether walls have such friction, or Coulomb friction.
  bool may_slip() const { return slips_ || coulomb_.has_walls(); }
  /// Friction of walls at rest on component a over that of the velocity [N s/m], with slip.
  double friction_of_walls(const Flow<Dim>& flow, std::size_t i, int a) const {
    const double no_slip = friction_of_walls(flow, i);
    return may_slip() ? no_slip - relief_of_walls(flow, i)(a, a) : no_slip;
  }

  /// The forces [N] on owned wall particles. Velocity and viscosity must be up to date on ghosts.
  void find_forces_on_walls(const Flow<Dim>& flow, const WallRates<Dim>& walls, std::span<const Vec<Dim>> velocity,
                            std::span<Vec<Dim>> force) const;

 private:
  Mat<Dim> weigh_fluid(const Flow<Dim>& flow, std::size_t i);
  Mat<Dim> weigh_walls(const Flow<Dim>& flow, const WallRates<Dim>& walls, std::size_t i);
  Vec<Dim> force_of_fluid(const Flow<Dim>& flow, std::size_t i) const;
  Mat<Dim> gradient(const Flow<Dim>& flow, std::span<const Float4> velocity, std::size_t i) const;

  UnwrittenArray<float> fluid_weight_;    ///< 1/m^2; w_j F_ij of each pair of fluid, 0 of others
  std::vector<Mat<Dim>> inverse_moment_;  ///< M^-1 of owned fluid
  std::vector<double> share_;             ///< of the viscosity; 0 where there is no gradient
  std::vector<double> fluid_share_;       ///< k
  std::vector<double> wall_weight_;       ///< 1/m^2; sum_w 2 (1 + b) w F
  std::vector<Vec<Dim>> wall_velocity_;   ///< m/s; mean of V_w with these weights
  std::vector<Mat<Dim>> slip_weight_;     ///< 1/m^2; part of wall_weight_ that slip takes; empty if none does
  bool slips_ = false;                    ///< some walls have less than the friction of no slip
  std::vector<double> viscosity_;         ///< Pa s
  std::vector<double> shared_viscosity_;  ///< Pa s; times `share_`, ghosts too
  std::vector<StressEnd<Dim>> ends_;      ///< of the last product; kept for its memory
  CoulombFriction<Dim> coulomb_;
};

}  // namespace tailwater
