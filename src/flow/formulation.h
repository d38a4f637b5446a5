// A formulation: the discretisation of a flow and the order of a step. published/make_flow.h assembles the four
// formulations of the case file from `robust` and `published`. No other file depends on the choice. Its functions are
// called once per loop, never per pair.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "base/vec.h"
#include "flow/step.h"
#include "kernel/kernel.h"

namespace tailwater {

template <int Dim>
struct Flow;
class PressureRamp;
template <int Dim>
class WallModel;

/// Sources of the owned rows of the pressure equation [Pa/m^2], in two summands.
struct PressureSource {
  std::vector<double> rows;
  /// Source that corrects the density error besides the divergence, and so adds energy; empty if there is none.
  std::vector<double> density;
};

/// Whether to mark the surface, or to keep the marks of an earlier pass of a repeated projection.
enum class SurfaceMarks { found, kept };

/// The operators of a formulation. Those of the gradient, the divergence and the rows read the pairs and the results of
/// the first two functions.
template <int Dim>
class Discretisation {
 public:
  virtual ~Discretisation() = default;

  /// Marks the free surface, unless the marks are kept, and computes `interior` for particles and ghosts. Needs the
  /// kernel sums (flow/locate.cpp). Collective.
  virtual void find_surface(Flow<Dim>& flow, SurfaceMarks marks) = 0;

  /// Computes the pair vectors for gradient and divergence. Collective.
  virtual void find_pair_vectors(Flow<Dim>& flow) = 0;

  /// Adds the viscous force over the mass [m/s^2] of the present velocity; `velocity_gradient` is its gradient, empty
  /// if the formulation does not need it. Collective.
  virtual void add_viscous_force(const Flow<Dim>& flow, std::span<const Mat<Dim>> velocity_gradient,
                                 std::vector<Vec<Dim>>& acceleration) const = 0;

  /// Writes the rows of the fluid's equation that are solved for, without their sources. Returns the number of rows
  /// that fell back to two-point weights.
  virtual std::size_t write_rows(Flow<Dim>& flow) const = 0;

  /// The source, for a predicted velocity that is up to date on ghosts and a target divergence [1/s]. Collective.
  virtual PressureSource find_source(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity,
                                     std::span<const double> target, double dt) const = 0;

  /// Divergence of a velocity [1/s] at owned particles that are solved for; other entries stay.
  virtual void find_divergence(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity,
                               std::span<double> divergence) const = 0;

  /// Gradient of a pressure field [its unit/m] at the same particles, divided by the density of each over that of the
  /// case. 0 where a consistent operator does not exist, so that spray falls freely.
  virtual void find_gradient(const Flow<Dim>& flow, const std::vector<double>& pressure,
                             std::span<Vec<Dim>> gradient) const = 0;

  /// Closing weights of the finished rows of these owned water particles, as for air at p = 0 around them, in the rows'
  /// unit. Called only where air has a pressure, which is in the robust formulation.
  virtual void find_air_weights(const Flow<Dim>& flow, std::span<const std::size_t> particles,
                                std::span<double> weights) const;

  /// Gradient of a pressure field at these owned water particles. Called only in the robust formulation.
  virtual void find_gradient_at(const Flow<Dim>& flow, std::span<const std::size_t> particles,
                                const std::vector<double>& pressure, std::span<Vec<Dim>> gradient) const;

  /// Reaction of each of these owned wall particles on the fluid to a pressure field, over its volume [the field's
  /// unit/m]: the sum of its contributions to the gradients at its fluid neighbours.
  virtual void wall_reactions(const Flow<Dim>& flow, std::span<const std::size_t> walls,
                              const std::vector<double>& pressure, std::span<Vec<Dim>> pushes) const = 0;

  /// Reaction of each of these owned fluid particles on the walls by the same pairs, over its volume. Each neighbour
  /// counts with the fraction `share`, which is 0 for fluid and up to date on ghosts.
  virtual void reactions_seen_by_water(const Flow<Dim>& flow, std::span<const std::size_t> water,
                                       std::span<const double> share, const std::vector<double>& pressure,
                                       std::span<Vec<Dim>> pushes) const = 0;

  /// Computes the shifts [m] of owned particles and updates the fields that change with them. Returns the number of
  /// shifts that exceeded their bound. Collective.
  virtual std::size_t find_shifts(Flow<Dim>& flow, double dt, std::vector<Vec<Dim>>& shifts) const = 0;
};

/// A formulation of one case.
template <int Dim>
struct FlowFormulation {
  std::shared_ptr<Discretisation<Dim>> discretisation;
  std::shared_ptr<const WallModel<Dim>> walls;
  Kernel<Dim> kernel = make_kernel<Dim>(KernelName::wendland_c2, 1.0);

  /// The step function: performs a step of dt, without the operations common to all formulations (schemes/advance.h).
  StepReport (*take_step)(Flow<Dim>&, const StepStart<Dim>&, double dt) = nullptr;
  /// Computes the pressure at the start, like a first step of dt. Afterwards all particles are where they were.
  void (*find_first_pressure)(Flow<Dim>&, const StepStart<Dim>&, double dt) = nullptr;

  // Required data of the surroundings.
  bool needs_velocity_gradient = false;
  bool needs_concentration_gradient = false;

  // Choices within a step.
  bool surface_is_air = false;             ///< missing neighbours count as air; no tension near the surface
  bool is_divergence_free_midway = false;  ///< otherwise at the start of the step (F18)
  bool moves_with_mean_velocity = false;   ///< the mean over the step (F17); otherwise the new velocity
  bool gravity_in_prediction = false;      ///< as published; walls then receive it through the water falling on them
  bool friction_is_viscous = false;        ///< the viscous force uses the velocity that walls show, friction included
  bool shifts_particles = false;
  /// A second projection acts at the new positions; the first projection of the next step has the same matrix.
  bool has_second_projection = false;

  // Parameters of closures.
  double courant = 0.0;
  double length = 0.0;             ///< m; L of the time-step rule; 0: from the case
  double viscous_share = 0.125;    ///< b of the time-step rule
  double fastest_over_reference =  ///< upper limit of the speed in that rule, over sqrt(2 g L)
      std::numeric_limits<double>::infinity();
  double artificial_viscosity = 0.0;  ///< c_a of (F3)
  double noise_viscosity = 0.0;       ///< over dx times the speed of the time-step rule
  /// The pressure that balances the weight below a free surface (flow/balanced_pressure.h); null: there is none.
  std::shared_ptr<const PressureRamp> balanced_ramp;
  bool has_eddy_viscosity = false;  ///< in the boundary layers of walls with friction
  double energy_slack = 0.0;        ///< rise of the energy at which the density source stops lifting (pressure/energy)
};

}  // namespace tailwater
