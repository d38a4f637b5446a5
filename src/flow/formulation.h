// A formulation: how a flow is discretised, and in which order a step is taken. published/make_flow.h makes the four of
// the case file of what stands in `robust` and `published`; no file between here and there asks which one a flow has.
// It is called once per loop, never per pair.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "base/vec.h"
#include "flow/step.h"
#include "kernel/kernel.h"
#include "walls/wall_model.h"

namespace tailwater {

template <int Dim>
struct Flow;

/// Sources of the owned rows of the pressure equation [Pa/m^2], in two summands.
struct PressureSource {
  std::vector<double> rows;
  /// What answers the density error beside a divergence, and so costs energy; empty if there is none.
  std::vector<double> density;
};

/// Later passes of a repeated projection keep the marks of the surface that earlier ones have found.
enum class SurfaceMarks { found, kept };

/// The operators of a formulation. Those of the gradient, the divergence and the rows read the pairs and what the first
/// two functions have found.
template <int Dim>
class Discretisation {
 public:
  virtual ~Discretisation() = default;

  /// Marks the free surface, unless the marks are kept, and finds how far inside the particles are, ghosts too. Needs
  /// the kernel's sums (flow/locate.cpp). Collective.
  virtual void find_surface(Flow<Dim>& flow, SurfaceMarks marks) = 0;

  /// Finds how gradient and divergence see pairs of particles. Collective.
  virtual void find_pair_vectors(Flow<Dim>& flow) = 0;

  /// Adds the viscous force over the mass [m/s^2] of the present velocity; `velocity_gradient` is its gradient, empty
  /// if the formulation does not need it. Collective.
  virtual void add_viscous_force(const Flow<Dim>& flow, std::span<const Mat<Dim>> velocity_gradient,
                                 std::vector<Vec<Dim>>& acceleration) const = 0;

  /// Writes the rows of the fluid's equation that are solved for, without their sources. Returns how many fell back to
  /// two-point weights.
  virtual std::size_t write_rows(Flow<Dim>& flow) const = 0;

  /// The source, for a predicted velocity that is up to date on ghosts and a target of its divergence [1/s].
  /// Collective.
  virtual PressureSource find_source(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity,
                                     std::span<const double> target, double dt) const = 0;

  /// div of a velocity [1/s] at owned particles that are solved for; other entries stay.
  virtual void find_divergence(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity,
                               std::span<double> divergence) const = 0;

  /// Gradient of a pressure field [its unit/m] at the same particles. 0 where a consistent operator does
  /// not exist, so that spray falls freely.
  virtual void find_gradient(const Flow<Dim>& flow, const std::vector<double>& pressure,
                             std::span<Vec<Dim>> gradient) const = 0;

  /// What closes the finished rows of these owned particles of water, as air at p = 0 around them does, in the rows'
  /// unit. Asked only where air has a pressure, which is the robust formulation's.
  virtual void find_air_weights(const Flow<Dim>& flow, std::span<const std::size_t> particles,
                                std::span<double> weights) const;

  /// Gradient of a pressure field at these owned particles of water; likewise.
  virtual void find_gradient_at(const Flow<Dim>& flow, std::span<const std::size_t> particles,
                                const std::vector<double>& pressure, std::span<Vec<Dim>> gradient) const;

  /// What each of these owned wall particles pushes the fluid with by a pressure field, over its volume [the field's
  /// unit * m^(Dim - 1)]: the reactions of its shares in the gradients at its fluid neighbours.
  virtual void wall_reactions(const Flow<Dim>& flow, std::span<const std::size_t> walls,
                              const std::vector<double>& pressure, std::span<Vec<Dim>> pushes) const = 0;

  /// The same pairs, seen from the water: what each of these owned fluid particles pushes the walls with, over its
  /// volume. Each neighbour counts with its `share`, which is 0 for fluid and up to date on ghosts.
  virtual void reactions_seen_by_water(const Flow<Dim>& flow, std::span<const std::size_t> water,
                                       std::span<const double> share, const std::vector<double>& pressure,
                                       std::span<Vec<Dim>> pushes) const = 0;

  /// Finds the shifts [m] of owned particles and takes along the fields that change with them. Returns how many would
  /// have been longer than their bound. Collective.
  virtual std::size_t find_shifts(Flow<Dim>& flow, double dt, std::vector<Vec<Dim>>& shifts) const = 0;
};

/// A formulation of one case.
template <int Dim>
struct FlowFormulation {
  std::shared_ptr<Discretisation<Dim>> discretisation;
  std::shared_ptr<const WallModel<Dim>> walls;
  Kernel<Dim> kernel = make_kernel<Dim>(KernelName::wendland_c2, 1.0);

  /// The order of a step: takes one of dt, but for what all have in common (schemes/advance.h).
  StepReport (*take_step)(Flow<Dim>&, const StepStart<Dim>&, double dt) = nullptr;
  /// Finds the pressure at the start, as a first step of dt would. Nothing has moved in the end.
  void (*find_first_pressure)(Flow<Dim>&, const StepStart<Dim>&, double dt) = nullptr;

  // What it needs of the surroundings.
  bool needs_velocity_gradient = false;
  bool needs_concentration_gradient = false;

  // What it asks of the step.
  bool surface_is_air = false;             ///< missing neighbours count as air, near which nothing pulls
  bool is_divergence_free_midway = false;  ///< or where the step starts (F18)
  bool moves_with_mean_velocity = false;   ///< of before and after the step (F17), or with the new one
  bool gravity_in_prediction = false;  ///< as published; walls then feel it through the water that comes down on them
  bool friction_is_viscous = false;    ///< the viscous force sees walls with the velocity they show, friction included
  bool shifts_particles = false;
  /// It projects again where the water has come to; the next step's first projection has the same matrix.
  bool has_second_projection = false;

  // Its laws.
  double courant = 0.0;
  double length = 0.0;             ///< m; L of the time-step rule; 0: from the case
  double viscous_share = 0.125;    ///< b of the time-step rule
  double fastest_over_reference =  ///< cap of the speed in that rule, over sqrt(2 g L)
      std::numeric_limits<double>::infinity();
  double artificial_viscosity = 0.0;  ///< c_a of (F3)
  double noise_viscosity = 0.0;       ///< over dx times the speed of the time-step rule
  bool has_eddy_viscosity = false;    ///< in the boundary layers of walls with friction
  double energy_slack = 0.0;  ///< rise of the energy at which the density source stops lifting (pressure/energy)
};

}  // namespace tailwater
