// The pressure q that balances the weight of water, where this weight moves nothing. Sums over disordered pairs have
// errors in proportion to the pressure, so they take p - q instead of p, and those of q are the sums over undisturbed
// particles (docs/theory/balanced_pressure.md). There are two such waters:
//
// - Liquids that fill their walls: several in a box, or any in a conduit between openings. No surface can rise or fall,
//   so q = rho_b g . x + c everywhere, and only the difference of the densities and the pressure between the openings
//   drive the flow. What scales with gravity therefore scales with the reduced gravity, at most g, with which the
//   lightest liquid rises in the heaviest one,
//
//     g' = g (rho_heaviest/rho_b - 1).
//
//   rho_b is the density of the lightest liquid times the fullness, which is 0 as soon as there is a free surface, and
//   0 for one liquid in a box.
// - Water below the lowest place of its free surface. q begins there and soon grows by rho_b g per m
//   (operators/pressure_ramp.h). rho_b is the density of the lightest liquid times a fraction that leaves no water
//   with p < q by more than half a row, and that is 0 where no water is more than two rows deep.
//
// No pressure balances the weight along a periodic direction: here g is without it (Setup::gravity_across).
#pragma once

#include <vector>

#include "closures/time_step.h"
#include "flow/flow.h"

namespace tailwater {

class PressureRamp;

/// 1 where water fills its walls, 0 where as much as a particle is beside air, in between otherwise. 0 where open ends
/// or marks of the surface fix the pressure. Collective.
template <int Dim>
double find_fullness(const Flow<Dim>& flow);

/// Finds how much of the weight is balanced in the next step, at the present positions and pressure. At the start,
/// where there is no pressure, water counts as resting. Collective.
template <int Dim>
void find_balance(Flow<Dim>& flow, bool is_start = false);

/// q of the state's last step, without the constant c.
template <int Dim>
class BalancedPressure {
 public:
  /// Below the surface only, or also below what parts need (Part::lowest_unbalanced).
  enum class Extent { used, all_water };

  explicit BalancedPressure(const Flow<Dim>& flow, Extent extent = Extent::used);

  bool is_any() const { return !gradient_.isZero(0.0); }
  /// Whether its gradient is the same everywhere.
  bool is_linear() const { return ramp_ == nullptr; }
  double at(const Vec<Dim>& x) const;  ///< Pa
  /// Pa; on a wall with this normal. On a level wall it carries the water by the sums below.
  double on_wall(const Vec<Dim>& x, const Vec<Dim>& normal) const;
  std::vector<double> at_each(const std::vector<Vec<Dim>>& places) const;
  double below_level(double depth) const;  ///< Pa; `depth` [m] below the level where q begins
  // Sums over pairs of undisturbed particles.
  Vec<Dim> gradient_at(const Vec<Dim>& x) const;  ///< Pa/m
  double morris_sum_at(const Vec<Dim>& x) const;  ///< Pa/m^2; of c_ij (q_i - q_j)

 private:
  double depth_of(const Vec<Dim>& x) const { return down_.dot(x) - level_; }

  Vec<Dim> gradient_ = Vec<Dim>::Zero();  ///< Pa/m; the largest
  const PressureRamp* ramp_ = nullptr;    ///< null: linear
  Vec<Dim> down_ = Vec<Dim>::Zero();
  double level_ = 0.0;  ///< m along `down_`
};

/// q of all particles [Pa]; empty where there is none. In water that fills its walls c makes the least of
/// `pressure` - q in the fluid 0. Collective.
template <int Dim>
std::vector<double> balanced_pressure(const Flow<Dim>& flow, const std::vector<double>& pressure);

/// Gradient [Pa/m] of the pressure of all particles at owned water: by pairs that of p - q, and that of q in
/// undisturbed water. With several liquids over the density of the particle, times that of the case. Collective.
template <int Dim>
void find_pressure_gradient(const Flow<Dim>& flow, const std::vector<double>& pressure, std::span<Vec<Dim>> gradient);

/// The time-step rule of the case, with the reference speed of the reduced gravity.
template <int Dim>
TimeStepRule time_step_rule(const Flow<Dim>& flow);

/// Viscosity [m^2/s] of the noise dissipation at the case's spacing, by the largest speed [m/s], outside the borders of
/// zones. Noise comes from the errors of pairs there, so the reference speed is that of a head of the largest p - q.
template <int Dim>
double noise_viscosity(const Flow<Dim>& flow, double speed);

/// The largest one: with zones that in their borders, which has the reference speed of the case.
template <int Dim>
double largest_noise_viscosity(const Flow<Dim>& flow, double speed);

}  // namespace tailwater
