#include "results/statistics.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace tailwater {

RunStatistics::RunStatistics(const FlowMeasures& start, double energy_scale)
    : energy_start_(start.energy()),
      energy_scale_(energy_scale),
      energy_end_(energy_start_),
      energy_least_(energy_start_),
      unexplained_least_(energy_start_) {}

void RunStatistics::add(const StepReport& report, const FlowMeasures& measures, std::size_t escaped) {
  if (steps_ == 0) {
    energy_least_ += report.fallen_at_start;
    unexplained_least_ += report.fallen_at_start;
  }
  dt_least_ = steps_ == 0 ? report.dt : std::min(dt_least_, report.dt);
  dt_largest_ = std::max(dt_largest_, report.dt);
  dt_sum_ += report.dt;
  ++steps_;
  passes_ += report.passes;
  iterations_ += report.iterations;
  if (report.divergence) {
    const auto& [at_old_positions, at_new_positions, moved] = *report.divergence;
    ++divergence_reports_;
    divergence_old_squares_ += at_old_positions * at_old_positions;
    divergence_new_squares_ += at_new_positions * at_new_positions;
    divergence_moved_squares_ += moved * moved;
  }
  density_error_sum_ += measures.density_error_mean;
  density_error_squares_ += measures.density_error_rms * measures.density_error_rms;
  energy_end_ = measures.energy();
  energy_out_ = measures.departed.energy;
  energy_in_ = measures.arrived.energy;
  brought_by_walls_ += report.brought_by_walls();
  brought_by_ends_ += report.work.ends;
  brought_by_air_ += report.work.air;
  brought_by_slope_ += report.work.slope;
  largest_work_of_walls_ = std::max(largest_work_of_walls_, std::abs(brought_by_walls_));
  largest_work_of_ends_ = std::max(largest_work_of_ends_, std::abs(brought_by_ends_));
  viscous_work_ += report.work.viscous;
  const double accounted = energy_end_ + report.fallen + energy_out_ - energy_in_ - brought_by_walls_ -
                           brought_by_ends_ - brought_by_air_ - brought_by_slope_;
  energy_least_ = std::min(energy_least_, accounted);
  energy_rise_ = std::max(energy_rise_, accounted - energy_least_);
  density_work_ += report.work.density;
  density_share_sum_ += report.density_share;
  unexplained_least_ = std::min(unexplained_least_, accounted - density_work_);
  unexplained_rise_ = std::max(unexplained_rise_, accounted - density_work_ - unexplained_least_);
  escaped_ = escaped;
  max_escaped_ = std::max(max_escaped_, escaped);
  interventions_ += report.interventions;
}

Json RunStatistics::json(std::size_t fluid_particles, std::size_t fluid_particles_at_start) const {
  const auto steps = static_cast<double>(std::max<std::int64_t>(steps_, 1));
  const double particle_steps = steps * static_cast<double>(std::max<std::size_t>(fluid_particles, 1));
  const auto divergence_reports = static_cast<double>(std::max<std::int64_t>(divergence_reports_, 1));
  const auto passes = static_cast<double>(std::max<std::int64_t>(passes_, 1));
  const auto over_start = [&](double energy) { return energy_scale_ > 0.0 ? energy / energy_scale_ : 0.0; };
  return {
      {"steps",
       {{"count", steps_}, {"dt_mean_s", dt_sum_ / steps}, {"dt_least_s", dt_least_}, {"dt_largest_s", dt_largest_}}},
      {"pressure_solver",
       {{"solves", passes_},
        {"passes_per_step", passes / steps},
        {"iterations", iterations_},
        {"iterations_per_solve", static_cast<double>(iterations_) / passes}}},
      {"divergence",
       {{"rms_at_old_positions_per_s", std::sqrt(divergence_old_squares_ / divergence_reports)},
        {"rms_at_new_positions_per_s", std::sqrt(divergence_new_squares_ / divergence_reports)},
        {"rms_from_old_positions_per_s", std::sqrt(divergence_moved_squares_ / divergence_reports)}}},
      {"energy",
       {{"start_J", energy_start_},
        {"end_J", energy_end_},
        {"out_J", energy_out_},
        {"in_J", energy_in_},
        {"brought_by_walls_J", brought_by_walls_},
        {"brought_by_open_ends_J", brought_by_ends_},
        {"brought_by_air_J", brought_by_air_},
        {"brought_by_slope_J", brought_by_slope_},
        {"viscous_work_J", viscous_work_},
        {"largest_rise_J", energy_rise_},
        {"largest_rise_over_start", over_start(energy_rise_)},
        {"density_work_J", density_work_},
        {"density_share_mean", steps_ > 0 ? density_share_sum_ / steps : 1.0},
        {"largest_rise_less_density_work_over_start", over_start(unexplained_rise_)}}},
      {"volume",
       {{"fluid_particles_start", fluid_particles_at_start},
        {"fluid_particles_end", fluid_particles},
        {"outside_the_walls_end", escaped_},
        {"outside_the_walls_most", max_escaped_},
        {"density_error_mean", density_error_sum_ / steps},
        {"density_error_rms", std::sqrt(density_error_squares_ / steps)}}},
      {"interventions",
       {{"stopped_at_walls", interventions_.stopped_at_walls},
        {"capped_shifts", interventions_.capped_shifts},
        {"fallback_rows", interventions_.fallback_rows},
        {"restarted_solves", interventions_.restarted_solves},
        {"stopped_and_capped_per_particle_step",
         static_cast<double>(interventions_.stopped_at_walls + interventions_.capped_shifts) / particle_steps}}}};
}

}  // namespace tailwater
