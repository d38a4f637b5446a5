#include "run/step_log.h"

#include <array>
#include <limits>

namespace tailwater {

StepLog::StepLog(const std::filesystem::path& path, std::optional<std::int64_t> kept)
    : csv_(path,
           {"time_s",
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
            "put_back",
            "capped_shifts",
            "fallback_rows",
            "restarted_solves",
            "volume_out_m3",
            "energy_out_J",
            "volume_in_m3",
            "energy_in_J",
            "end_work_J"},
           kept) {}

void StepLog::write(double time, std::int64_t step, const StepReport& report, const FlowMeasures& measures) {
  const Interventions& counts = report.interventions;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const DivergenceReport divergence = report.divergence.value_or(DivergenceReport{none, none, none});
  csv_.write(std::array{time,
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
                        static_cast<double>(counts.put_back),
                        static_cast<double>(counts.capped_shifts),
                        static_cast<double>(counts.fallback_rows),
                        static_cast<double>(counts.restarted_solves),
                        measures.departed.volume,
                        measures.departed.energy,
                        measures.arrived.volume,
                        measures.arrived.energy,
                        report.work.ends});
}

}  // namespace tailwater
