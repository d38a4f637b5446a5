// Statistics of a run over its steps, for summary.json.
#pragma once

#include <cstdint>

#include "base/json.h"
#include "base/saved.h"
#include "flow/measure.h"
#include "flow/step.h"

namespace tailwater {

TAILWATER_SAVED(inline, Interventions, stopped_at_walls, capped_shifts, fallback_rows, restarted_solves)

class RunStatistics {
 public:
  /// `energy_scale` [J]: that of the start (flow/measure.h).
  RunStatistics(const FlowMeasures& start, double energy_scale);

  void add(const StepReport& report, const FlowMeasures& measures, std::size_t escaped);

  /// J; largest rise of the energy, open ends and walls accounted for.
  double energy_rise() const { return energy_rise_; }
  // J; the largest magnitudes so far of the work of the pressure at open ends and of that of walls. A tide takes its
  // work back, but not the error of this work.
  double largest_work_of_ends() const { return largest_work_of_ends_; }
  double largest_work_of_walls() const { return largest_work_of_walls_; }

  /// Blocks "steps", "pressure_solver", "energy", "volume" and "interventions" of the summary.
  Json json(std::size_t fluid_particles, std::size_t fluid_particles_at_start) const;

  /// A checkpoint saves all of it.
  TAILWATER_SAVED(friend, RunStatistics, steps_, passes_, iterations_, dt_sum_, dt_least_, dt_largest_,
                  divergence_reports_, divergence_old_squares_, divergence_new_squares_, divergence_moved_squares_,
                  density_error_sum_, density_error_squares_, energy_start_, energy_scale_, energy_end_, energy_out_,
                  energy_in_, brought_by_walls_, brought_by_ends_, brought_by_air_, brought_by_slope_,
                  largest_work_of_walls_, largest_work_of_ends_, viscous_work_, energy_least_, energy_rise_,
                  density_work_, density_share_sum_, unexplained_least_, unexplained_rise_, max_escaped_, escaped_,
                  interventions_)

 private:
  std::int64_t steps_ = 0;
  std::int64_t passes_ = 0;
  std::int64_t iterations_ = 0;
  double dt_sum_ = 0.0;
  double dt_least_ = 0.0;
  double dt_largest_ = 0.0;
  std::int64_t divergence_reports_ = 0;
  double divergence_old_squares_ = 0.0;
  double divergence_new_squares_ = 0.0;
  double divergence_moved_squares_ = 0.0;
  double density_error_sum_ = 0.0;
  double density_error_squares_ = 0.0;
  double energy_start_;
  double energy_scale_;
  double energy_end_;
  double energy_out_ = 0.0;  ///< J; energy of the water that left, which is not a loss
  double energy_in_ = 0.0;   ///< J; energy of the water that came in
  double brought_by_walls_ = 0.0;
  double brought_by_ends_ = 0.0;
  double brought_by_air_ = 0.0;
  double brought_by_slope_ = 0.0;  ///< J; by gravity along periodic directions
  double largest_work_of_walls_ = 0.0;
  double largest_work_of_ends_ = 0.0;
  double viscous_work_ = 0.0;
  double energy_least_;  ///< J; least energy so far, inside plus out minus in, without the work of walls and open ends
  double energy_rise_ = 0.0;
  double density_work_ = 0.0;
  double density_share_sum_ = 0.0;
  double unexplained_least_;  ///< least energy so far, minus density_work_
  double unexplained_rise_ = 0.0;
  std::size_t max_escaped_ = 0;
  std::size_t escaped_ = 0;
  Interventions interventions_;
};

}  // namespace tailwater
