// The state of a run and the work fields of one step: everything the verbs of a step (predict, assemble, solve,
// correct, move, shift) read and write.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "closures/air.h"
#include "closures/shifting.h"
#include "closures/time_step.h"
#include "closures/viscosity.h"
#include "closures/wall_velocity.h"
#include "geometry/boundary.h"
#include "geometry/wall_motion.h"
#include "linear/pressure_system.h"
#include "neighbours/decomposition.h"
#include "neighbours/neighbourhood.h"
#include "operators/lattice.h"
#include "operators/renormalisation.h"
#include "particles/particles.h"
#include "schemes/open_end.h"

namespace tailwater {

/// Things a step did that the equations do not ask for. A sound run needs few.
struct Interventions {
  std::size_t put_back = 0;           ///< moves that would have ended behind a wall
  std::size_t capped_shifts = 0;      ///< shifts that would have been longer than their bound
  std::size_t clamped_pressures = 0;  ///< suction near the surface cut after the solve
  std::size_t fallback_rows = 0;      ///< consistent rows replaced where B2 is unsound
  std::size_t restarted_solves = 0;   ///< after a breakdown of the Krylov method; all ranks count the same

  Interventions& operator+=(const Interventions& other);
};

/// What one step reports.
struct StepReport {
  double dt = 0.0;
  int passes = 0;                 ///< of the implicit iteration; 1 for the explicit projection
  int iterations = 0;             ///< of the pressure solves, all passes
  double residual = 0.0;          ///< of the last solve
  double pressure_change = 0.0;   ///< rms change of p in the last pass over rms p; 0 for one pass
  double divergence_old = 0.0;    ///< 1/s; rms of div u in the bulk at the positions of the last solve
  double divergence_new = 0.0;    ///< 1/s; the same at the new positions
  double divergence_moved = 0.0;  ///< 1/s; rms of the difference: the part that comes from the old positions
  double density_work = 0.0;      ///< J; of the pressure on what the density source expands
  double wall_work = 0.0;         ///< J; of the pressure of moving walls on the water
  double viscous_work = 0.0;      ///< J; of viscosity and friction on the water
  double density_share = 1.0;     ///< of what the density source would lift that the energy left to the next step
  Interventions interventions;

  /// J; what viscosity and friction brought: moving walls drag the water by more than is dissipated.
  double dragged() const { return std::max(0.0, viscous_work); }
  /// J; what moving walls gave the water.
  double brought_by_walls() const { return wall_work + dragged(); }
};

template <int Dim>
struct Flow {
  /// Builds the particles of a case, its walls and the empty work fields; of several ranks each keeps its share of the
  /// particles, and all have all walls' faces. Collective. Throws InputError for an impossible geometry.
  explicit Flow(const CaseSpec& spec, const Communicator& ranks = {});

  // What does not change.
  Communicator ranks;
  SchemeTable scheme;
  double density;          ///< kg/m^3
  double spacing;          ///< m
  Vec<Dim> gravity;        ///< m/s^2
  double length;           ///< m; L of (F41): the fluid's height along gravity at the start, or the case's own
  Boundary<Dim> boundary;  ///< walls that move: where they are at `time`
  WallModel<Dim> walls;    ///< the same
  WallMotion<Dim> wall_motion;
  LatticeSums lattice;
  double W_0;          ///< W(0)
  double eta_squared;  ///< m^2; eta^2 of (B8)
  AirLaw air_law;
  ViscosityLaw viscosity_law;
  ShiftingLaw shifting_law;
  TimeStepRule time_step_rule;
  bool is_closed;  ///< periodic in every direction: no surface anywhere, pressure known up to a constant

  // The state.
  Particles<Dim> particles;
  double time = 0.0;  ///< s
  std::int64_t step = 0;
  double energy_rise = 0.0;             ///< J; from the least energy so far, without what the walls brought
  double density_share = 1.0;           ///< of what the density source would lift that this leaves
  std::vector<OpenEnd<Dim>> open_ends;  ///< one per outlet
  std::vector<std::int16_t> end_of;     ///< the open end in whose stretch an owned particle is in this step, or -1

  // Tools that keep memory between steps.
  Decomposition<Dim> decomposition;
  Neighbourhood<Dim> neighbourhood;
  PressureSystem pressure_system;

  // Work fields, one entry per particle, ghosts included. Geometry, valid for the present positions:
  std::vector<double> concentration;  ///< C/C_0, which is rho/rho_0 (B6); 1 for dummies
  std::vector<Vec<Dim>> concentration_gradient;
  std::vector<double> wall_fluid_weight;
  std::vector<std::uint8_t> is_wet;
  std::vector<std::uint8_t> takes_part;       ///< fluid, and wet walls
  std::vector<Renormalisation<Dim>> tensors;  ///< only where a consistent operator is chosen
  std::vector<std::uint8_t> is_surface;
  std::vector<double> interior;  ///< 0 near the free surface, 1 inside (free_surface.h)
  // One step:
  std::vector<Vec<Dim>> position_old;  ///< r^n, owned; in `shift`, the positions before it
  std::vector<Vec<Dim>> velocity_old;  ///< u^n, owned
  double energy_old = 0.0;             ///< J; of the owned fluid at r^n, u^n
  std::vector<Vec<Dim>> u_star;        ///< predicted velocity, without gravity unless `predicts_gravity`
  // Of moving walls, by row of the table of wall particles:
  std::vector<Vec<Dim>> wall_velocity_old;   ///< m/s; at the start of the step
  std::vector<Vec<Dim>> wall_velocity_next;  ///< m/s; at which `correct` aims
  std::vector<Vec<Dim>> wall_acceleration;   ///< m/s^2; that leads there, in the directions that the wall blocks
  // The fluid:
  std::vector<Vec<Dim>> wall_mean;
  std::vector<Vec<Dim>> acceleration;
  std::vector<Mat<Dim>> velocity_gradient;  ///< 1/s; only where a term needs it
  std::vector<double> wall_overlap;         ///< share of the particle behind a wall, owned; for the density source
  std::vector<double> target_divergence;    ///< 1/s; what the pressure equation leaves of div u at its positions
  std::vector<double> divergence;           ///< 1/s; as last measured, owned
  std::vector<double> viscosity;
  std::vector<Mat<Dim>> stress;
  std::vector<Vec<Dim>> shift;
  std::vector<Vec<Dim>> shift_velocity;  ///< (F31)
  std::vector<double> shift_pressure;    ///< (F32)

  /// Is owned particle i in the end stretch of an outlet, where nothing is solved for?
  bool is_leaving(std::size_t i) const { return end_of[i] >= 0; }
  bool is_solved_for(std::size_t i) const { return particles.is_fluid(i) && !is_leaving(i); }
  /// Whether statistics of the bulk count particle i.
  bool is_inside(std::size_t i) const { return is_solved_for(i) && interior[i] > 0.5; }
  double kinetic_energy_of(std::size_t i) const {
    return 0.5 * density * particles.volume[i] * particles.velocity[i].squaredNorm();
  }
  /// Relative to the origin.
  double potential_energy_of(std::size_t i) const {
    return -density * particles.volume[i] * gravity.dot(particles.position[i]);
  }
  /// Viscosity [m^2/s] with which noise is dissipated while this is the largest speed.
  double noise_viscosity(double speed) const {
    return scheme.noise_viscosity * spacing * std::max(speed, time_step_rule.reference_speed);
  }
  /// Whether gravity acts in the prediction, as published in both schemes, or in the correction: the wall rows decide.
  /// Those of a row with dummies see it, and the wall's own motion, in the fluid that comes down on them; the others
  /// ask for grad p . n = rho (g - a) . n, and it would count twice.
  bool predicts_gravity() const { return walls.treatment == WallTreatment::row_and_dummies; }
  /// Whether particle i has the pressure equation for its row: fluid, and the row on the wall that has dummies behind.
  bool has_equation(std::size_t i) const {
    return particles.is_fluid(i) || (walls.treatment == WallTreatment::row_and_dummies && is_on_wall(i));
  }
  /// Whether wall particle i stands on the wall itself.
  bool is_on_wall(std::size_t i) const {
    return static_cast<std::size_t>(particles.wall_row[i]) < walls.particles.on_wall;
  }
  bool uses_tensors() const;
  bool uses_velocity_gradient() const;
  const Pairs<Dim>& pairs() const { return neighbourhood.pairs(); }
};

/// What is measured of the whole flow at the end of a step.
struct FlowMeasures {
  double largest_speed = 0.0;       ///< m/s
  double kinetic_energy = 0.0;      ///< J (per metre of width in 2D)
  double potential_energy = 0.0;    ///< J, relative to the origin
  double density_error_mean = 0.0;  ///< of C/C_0 - 1 in the bulk (away from the surface)
  double density_error_rms = 0.0;
  double density_error_largest = 0.0;
  Departed departed;  ///< through all outlets since the start

  double energy() const { return kinetic_energy + potential_energy; }
};

/// Collective.
template <int Dim>
FlowMeasures measure(const Flow<Dim>& flow);

}  // namespace tailwater
