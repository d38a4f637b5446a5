// Watches the errors of a run's own balances: a warning beyond one limit, the end of the run beyond another.
#pragma once

#include "base/json.h"
#include "case/spec.h"
#include "flow/flow.h"
#include "flow/measure.h"

namespace tailwater {

class ResultLimits {
 public:
  /// The energy is compared with m g L/2 plus the kinetic energy, as in balance_energy, and the work of open ends.
  /// Collective.
  template <int Dim>
  ResultLimits(const LimitsTable& limits, const Flow<Dim>& flow);

  /// Call after every step; `energy_rise` [J] is the largest rise so far, `work_of_ends` and `work_of_walls` [J] the
  /// largest magnitudes of the work of the pressure at open ends and of moving walls. Warns when an error passes its
  /// limit. A rise of energy causes no warning as long as it would lift the water's surface by less than a tenth of dx.
  /// A lattice cut by walls determines its state of rest no better than that. Throws SolverError, which names the key,
  /// beyond a limit that ends the run.
  void check(double time, double energy_rise, double work_of_ends, double work_of_walls, const FlowMeasures& measures);
  /// Warns again of errors that have grown since their warning. Call at the end of the run.
  void warn_of_largest();

  /// The warned errors and the largest ones, for a checkpoint, and from one.
  Json saved() const;
  void restore(const Json& saved);

 private:
  struct Limit {
    const char* what;
    const char* most;  ///< text for the largest error
    const char* keys;  ///< the keys are limits.KEYS_warning and limits.KEYS_stop
    double warning;
    double stop;
    double told = 0.0;  ///< growth at its warning
    double largest = 0.0;
    double time_of_largest = 0.0;  ///< s
  };

  /// Errors up to `harmless` cause no warning. `growth` is the reported size of the largest error.
  static void check(Limit& limit, double time, double error, double harmless, double growth);

  Limit energy_;
  Limit volume_;
  double volume_at_start_;   ///< m^Dim
  double kinetic_at_start_;  ///< J
  double potential_scale_;   ///< J/m^Dim; energy of water L/2 above the ground
  double unresolved_;        ///< J/m^Dim; energy of water lifted by dx/20, which lifts its surface by dx/10
};

}  // namespace tailwater
