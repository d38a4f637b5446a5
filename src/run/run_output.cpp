#include "run/run_output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "air/enclosed_air.h"
#include "base/free_memory.h"
#include "case/writer.h"
#include "io/messages.h"
#include "io/write_file.h"
#include "motion/wall_motion.h"
#include "neighbours/decomposition.h"
#include "open_ends/open_ends.h"
#include "operators/graded_sums.h"
#include "parallel/together.h"
#include "parts/section_counters.h"
#include "results/field_output.h"
#include "results/probe_results.h"
#include "results/provenance.h"
#include "results/summary_file.h"
#include "results/unresolved.h"
#include "run/estimate.h"
#include "run/inertia_of_walls.h"
#include "walls/hidden_pairs.h"

namespace tailwater {
namespace {

constexpr double default_field_files = 100.0;

/// Interval of the tests whether the run's folder still exists, long enough for the file system of a cluster.
constexpr auto time_between_looks_at_folder = std::chrono::milliseconds(100);

/// Spaces after the summary of a running run, so that the last summary fits into the same bytes on a full disk.
constexpr std::size_t room_for_last_summary = 4096;

double cpu_seconds_of_process() {
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

/// Bytes of a file that this run continues; none for a new run.
std::optional<std::int64_t> kept_bytes(const Json* kept, const char* file) {
  if (kept == nullptr) return std::nullopt;
  const auto bytes = kept->at("bytes").at(file).get<std::int64_t>();
  return bytes > 0 ? std::optional(bytes) : std::nullopt;
}

std::vector<ProbeMark> marks_of(const Json& kept) {
  std::vector<ProbeMark> marks;
  for (const Json& mark : kept.at("probes")) marks.push_back({mark.at("taken"), mark.at("bytes")});
  return marks;
}

/// The totals of all pockets of air.
template <int Dim>
PocketTotals pocket_totals(const EnclosedAir<Dim>& air) {
  const AirMeasures all = air.measures();
  return {.pressure = all.pressure,
          .volume = all.volume,
          .gas = all.gas,
          .vented = air.state.gas_vented,
          .energy = all.energy,
          .pockets = static_cast<double>(all.pockets)};
}

}  // namespace

template <int Dim>
RunOutput<Dim>::RunOutput(const CaseSpec& spec, const RunOptions& options, const Flow<Dim>& flow, const Json* kept)
    : spec_(spec),
      options_(options),
      case_file_(options.case_file.string()),
      ranks_(flow.setup.ranks),
      probe_list_(make_probes<Dim>(spec, flow.walls.boundary)),
      folder_(make_folder(flow, kept != nullptr)),
      series_(folder_.fields(), "fields"),
      wall_series_(folder_.fields(), "walls"),
      frames_(spec, folder_, flow),
      rank_log_(ranks_, folder_.ranks(), kept_bytes(kept, "ranks")),
      probes_(std::move(probe_list_), folder_, ranks_, kept ? std::optional(marks_of(*kept)) : std::nullopt),
      progress_(spec.time.end, kept ? kept->at("cost").at("wall_seconds").get<double>() : 0.0),
      statistics_(measure(flow), energy_scale(flow)),
      limits_(spec.limits, flow),
      water_at_start_(water_in(flow)),
      fields_schedule_(spec.output.fields_interval > 0.0 ? spec.output.fields_interval
                                                         : spec.time.end / default_field_files),
      cpu_start_(cpu_seconds_of_process()) {
  const FlowMeasures at_start = measure(flow);
  do_on_root(ranks_, [&] { step_log_.emplace(folder_.steps(), at_start, kept_bytes(kept, "steps")); });
  if (kept != nullptr) restore(*kept);
}

template <int Dim>
RunFolder RunOutput<Dim>::make_folder(const Flow<Dim>& flow, bool goes_on) const {
  require_reachable_end(spec_, flow.setup.time_step_rule);
  RunFolder folder =
      goes_on ? RunFolder::open(options_.out, ranks_) : RunFolder::create(options_.out, options_.force, ranks_);
  open_log(folder.log());
  // This file comes first, because a run that is killed from now on can be started again from it.
  do_on_root(ranks_, [&] { write_text_file(folder.effective_case(), effective_case(spec_)); });
  return folder;
}

template <int Dim>
Json RunOutput<Dim>::saved() const {
  Json probes = Json::array();
  for (const ProbeMark& mark : probes_.marks()) probes.push_back({{"taken", mark.taken}, {"bytes", mark.size}});
  Json fields = fields_schedule_.saved();
  fields["times"] = series_.times();
  fields["wall_times"] = wall_series_.times();
  return {{"case_file", case_file_},
          {"bytes", {{"steps", step_log_ ? step_log_->csv().size() : 0}, {"ranks", rank_log_.size()}}},
          {"probes", probes},
          {"fields", fields},
          {"view", frames_.saved()},
          {"statistics", statistics_},
          {"water_at_start", water_at_start_},
          {"warnings", warnings()},
          {"limits", limits_.saved()},
          {"crowding", crowding_.saved()},
          {"warned_outside", warned_outside_}};
}

template <int Dim>
void RunOutput<Dim>::restore(const Json& kept) {
  kept.at("case_file").get_to(case_file_);
  const std::optional<std::int64_t> ranks_bytes = kept_bytes(&kept, "ranks");
  do_on_root(ranks_, [&] {
    if (ranks_.is_alone() && ranks_bytes) cut_file(folder_.ranks(), *ranks_bytes);
  });
  const Json& fields = kept.at("fields");
  series_.go_on(fields.at("times"), ranks_);
  wall_series_.go_on(fields.at("wall_times"), ranks_);
  fields_schedule_.restore(fields);
  frames_.restore(kept.at("view"), ranks_);
  kept.at("statistics").get_to(statistics_);
  kept.at("water_at_start").get_to(water_at_start_);
  recall_warnings(kept.at("warnings"));
  limits_.restore(kept.at("limits"));
  crowding_.restore(kept.at("crowding"));
  warned_outside_ = kept.at("warned_outside");
  const Json& cost = kept.at("cost");
  wall_seconds_before_ = cost.at("wall_seconds");
  cpu_seconds_before_ = cost.at("cpu_seconds");
  runs_before_ = cost.at("runs");
}

template <int Dim>
void RunOutput<Dim>::add_costs(Json& saved) const {
  saved["cost"] = {{"wall_seconds", wall_seconds()}, {"cpu_seconds", cpu_seconds()}, {"runs", runs_before_ + 1}};
}

template <int Dim>
double RunOutput<Dim>::wall_seconds() const {
  return wall_seconds_before_ + std::chrono::duration<double>(Clock::now() - start_).count();
}

template <int Dim>
double RunOutput<Dim>::cpu_seconds() const {
  return cpu_seconds_before_ + ranks_.sum(cpu_seconds_of_process() - cpu_start_);
}

/// Also signals that the run is ready (RequestSender).
template <int Dim>
void RunOutput<Dim>::begin(const Flow<Dim>& flow) {
  write_summary(
      flow, "running", std::nullopt,
      fmt::format("The run is in progress, or it was killed; then: tailwater resume {}", options_.out.string()));
  frames_.begin(spec_, flow);
}

template <int Dim>
void RunOutput<Dim>::write_due_fields(const Flow<Dim>& flow) {
  frames_.write_due(flow);
  if (!fields_schedule_.is_due(flow.state.time)) return;
  write_fields(flow);
  probes_.write_maps(folder_, flow.state.time, ranks_);
  fields_schedule_.set_next(flow.state.time);
}

template <int Dim>
void RunOutput<Dim>::write_fields(const Flow<Dim>& flow) {
  if (fields_schedule_.last() == flow.state.time && series_.size() > 0) return;
  fields_schedule_.set_last(flow.state.time);
  give_back_free_memory();
  const FluidFields<Dim> fields(flow, flow.state.particles, spec_.output.fields);
  series_.write(flow.state.time, fields.view(), ranks_);
  // Walls at rest are written once, in 3D: a picture needs them, and the case has no chain of points for a mesh.
  const bool is_first = Dim == 3 && series_.size() == 1;
  if (is_first || !flow.setup.wall_motion->moving().empty()) {
    do_on_root(ranks_, [&] { wall_series_.write(flow.state.time, WallFields<Dim>(flow.walls.boundary).view()); });
  }
}

template <int Dim>
void RunOutput<Dim>::record_probes(const Flow<Dim>& flow, const FlowMeasures& measures, double dt) {
  if (!probes_.is_due(flow.state.time)) return;
  const InertiaOfWalls<Dim> inertia(flow);
  probes_.record({.particles = flow.state.particles,
                  .grid = flow.neighbourhood->grid(),
                  .kernel = flow.neighbourhood->kernel(),
                  .boundary = flow.walls.boundary,
                  .density = flow.setup.liquid.density,
                  .gravity = flow.setup.gravity,
                  .spacing = flow.setup.scale.spacing,
                  .time = flow.state.time,
                  .totals = {.kinetic_energy = measures.kinetic_energy,
                             .potential_energy = measures.potential_energy,
                             .density_error_mean = measures.density_error_mean,
                             .density_error_rms = measures.density_error_rms,
                             .volume_out = measures.departed.volume,
                             .volume_in = measures.arrived.volume,
                             .section_volumes = flow.template part<SectionCounters<Dim>>().volumes(),
                             .air = pocket_totals(air_of(flow))},
                  .ranks = ranks_,
                  .felt_through = find_felt_through(flow.walls, flow.state.particles),
                  .domain = flow.setup.domain,
                  .dt = dt,
                  .wall_forces = &flow.walls.forces,
                  .patches = flow.walls.patches.get(),
                  .wall_inertia = inertia.get(),
                  .bodies = flow.state.motion.bodies.each,
                  .air_pressure = air_of(flow).pressure_field(flow.walls.boundary),
                  .spacing_field = flow.setup.graded == nullptr ? nullptr : &flow.setup.graded->field(),
                  .liquids = flow.setup.liquids.are_several() ? &flow.setup.liquids : nullptr,
                  .speed = flow.setup.time_step_rule.reference_speed});
}

template <int Dim>
void RunOutput<Dim>::record_repartition(const Flow<Dim>& flow, const Repartition& repartition) {
  rank_log_.write(flow, repartition);
}

template <int Dim>
void RunOutput<Dim>::record_step(const Flow<Dim>& flow, const StepReport& report) {
  const FlowMeasures measures = measure(flow);
  const auto outside = static_cast<std::size_t>(water_outside(flow).particles);
  warn_if_outside(flow, outside);
  for (const auto& part : flow.parts) part->warn(flow);
  crowding_.check(flow, measures.density_error_largest);
  statistics_.add(report, measures, outside);
  do_on_root(ranks_, [&] {
    require_folder_in_place();
    step_log_->write(flow.state.time, flow.state.step, report, measures);
  });
  record_probes(flow, measures, report.dt);
  progress_.show(flow.state.time, flow.state.step, report, measures);
  try {
    limits_.check(flow.state.time, statistics_.energy_rise(), statistics_.largest_work_of_ends(),
                  statistics_.largest_work_of_walls(), measures);
  } catch (const SolverError&) {
    write_fields(flow);
    frames_.write(flow);
    throw;
  }
}

/// A folder that was removed or replaced takes no more lines, but a write to an open file reports no error.
template <int Dim>
void RunOutput<Dim>::require_folder_in_place() {
  const auto now = Clock::now();
  if (now - last_look_at_folder_ < time_between_looks_at_folder) return;
  last_look_at_folder_ = now;
  step_log_->csv().require_in_place();
}

template <int Dim>
void RunOutput<Dim>::warn_if_outside(const Flow<Dim>& flow, std::size_t outside) {
  if (outside == 0 || warned_outside_) return;
  warned_outside_ = true;
  warn("water-left-walls",
       "at t = {:.4f} s {} fluid particle(s) are outside the walls, one at ({:.4g}), and cannot return; they are "
       "computed until they are below all walls, and counted in summary.json. Remedy: raise the walls if the water ran "
       "over them; if it passed below their rim, close the gap there or use a smaller spacing",
       flow.state.time, outside, fmt::join(place_of_water_outside(flow), ", "));
}

template <int Dim>
void RunOutput<Dim>::finish(const Flow<Dim>& flow, ExitCode code) {
  write_fields(flow);
  frames_.write(flow);
  probes_.write_maps(folder_, flow.state.time, ranks_);
  do_on_root(ranks_, [this] { step_log_->csv().require_in_place(); });
  limits_.warn_of_largest();
  for (const auto& part : flow.parts) part->warn_at_end(flow);
  do_on_root(ranks_, [&] {
    for (const Finding& finding : unresolved_surfaces(spec_, folder_, flow.setup)) warn(finding);
  });
  write_summary(flow, code == ExitCode::done ? "done" : "interrupted", code, "");
  tell_water(flow);
  tell_results();
}

template <int Dim>
void RunOutput<Dim>::finish_failed(const Flow<Dim>& flow, ExitCode code, const std::string& message) {
  limits_.warn_of_largest();
  for (const auto& part : flow.parts) part->warn_at_end(flow);
  try {
    write_summary(flow, "failed", code, message);
  } catch (const IoError&) {
    // The user must see the first error.
  }
}

template <int Dim>
void RunOutput<Dim>::write_summary(const Flow<Dim>& flow, const std::string& status, std::optional<ExitCode> code,
                                   const std::string& message) {
  const double cpu = cpu_seconds();
  const double memory = ranks_.sum(peak_memory_bytes());
  const auto fluid = static_cast<std::size_t>(water_in(flow).particles);
  Json summary = {{"title", spec_.general.title},
                  {"case", case_file_},
                  {"status", status},
                  {"exit_code", nullptr},
                  {"message", message},
                  {"warnings", warnings()},
                  {"dimension", spec_.general.dimension},
                  {"spacing_m", spec_.particles.spacing},
                  {"seed", spec_.particles.seed},
                  {"particles", {{"fluid", fluid}, {"wall", flow.walls.all}}},
                  {"time_s", {{"end", spec_.time.end}, {"reached", flow.state.time}}},
                  {"cost",
                   {{"runs", runs_before_ + 1},
                    {"wall_clock_s", wall_seconds()},
                    {"cpu_s", cpu},
                    {"cpu_s_per_simulated_s", flow.state.time > 0.0 ? cpu / flow.state.time : 0.0},
                    {"peak_memory_bytes", memory}}},
                  {"ranks", rank_log_.json()}};
  summary.update(statistics_.json(fluid, static_cast<std::size_t>(water_at_start_.particles)));
  summary["water_balance"] = water_balance(water_at_start_, flow);
  for (const auto& part : flow.parts) part->add_to_summary(flow, summary);
  for (const auto& [probe, lines] : probes_.summaries()) {
    for (const auto& [name, value] : lines) summary["probes"][probe][name] = value;
  }
  if (code) {
    do_on_root(ranks_, [&] {
      try {
        results_ = probe_results(spec_, folder_, flow.state.time, flow.setup.time_step_rule.reference_speed);
        scores_ = measurement_scores(spec_, folder_.path());
      } catch (const IoError&) {
        if (message.empty()) throw;  // the summary of a failed run counts more than its results
      }
      summary["results"] = json_of(results_);
      if (!scores_.empty()) summary["measurements"] = json_of(scores_);
    });
  }
  summary.update(provenance());
  if (code) summary["exit_code"] = static_cast<int>(*code);
  std::string text = summary.dump(2) + "\n";
  if (!code) text.append(room_for_last_summary, ' ');
  do_on_root(ranks_, [&] { write_last_file(folder_.summary(), text); });
}

template <int Dim>
void RunOutput<Dim>::tell_water(const Flow<Dim>& flow) const {
  const WaterAmount outside = water_outside(flow);
  if (!flow.is_open() && outside.particles == 0) return;
  const auto& ends = flow.template part<OpenEnds<Dim>>();
  const WaterAmount came = ends.arrived();
  tell("water: {} at the start, {}{} inside, {} outside the walls, {} out", text_of(water_at_start_),
       came.particles > 0 ? text_of(came) + " in, " : "", text_of(water_inside(flow)), text_of(outside),
       text_of(ends.departed()));
}

template <int Dim>
void RunOutput<Dim>::tell_results() const {
  constexpr std::size_t max_told = 20;
  for (std::size_t k = 0; k < std::min(results_.size(), max_told); ++k) {
    tell("{}: {}", results_[k].probe, results_[k].words());
  }
  if (results_.size() > max_told) {
    tell("and {} more probes: tailwater info {}", results_.size() - max_told, folder_.path().string());
  }
  for (std::size_t k = 0; k < std::min(scores_.size(), max_told); ++k) {
    tell("{}: {}", scores_[k].probe, scores_[k].words());
  }
  if (scores_.size() > max_told) {
    tell("and {} more measurements: tailwater info {}", scores_.size() - max_told, folder_.path().string());
  }
}

template class RunOutput<2>;
template class RunOutput<3>;

}  // namespace tailwater
