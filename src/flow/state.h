// The state that a checkpoint saves to continue a run; it contains nothing that can be recomputed. A Flow made from the
// case and a state continues with bit-identical results (tests/schemes/state_test.cpp), from an instant at which
// neighbour lists were discarded.
#pragma once

#include <cstdint>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/json.h"
#include "motion/motion_state.h"
#include "particles/particles.h"

namespace tailwater {

template <int Dim>
struct State {
  double time = 0.0;  ///< s
  std::int64_t step = 0;
  /// Owned particles in their order; ghosts are recomputed. Moving walls are at their positions at `time`.
  Particles<Dim> particles;
  std::vector<Vec<Dim>> wall_velocity;  ///< m/s; of each row of walls that move, at the end of the last step
  MotionState<Dim> motion;              ///< of wave makers and floating bodies
  double approach = 0.0;                ///< m/s; the largest in the last step, whose neighbour lists are discarded
  double energy_rise = 0.0;             ///< J; above the least energy so far, without the work of walls
  double density_share = 1.0;           ///< fraction of the lifting density source in the next step
  double fullness = 0.0;                ///< of the walls, by several liquids (flow/buoyancy.h); 0: there is one
};

/// A flow in a checkpoint.
template <int Dim>
struct SavedFlow {
  State<Dim> state;
  Json parts;  ///< saved state of each part, by its name
};

}  // namespace tailwater
