// What must be saved to go on with a run, and nothing that can be recomputed. A checkpoint is this; a Flow made of the
// case and of a state goes on bit for bit (tests/schemes/state_test.cpp), from a moment at which lists were forgotten.
#pragma once

#include <cstdint>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/json.h"
#include "motion/wall_motion.h"
#include "particles/particles.h"

namespace tailwater {

template <int Dim>
struct State {
  double time = 0.0;  ///< s
  std::int64_t step = 0;
  /// The owned ones with their order; ghosts are recomputed. Walls that move are where `time` says.
  Particles<Dim> particles;
  std::vector<Vec<Dim>> wall_velocity;  ///< m/s; of each row of walls that move, at the end of the last step
  MotionState<Dim> motion;              ///< of wave makers and floating bodies
  double approach = 0.0;                ///< m/s; the largest in the last step, whose neighbours are forgotten
  double energy_rise = 0.0;             ///< J; from the least energy so far, without what the walls brought
  double density_share = 1.0;           ///< of the density source that lifts: what the energy leaves to the next step
};

/// What a checkpoint holds of a flow.
template <int Dim>
struct SavedFlow {
  State<Dim> state;
  Json parts;  ///< what each part saves, by its name
};

}  // namespace tailwater
