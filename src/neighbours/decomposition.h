// Decides which rank owns which particle: each rank owns those in its part of space. Particles that leave it are handed
// over. Space is cut again when work is shared too unevenly.
#pragma once

#include <span>

#include "parallel/communicator.h"
#include "parallel/space_cuts.h"
#include "particles/particles.h"

namespace tailwater {

struct ParallelTable;

/// The result of a repartition.
struct Repartition {
  double imbalance = 0.0;    ///< work of the busiest rank over the mean, minus 1, before it
  bool is_cut_anew = false;  ///< whether space was cut again
  std::int64_t moved = 0;    ///< particles that changed owner, on all ranks
};

template <int Dim>
class Decomposition {
 public:
  Decomposition(const Communicator& ranks, const ParallelTable& settings);

  /// Hands every owned particle to the rank in whose part it lies. `work` is the cost of each. Drops the ghosts;
  /// indices change. Collective.
  Repartition repartition(Particles<Dim>& particles, std::span<const double> work);

  const SpaceCuts<Dim>& cuts() const { return cuts_; }
  SpaceCuts<Dim>& cuts() { return cuts_; }

 private:
  Communicator ranks_;
  double tolerated_imbalance_;
  SpaceCuts<Dim> cuts_;
};

}  // namespace tailwater
