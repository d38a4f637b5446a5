// The state that a checkpoint saves to continue a run; it contains nothing that can be recomputed. A Flow made from the
// case and a state continues with bit-identical results (tests/schemes/state_test.cpp), from an instant at which
// neighbour lists were discarded.
#pragma once

#include <cstdint>
#include <vector>

#include "motion/motion_state.h"
#include "particles/particles.h"

namespace tailwater {

/// Figures of the last step that the next one needs.
struct StepMemory {
  double approach = 0.0;       ///< m/s; the largest in the step, whose neighbour lists are discarded
  double energy_rise = 0.0;    ///< J; above the least energy so far, without the work of walls
  double density_share = 1.0;  ///< fraction of the lifting density source in the next step
  // The pressure that balances the weight of water (flow/balanced_pressure.h):
  double fullness = 0.0;           ///< of the walls
  double lowest_beside_air = 0.0;  ///< m along gravity; of the water
  double lowest_unbalanced = 0.0;  ///< m along gravity; of the water beside air and of what parts need
  double balanced_share = 0.0;     ///< of the weight below a free surface
  double unbalanced_share = 1.0;   ///< of the pressure, where it is largest
};

template <int Dim>
struct State {
  double time = 0.0;  ///< s
  std::int64_t step = 0;
  /// Owned particles in their order; ghosts are recomputed. Moving walls are at their positions at `time`.
  Particles<Dim> particles;
  std::vector<Vec<Dim>> wall_velocity;  ///< m/s; of each row of walls that move, at the end of the last step
  MotionState<Dim> motion;              ///< of wave makers and floating bodies
  StepMemory last_step;
};

}  // namespace tailwater
