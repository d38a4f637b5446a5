#include "run/run_output.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "case/writer.h"
#include "io/messages.h"
#include "io/write_file.h"
#include "parallel/together.h"
#include "run/estimate.h"
#include "run/field_output.h"
#include "run/provenance.h"

namespace tailwater {
namespace {

constexpr double default_field_files = 100.0;

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

}  // namespace

template <int Dim>
RunOutput<Dim>::RunOutput(const CaseSpec& spec, const RunOptions& options, const Flow<Dim>& flow)
    : spec_(spec),
      options_(options),
      ranks_(flow.setup.ranks),
      probe_list_(make_probes<Dim>(spec, flow.walls.boundary)),
      folder_(make_folder(flow)),
      series_(folder_.fields(), "fields", spec.output.compression),
      wall_series_(folder_.fields(), "walls", spec.output.compression),
      rank_log_(ranks_, folder_.ranks()),
      probes_(std::move(probe_list_), folder_, ranks_),
      progress_(spec.time.end),
      statistics_(measure(flow)),
      limits_(spec.limits, flow),
      water_at_start_(water_in(flow)),
      cpu_start_(cpu_seconds()) {
  do_on_root(ranks_, [&] {
    step_log_.emplace(folder_.steps());
    write_text_file(folder_.effective_case(), effective_case(spec));
  });
}

template <int Dim>
RunFolder RunOutput<Dim>::make_folder(const Flow<Dim>& flow) const {
  require_reachable_end(spec_, flow.setup.time_step_rule);
  RunFolder folder = RunFolder::create(options_.out, options_.force, ranks_);
  open_log(folder.log());
  return folder;
}

template <int Dim>
void RunOutput<Dim>::write_due_fields(const Flow<Dim>& flow) {
  if (flow.state.time < next_fields_) return;
  write_fields(flow);
  const double interval =
      spec_.output.fields_interval > 0.0 ? spec_.output.fields_interval : spec_.time.end / default_field_files;
  next_fields_ = (std::floor(flow.state.time / interval) + 1.0) * interval;
}

template <int Dim>
void RunOutput<Dim>::write_fields(const Flow<Dim>& flow) {
  if (last_fields_time_ == flow.state.time && series_.size() > 0) return;
  last_fields_time_ = flow.state.time;
  const FluidFields<Dim> fields(flow, flow.state.particles, spec_.output.fields);
  series_.write(flow.state.time, fields.view(), ranks_);
  if (!flow.setup.wall_motion.moving().empty()) {
    do_on_root(ranks_, [&] { wall_series_.write(flow.state.time, WallFields<Dim>(flow.walls.boundary).view()); });
  }
}

template <int Dim>
void RunOutput<Dim>::record_probes(const Flow<Dim>& flow, const FlowMeasures& measures) {
  if (!probes_.is_due(flow.state.time)) return;
  probes_.record({.particles = flow.state.particles,
                  .grid = flow.neighbourhood.grid(),
                  .kernel = flow.neighbourhood.kernel(),
                  .boundary = flow.walls.boundary,
                  .density = flow.setup.density,
                  .gravity = flow.setup.gravity,
                  .spacing = flow.setup.spacing,
                  .time = flow.state.time,
                  .totals = {.kinetic_energy = measures.kinetic_energy,
                             .potential_energy = measures.potential_energy,
                             .density_error_mean = measures.density_error_mean,
                             .density_error_rms = measures.density_error_rms,
                             .volume_out = measures.departed.volume},
                  .ranks = ranks_});
}

template <int Dim>
void RunOutput<Dim>::record_sharing(const Flow<Dim>& flow, const Sharing& sharing) {
  rank_log_.write(flow, sharing);
}

template <int Dim>
void RunOutput<Dim>::record_step(const Flow<Dim>& flow, const StepReport& report) {
  const FlowMeasures measures = measure(flow);
  const std::size_t outside = count_outside(flow);
  warn_if_outside(flow, outside);
  statistics_.add(report, measures, outside);
  if (step_log_) step_log_->write(flow.state.time, flow.state.step, report, measures);
  record_probes(flow, measures);
  progress_.show(flow.state.time, flow.state.step, report, measures);
  try {
    limits_.check(flow.state.time, statistics_.energy_rise(), measures);
  } catch (const SolverError&) {
    write_fields(flow);
    throw;
  }
}

template <int Dim>
void RunOutput<Dim>::warn_if_outside(const Flow<Dim>& flow, std::size_t outside) {
  if (outside == 0 || warned_outside_) return;
  warned_outside_ = true;
  warn(
      fmt::format("at t = {:.4f} s {} fluid particle(s) left the box around the walls; they are still computed, and "
                  "counted in summary.json. Remedy: higher walls",
                  flow.state.time, outside));
}

template <int Dim>
void RunOutput<Dim>::finish(const Flow<Dim>& flow, ExitCode code) {
  write_fields(flow);
  write_summary(flow, code == ExitCode::done ? "done" : "interrupted", code, "");
  tell_water(flow);
}

template <int Dim>
void RunOutput<Dim>::finish_failed(const Flow<Dim>& flow, const std::string& message) {
  write_summary(flow, "failed", ExitCode::solver_failed, message);
}

template <int Dim>
void RunOutput<Dim>::write_summary(const Flow<Dim>& flow, const std::string& status, ExitCode code,
                                   const std::string& message) {
  const double wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double cpu = ranks_.sum(cpu_seconds() - cpu_start_);
  const double memory = ranks_.sum(peak_memory_bytes());
  const auto fluid = static_cast<std::size_t>(water_in(flow).particles);
  const std::size_t all = ranks_.sum(flow.state.particles.owned);
  nlohmann::ordered_json summary = {{"title", spec_.general.title},
                                    {"case", options_.case_file.string()},
                                    {"status", status},
                                    {"exit_code", static_cast<int>(code)},
                                    {"message", message},
                                    {"warnings", warnings()},
                                    {"spacing_m", spec_.particles.spacing},
                                    {"particles", {{"fluid", fluid}, {"wall", all - fluid}}},
                                    {"time_s", {{"end", spec_.time.end}, {"reached", flow.state.time}}},
                                    {"cost",
                                     {{"wall_clock_s", wall_seconds},
                                      {"cpu_s", cpu},
                                      {"cpu_s_per_simulated_s", flow.state.time > 0.0 ? cpu / flow.state.time : 0.0},
                                      {"peak_memory_bytes", memory}}},
                                    {"ranks", rank_log_.json()}};
  summary.update(statistics_.json(fluid, static_cast<std::size_t>(water_at_start_.particles)));
  summary["water_balance"] = water_balance(water_at_start_, flow);
  summary.update(provenance());
  if (ranks_.is_root()) write_text_file(folder_.summary(), summary.dump(2) + "\n");
}

template <int Dim>
void RunOutput<Dim>::tell_water(const Flow<Dim>& flow) const {
  const Water outside = water_outside(flow);
  if (flow.setup.open_ends.empty() && outside.particles == 0) return;
  Water inside = water_in(flow);
  inside.particles -= outside.particles;
  inside.volume -= outside.volume;
  tell(fmt::format("water: {} at the start, {} inside, {} outside the walls, {} out", water_at_start_.text(),
                   inside.text(), outside.text(), water_out(flow).text()));
}

template class RunOutput<2>;
template class RunOutput<3>;

}  // namespace tailwater
