// Warns of particles that pile up in one place. The mean density over all water hardly changes by a local pile.
#pragma once

#include "base/json.h"
#include "flow/flow.h"

namespace tailwater {

class CrowdingWatch {
 public:
  /// Call after every step with the largest density error of the step. Warns once in a run. Collective.
  template <int Dim>
  void check(const Flow<Dim>& flow, double largest_error);

  /// The state for a checkpoint, and from one.
  Json saved() const;
  void restore(const Json& saved);

 private:
  double mean_ = 0.0;  ///< of the largest density error, over the last steps
  bool has_warned_ = false;
};

}  // namespace tailwater
