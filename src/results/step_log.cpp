#include "results/step_log.h"

#include <limits>
#include <string>
#include <vector>

namespace tailwater {
namespace {

double number(auto count) { return static_cast<double>(count); }

std::vector<StepColumn> row_of(double time, std::int64_t step, const StepReport& report, const FlowMeasures& measures) {
  const Interventions& counts = report.interventions;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const DivergenceReport divergence = report.divergence.value_or(DivergenceReport{none, none, none});
  std::vector<StepColumn> row{{"time_s", time},
                              {"step", number(step)},
                              {"dt_s", report.dt},
                              {"passes", number(report.passes)},
                              {"iterations", number(report.iterations)},
                              {"residual", report.residual},
                              {"pressure_change", report.pressure_change},
                              {"divergence_old_per_s", divergence.at_old_positions},
                              {"divergence_new_per_s", divergence.at_new_positions},
                              {"divergence_moved_per_s", divergence.moved},
                              {"speed_max_m_per_s", measures.largest_speed},
                              {"kinetic_J", measures.kinetic_energy},
                              {"potential_J", measures.potential_energy},
                              {"density_work_J", report.work.density},
                              {"wall_work_J", report.work.walls},
                              {"viscous_work_J", report.work.viscous},
                              {"density_share", report.density_share},
                              {"density_error_mean", measures.density_error_mean},
                              {"density_error_rms", measures.density_error_rms},
                              {"density_error_max", measures.density_error_largest},
                              {"stopped_at_walls", number(counts.stopped_at_walls)},
                              {"capped_shifts", number(counts.capped_shifts)},
                              {"fallback_rows", number(counts.fallback_rows)},
                              {"restarted_solves", number(counts.restarted_solves)},
                              {"volume_out_m3", measures.departed.volume},
                              {"energy_out_J", measures.departed.energy},
                              {"volume_in_m3", measures.arrived.volume},
                              {"energy_in_J", measures.arrived.energy},
                              {"end_work_J", report.work.ends},
                              {"slope_work_J", report.work.slope}};
  row.insert(row.end(), measures.of_parts.begin(), measures.of_parts.end());
  return row;
}

std::vector<std::string> columns(const FlowMeasures& measures) {
  std::vector<std::string> names;
  for (const StepColumn& column : row_of(0.0, 0, {}, measures)) names.emplace_back(column.name);
  return names;
}

}  // namespace

StepLog::StepLog(const std::filesystem::path& path, const FlowMeasures& measures, std::optional<std::int64_t> kept)
    : csv_(path, columns(measures), kept) {}

void StepLog::write(double time, std::int64_t step, const StepReport& report, const FlowMeasures& measures) {
  std::vector<double> values;
  for (const StepColumn& column : row_of(time, step, report, measures)) values.push_back(column.value);
  csv_.write(values);
}

}  // namespace tailwater
