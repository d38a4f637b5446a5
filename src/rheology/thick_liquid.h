// A liquid whose viscous forces would limit the time step, a part of a flow. With the pressure q of the last step and
// gravity g, a step first solves for the velocity v that viscous forces leave at its end,
//
//   rho (v - u)/dt = div(2 mu D(v)) - grad q + rho g,      2 mu D = the law's stress (case/rheology.h),
//
// in which the law takes the shear rates of the velocity found last. The projection then starts from
// v + dt (grad q/rho - g), so that only the change of the pressure acts on v: a steady flow does not depend on the
// step. The pressure p of the projection lacks the viscous stress of the divergence of v. So q
// becomes p - mu div v (the rotational form of Timmermans et al. 1996), without which the pressure of a flow at
// low Reynolds numbers would follow only in many steps. Derivation: docs/theory/rheology.md.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "case/spec.h"
#include "closures/spalart_allmaras.h"
#include "flow/flow.h"
#include "rheology/viscous_operator.h"

namespace tailwater {

template <int Dim>
class ThickLiquid final : public Part<Dim> {
 public:
  ThickLiquid() = default;
  /// The liquids of Setup::liquids, or the one of the case.
  explicit ThickLiquid(std::vector<LiquidTable> liquids) : liquids_(std::move(liquids)) {}

  /// Shear rate [1/s] and dynamic viscosity [Pa s] of owned particle i in the last step; 0 before the first one.
  double shear_rate(std::size_t i) const { return i < shear_rate_.size() ? shear_rate_[i] : 0.0; }
  double viscosity(std::size_t i) const { return i < forces_.viscosity().size() ? forces_.viscosity()[i] : 0.0; }

  std::string_view name() const override { return "thick_liquid"; }
  Json save() const override;
  bool restore(const Json& saved) override;
  void reordered(Reordering how) override;
  StepLimits step_limits(const Flow<Dim>& flow) const override;
  void begin_step(Flow<Dim>& /*flow*/, double dt) override { is_at_start_ = dt == 0.0; }
  void change_prediction(const Flow<Dim>& flow, std::span<const Vec<Dim>> acceleration, double dt,
                         std::span<Vec<Dim>> predicted) override;
  int pose(Flow<Dim>& flow, std::span<const Vec<Dim>> predicted, double dt) override;
  void correct(Flow<Dim>& flow, double dt) override;
  void stay(Flow<Dim>& flow) override;
  void add_work(const Flow<Dim>& flow, const std::vector<double>& on_walls, double dt, Works& works) const override;
  std::vector<StepColumn> step_columns() const override;
  void add_to_summary(const Flow<Dim>& flow, Json& summary) const override;
  void warn(const Flow<Dim>& flow) override;

 private:
  /// Guesses of v: the present velocity, the last v, and the straight line through the last two.
  enum class Guess { present, last, line };
  static constexpr int guess_count = 3;

  void solve(const Flow<Dim>& flow, std::span<const Vec<Dim>> force, double dt, std::span<const Vec<Dim>> predicted);
  int solve_pass(const Flow<Dim>& flow, std::span<const double> inertia, std::span<const Vec<Dim>> impulse);
  Vec<Dim> guess_of(const Flow<Dim>& flow, Guess guess, std::size_t i) const;
  void guess(const Flow<Dim>& flow);
  void remember(const Flow<Dim>& flow);
  bool is_last_pass(const Flow<Dim>& flow, std::span<const Vec<Dim>> before, int pass);
  void find_wall_rates(const Flow<Dim>& flow, double dt);
  const LiquidTable& liquid_of(const Flow<Dim>& flow, std::size_t i) const {
    return liquids_[flow.setup.liquids.of(flow.state.particles.id[i])];
  }
  void find_expansion(const Flow<Dim>& flow);
  std::vector<double> pressing_pressure(const Flow<Dim>& flow);
  double find_yielded_fraction(const Flow<Dim>& flow) const;
  void find_viscosity(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity);

  std::vector<LiquidTable> liquids_;
  ViscousOperator<Dim> forces_;
  int iterations_ = 0;             ///< of the last step
  double yielded_fraction_ = 0.0;  ///< of the volume of the fluid, on all ranks, in the last step
  bool has_converged_ = true;
  bool has_warned_ = false;

  // The last steps, until particles are reordered.
  std::vector<Vec<Dim>> last_;         ///< m/s; v of owned particles in the last step
  std::vector<Vec<Dim>> before_last_;  ///< m/s; and in the step before
  Guess guess_ = Guess::present;       ///< the best one for the last step
  /// sqrt(W); the natural norm of the residual of the present velocity when it was the guess, beside Coulomb walls of
  /// the last v.
  double scale_residual_ = 0.0;
  bool has_viscosity_ = false;  ///< of the last pass, in the present order of the particles
  double contraction_ = 1.0;    ///< movement of a pass over that of the one before it
  double longest_step_ = std::numeric_limits<double>::infinity();  ///< s; by the lag of the pressure in the last step

  bool is_at_start_ = false;  ///< only the initial pressure is computed

  // The present step; owned particles, but the velocity of ghosts too.
  WallRates<Dim> walls_;            ///< at the end of the step
  std::vector<Vec<Dim>> velocity_;  ///< m/s; v
  double moved_ = 0.0;              ///< m/s; by the last pass, root of the sum of squares
  std::vector<double> shear_rate_;  ///< 1/s
  std::vector<double> expansion_;   ///< 1/s; div v
  double work_ = 0.0;               ///< J
};

/// Null if the case has no liquid whose viscous forces are solved for.
template <int Dim>
std::unique_ptr<Part<Dim>> make_thick_liquid(const CaseSpec& spec, const Setup<Dim>& setup,
                                             const Boundary<Dim>& boundary);

}  // namespace tailwater
