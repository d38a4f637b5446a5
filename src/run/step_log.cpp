#include "run/step_log.h"

#include <limits>
#include <string>
#include <vector>

namespace tailwater {
namespace {

std::vector<std::string> columns(bool with_air) {
  std::vector<std::string> columns{"time_s",
                                   "step",
                                   "dt_s",
                                   "passes",
                                   "iterations",
                                   "residual",
                                   "pressure_change",
                                   "divergence_old_per_s",
                                   "divergence_new_per_s",
                                   "divergence_moved_per_s",
                                   "speed_max_m_per_s",
                                   "kinetic_J",
                                   "potential_J",
                                   "density_work_J",
                                   "wall_work_J",
                                   "viscous_work_J",
                                   "density_share",
                                   "density_error_mean",
                                   "density_error_rms",
                                   "density_error_max",
                                   "stopped_at_walls",
                                   "capped_shifts",
                                   "fallback_rows",
                                   "restarted_solves",
                                   "volume_out_m3",
                                   "energy_out_J",
                                   "volume_in_m3",
                                   "energy_in_J",
                                   "end_work_J"};
  if (with_air) {
    columns.insert(columns.end(), {"air_work_J", "air_energy_J", "pockets", "pockets_volume_m3", "pocket_pressure_Pa"});
  }
  return columns;
}

}  // namespace

StepLog::StepLog(const std::filesystem::path& path, bool with_air, std::optional<std::int64_t> kept)
    : with_air_(with_air), csv_(path, columns(with_air), kept) {}

void StepLog::write(double time, std::int64_t step, const StepReport& report, const FlowMeasures& measures) {
  const Interventions& counts = report.interventions;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const DivergenceReport divergence = report.divergence.value_or(DivergenceReport{none, none, none});
  std::vector<double> values{time,
                             static_cast<double>(step),
                             report.dt,
                             static_cast<double>(report.passes),
                             static_cast<double>(report.iterations),
                             report.residual,
                             report.pressure_change,
                             divergence.at_old_positions,
                             divergence.at_new_positions,
                             divergence.moved,
                             measures.largest_speed,
                             measures.kinetic_energy,
                             measures.potential_energy,
                             report.work.density,
                             report.work.walls,
                             report.work.viscous,
                             report.density_share,
                             measures.density_error_mean,
                             measures.density_error_rms,
                             measures.density_error_largest,
                             static_cast<double>(counts.stopped_at_walls),
                             static_cast<double>(counts.capped_shifts),
                             static_cast<double>(counts.fallback_rows),
                             static_cast<double>(counts.restarted_solves),
                             measures.departed.volume,
                             measures.departed.energy,
                             measures.arrived.volume,
                             measures.arrived.energy,
                             report.work.ends};
  if (with_air_) {
    const AirMeasures& air = measures.air;
    values.insert(values.end(),
                  {report.work.air, air.energy, static_cast<double>(air.pockets), air.volume, air.pressure});
  }
  csv_.write(values);
}

}  // namespace tailwater
