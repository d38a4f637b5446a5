// Data that the stages of one step pass to each other, and the report of a step.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "base/vec.h"

namespace tailwater {

/// State at the start of a step; owned particles.
template <int Dim>
struct StepStart {
  std::vector<Vec<Dim>> position;       ///< m; r^n
  std::vector<Vec<Dim>> velocity;       ///< m/s; u^n
  std::vector<Vec<Dim>> wall_velocity;  ///< m/s; of each row of walls that move
  double energy = 0.0;                  ///< J; of this rank's fluid
};

/// Prescribed motion of the walls in a step, by row of moving walls.
template <int Dim>
struct WallDrive {
  std::vector<Vec<Dim>> velocity;      ///< m/s; that the projection imposes on the fluid beside them
  std::vector<Vec<Dim>> acceleration;  ///< m/s^2; that leads to it, in the directions that the wall blocks
};

/// Results of `predict`.
template <int Dim>
struct Prediction {
  std::vector<Vec<Dim>> velocity;           ///< m/s; u_star, walls and ghosts too
  std::vector<Vec<Dim>> acceleration;       ///< m/s^2; of viscosity and friction, owned
  std::vector<Mat<Dim>> velocity_gradient;  ///< 1/s; of u^n; empty where no term needs it
};

/// Counts of corrections that are not part of the equations. A sound run has few.
struct Interventions {
  std::size_t stopped_at_walls = 0;  ///< moves that would have ended behind a wall
  std::size_t capped_shifts = 0;     ///< shifts that would have been longer than their bound
  std::size_t fallback_rows = 0;     ///< consistent rows replaced where B2 is unsound
  std::size_t restarted_solves = 0;  ///< after a breakdown of the Krylov method; all ranks count the same

  Interventions& operator+=(const Interventions& other);
};

/// Report of the pressure in one pass.
struct PressureReport {
  int iterations = 0;
  double residual = 0.0;  ///< of the last solve
  Interventions interventions;
};

/// The equation in the flow's pressure rows.
struct PosedEquation {
  std::size_t fallback_rows = 0;
  int iterations = 0;                  ///< of the solves that parts needed to pose it
  std::vector<double> density_source;  ///< Pa/m^2; PressureSource::density
  double dt = 0.0;                     ///< s
  double fullness = 0.0;               ///< 1 where water fills the space between walls, 0 beside air
};

/// Works [J] of one step on the water: of the pressure on the expansion by the density source, of the pressure of
/// moving walls, of the conditions at open ends, of viscosity and friction, of the gas in pockets of air, and of
/// gravity along periodic directions.
struct Works {
  double density = 0.0;
  double walls = 0.0;
  double ends = 0.0;
  double viscous = 0.0;
  double air = 0.0;
  double slope = 0.0;
};

/// Divergence that remains after a step: rms of div u in the bulk [1/s].
struct DivergenceReport {
  double at_old_positions;  ///< those of the last solve
  double at_new_positions;
  double moved;  ///< rms of the difference: the part caused by the change of positions
};

/// Report of one step.
struct StepReport {
  double dt = 0.0;
  int passes = 0;                              ///< of the implicit iteration; 1 for the explicit projection
  int iterations = 0;                          ///< of the pressure solves, all passes
  double residual = 0.0;                       ///< of the last solve
  double pressure_change = 0.0;                ///< rms change of p in the last pass over rms p; 0 for one pass
  std::optional<DivergenceReport> divergence;  ///< in some steps only
  Works work;
  /// J; by which the potential energy of the end of the step is below that of mid-step, to which velocity and works
  /// belong with the explicit integrator.
  double fallen = 0.0;
  double fallen_at_start = 0.0;  ///< J; the same for the velocity at the start of the run, in the first step
  double density_share = 1.0;    ///< fraction of the lifting density source in the next step
  Interventions interventions;

  void add(const PressureReport& pressure);
  /// J; work of viscosity and friction where it is positive: moving walls drag the water by more than is dissipated.
  double dragged() const { return std::max(0.0, work.viscous); }
  /// J; energy that moving walls have given the water.
  double brought_by_walls() const { return work.walls + dragged(); }
  /// J; energy that moving walls, open ends, gas and an endless slope have given the water.
  double brought() const { return brought_by_walls() + work.ends + work.air + work.slope; }
};

}  // namespace tailwater
