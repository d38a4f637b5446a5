#include "results/step_log.h"

#include <limits>
#include <string>
#include <vector>

namespace tailwater {
namespace {

struct Column {
  const char* name;
  double value;
};

double number(auto count) { return static_cast<double>(count); }

std::vector<Column> row_of(bool with_air, double time, std::int64_t step, const StepReport& report,
                           const FlowMeasures& measures) {
  const Interventions& counts = report.interventions;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const DivergenceReport divergence = report.divergence.value_or(DivergenceReport{none, none, none});
  std::vector<Column> row{{"time_s", time},
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
  if (with_air) {
    const AirMeasures& air = measures.air;
    row.insert(row.end(), {{"air_work_J", report.work.air},
                           {"air_energy_J", air.energy},
                           {"pockets", number(air.pockets)},
                           {"pockets_volume_m3", air.volume},
                           {"pocket_pressure_Pa", air.pressure}});
  }
  return row;
}

std::vector<std::string> columns(bool with_air) {
  std::vector<std::string> names;
  for (const Column& column : row_of(with_air, 0.0, 0, {}, {})) names.emplace_back(column.name);
  return names;
}

}  // namespace

StepLog::StepLog(const std::filesystem::path& path, bool with_air, std::optional<std::int64_t> kept)
    : with_air_(with_air), csv_(path, columns(with_air), kept) {}

void StepLog::write(double time, std::int64_t step, const StepReport& report, const FlowMeasures& measures) {
  std::vector<double> values;
  for (const Column& column : row_of(with_air_, time, step, report, measures)) values.push_back(column.value);
  csv_.write(values);
}

}  // namespace tailwater
