// Who owns which particle: each rank those in its part of space. Particles that left it are handed over, and space is
// cut anew when work is shared too unevenly.
#pragma once

#include <span>

#include "case/spec.h"
#include "parallel/communicator.h"
#include "parallel/space_cuts.h"
#include "particles/particles.h"

namespace tailwater {

/// What sharing out did.
struct Sharing {
  double imbalance = 0.0;    ///< work of the busiest rank over the mean, less 1, before
  bool is_cut_anew = false;  ///< space
  std::int64_t moved = 0;    ///< particles that got another owner, all ranks
};

template <int Dim>
class Decomposition {
 public:
  Decomposition(const Communicator& ranks, const ParallelTable& settings);

  /// Hands every owned particle to the rank in whose part it is. `work` says what each costs. Ghosts go; indices
  /// change. Collective.
  Sharing share_out(Particles<Dim>& particles, std::span<const double> work);

 private:
  Communicator ranks_;
  double tolerated_imbalance_;
  SpaceCuts<Dim> cuts_;
};

}  // namespace tailwater
