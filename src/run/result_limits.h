// Watches the errors of a run's own books: a warning beyond one limit, the end of the run beyond another.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "case/spec.h"
#include "flow/flow.h"
#include "flow/measure.h"

namespace tailwater {

class ResultLimits {
 public:
  /// The energy is compared with m g L/2 plus the kinetic energy, as in balance_energy. Collective.
  template <int Dim>
  ResultLimits(const LimitsTable& limits, const Flow<Dim>& flow);

  /// Call after every step; `energy_rise` [J] is the largest rise so far. Warns once of each error. Throws SolverError,
  /// which names the key, beyond a limit that ends the run.
  void check(double time, double energy_rise, const FlowMeasures& measures);

  /// What has been warned of, for a checkpoint, and from one.
  nlohmann::json saved() const;
  void restore(const nlohmann::json& saved);

 private:
  struct Limit {
    const char* what;
    const char* keys;  ///< the keys are limits.KEYS_warning and limits.KEYS_stop
    double warning;
    double stop;
    bool has_warned = false;
  };

  static void check(Limit& limit, double time, double error);

  Limit energy_;
  Limit volume_;
  double volume_at_start_;  ///< m^Dim
  double potential_scale_;  ///< J/m^Dim; of water L/2 above the ground
};

}  // namespace tailwater
