#include "run/run_case.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "case/writer.h"
#include "geometry/check.h"
#include "geometry/from_spec.h"
#include "io/pvd_series.h"
#include "io/write_file.h"
#include "parallel/together.h"
#include "probes/probe_set.h"
#include "run/estimate.h"
#include "run/failure.h"
#include "run/field_output.h"
#include "run/progress.h"
#include "run/provenance.h"
#include "run/rank_log.h"
#include "run/requests.h"
#include "run/statistics.h"
#include "run/step_log.h"
#include "schemes/advance.h"
#include "schemes/verbs.h"

namespace tailwater {
namespace {

/// Particles drift away from cache order, and out of their rank's part of space, slowly: sorting and sharing them out
/// this seldom keeps its cost below notice.
constexpr std::int64_t steps_between_sorts = 5;

/// A step below this share of the rule's own reference means some particle has run away: better an error now than a run
/// that never ends.
constexpr double collapsed_step = 1e-5;

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

/// An amount of water.
struct Water {
  std::int64_t particles = 0;
  double volume = 0.0;  ///< m^3; in 2D per metre of width

  nlohmann::ordered_json json() const { return {{"particles", particles}, {"volume_m3", volume}}; }
  std::string text() const { return fmt::format("{} particles ({:.6g} m^3)", particles, volume); }
};

/// Inside, on all ranks.
template <int Dim>
Water water_in(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.particles;
  Water water;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    ++water.particles;
    water.volume += particles.volume[i];
  }
  flow.ranks.sum_each(water.particles, water.volume);
  return water;
}

/// The box around all walls; empty when there are none.
template <int Dim>
Eigen::AlignedBox<double, Dim> box_around(const Boundary<Dim>& boundary) {
  Eigen::AlignedBox<double, Dim> box;
  for (const WallFace<Dim>& face : boundary.faces) {
    for (const Vec<Dim>& corner : face.corners) box.extend(corner);
  }
  return box;
}

/// Fluid particles beyond the box around all walls: they are still computed, but left the case over its rim. What is on
/// its way out through an outlet did not.
template <int Dim>
std::size_t count_outside(const Eigen::AlignedBox<double, Dim>& box, const Flow<Dim>& flow) {
  if (box.isEmpty()) return 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < flow.particles.owned; ++i) {
    const Vec<Dim>& x = flow.particles.position[i];
    count += flow.particles.is_fluid(i) && !box.contains(x) &&
             std::none_of(flow.open_ends.begin(), flow.open_ends.end(),
                          [&](const OpenEnd<Dim>& end) { return end.outlet.is_passed_by(x); });
  }
  return flow.ranks.sum(count);
}

/// Of this rank.
template <int Dim>
std::size_t fastest_particle(const Particles<Dim>& particles) {
  std::size_t fastest = 0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (particles.velocity[i].squaredNorm() > particles.velocity[fastest].squaredNorm()) fastest = i;
  }
  return fastest;
}

template <int Dim>
class Run {
 public:
  Run(const CaseSpec& spec, const RunOptions& options, const Communicator& ranks)
      : spec_(spec),
        options_(options),
        ranks_(ranks),
        tells_(ranks.is_root() && !options.quiet),
        flow_(spec, ranks),
        water_at_start_(water_in(flow_)),
        probe_list_(make_probes<Dim>(spec, flow_.boundary)),
        folder_(make_folder(flow_, spec, options)),
        series_(folder_.fields(), "fields", spec.output.compression),
        wall_series_(folder_.fields(), "walls", spec.output.compression),
        rank_log_(ranks, folder_.ranks()),
        probes_(std::move(probe_list_), folder_, ranks),
        progress_(spec.time.end, !tells_),
        statistics_(measure(flow_)) {
    do_on_root(ranks, [&] {
      step_log_.emplace(folder_.steps());
      write_text_file(folder_.effective_case(), effective_case(spec));
    });
  }

  ExitCode execute() {
    ExitCode code = ExitCode::done;
    try {
      code = loop();
    } catch (const SolverError& error) {
      progress_.finish();
      write_summary("failed", ExitCode::solver_failed, error.what());
      throw;
    }
    progress_.finish();
    write_fields();
    write_summary(code == ExitCode::done ? "done" : "interrupted", code, "");
    print_water_balance();
    return code;
  }

 private:
  /// Last in the row of checks: from here on there are traces.
  static RunFolder make_folder(const Flow<Dim>& flow, const CaseSpec& spec, const RunOptions& options) {
    require_reachable_end(spec, flow.time_step_rule);
    return RunFolder::create(options.out, options.force, flow.ranks);
  }

  ExitCode loop() {
    Requests requests(folder_, ranks_);
    const double field_interval =
        spec_.output.fields_interval > 0.0 ? spec_.output.fields_interval : spec_.time.end / default_field_files;
    double next_fields = 0.0;

    remember_good();
    locate(flow_);
    require_sound_step(next_time_step(flow_));
    attempt([&] { start(flow_); });
    record_probes(measure(flow_));
    while (flow_.time < spec_.time.end) {
      if (requests.stop_is_asked()) return ExitCode::interrupted;
      if (flow_.time >= next_fields) {
        write_fields();
        next_fields = (std::floor(flow_.time / field_interval) + 1.0) * field_interval;
      }
      step();
    }
    return ExitCode::done;
  }

  void step() {
    remember_good();
    const double dt = next_time_step(flow_);
    require_sound_step(dt);
    const bool is_shared_out = flow_.step % steps_between_sorts == 0;
    if (is_shared_out) rank_log_.write(flow_, share_out(flow_));
    const bool some_left = let_go(flow_);
    // An index must mean the same particle before and after the step.
    if (some_left || is_shared_out) remember_good();
    StepReport report;
    // The last step is not cut to the end time: the density source goes with 1/dt^2, and a tiny step would kick the
    // water.
    attempt([&] { report = advance(flow_, std::min(dt, spec_.time.end)); });
    const FlowMeasures measures = measure(flow_);
    const std::size_t outside = count_outside<Dim>(box_around(flow_.boundary), flow_);
    warn_if_outside(outside);
    statistics_.add(report, measures, outside);
    if (step_log_) step_log_->write(flow_.time, flow_.step, report, measures);
    record_probes(measures);
    progress_.show(flow_.time, flow_.step, report, measures);
  }

  void remember_good() {
    last_good_ = flow_.particles;
    last_good_time_ = flow_.time;
  }

  void require_sound_step(double dt) {
    const double reference_step = flow_.time_step_rule.largest(0.0, 0.0);
    if (!std::isfinite(reference_step) || dt >= collapsed_step * reference_step) return;
    const double speed = largest_speed(flow_);
    std::optional<std::size_t> culprit;
    if (flow_.particles.owned > 0) culprit = fastest_particle(flow_.particles);
    if (culprit && flow_.particles.velocity[*culprit].norm() < speed) culprit.reset();
    blame(culprit, [&](std::size_t i) {
      return fmt::format("the time step collapsed to {:.3g} s: particle {} at {} moves at {:.4g} m/s", dt,
                         flow_.particles.id[i], place<Dim>(flow_.particles.position[i]),
                         flow_.particles.velocity[i].norm());
    });
  }

  /// Does a part of the solution. A particle that is not finite is told before what followed from it.
  template <class Work>
  void attempt(const Work& work) {
    std::string failure;
    try {
      work();
    } catch (const SolverError& error) {
      failure = error.what();  // on all ranks: what throws is collective
    }
    const std::optional<std::size_t> culprit = find_non_finite(flow_);
    if (ranks_.any(culprit.has_value())) {
      blame(culprit, [&](std::size_t i) {
        return fmt::format("particle {}, which was at {}, has a value that is not finite", flow_.particles.id[i],
                           place<Dim>(last_good_.position[i]));
      });
    }
    if (!failure.empty()) fail(failure, std::nullopt);
  }

  /// Ends the run for the particle that went wrong, on the first rank that has one: `describe` says what did. The run's
  /// instability is named as the cause.
  template <class Describe>
  [[noreturn]] void blame(std::optional<std::size_t> culprit, const Describe& describe) {
    const int rank = ranks_.least(culprit ? ranks_.rank() : ranks_.size());
    const bool is_here = rank == ranks_.rank();
    if (!is_here) culprit.reset();
    const std::string reason = ranks_.broadcast(is_here ? describe(*culprit) : std::string(), rank);
    fail(reason +
             ". The run has become unstable; remedy: a smaller scheme.courant, a larger "
             "scheme.noise_viscosity, or scheme.formulation = \"robust\" where it is not chosen",
         culprit);
  }

  /// `culprit`: on the rank that has it.
  [[noreturn]] void fail(const std::string& reason, std::optional<std::size_t> culprit) {
    const std::string message =
        fmt::format("step {} from t = {:.6g} s failed: {}", flow_.step, last_good_time_, reason);
    write_failure(folder_, flow_, last_good_, last_good_time_, culprit, message);
    flow_.particles = last_good_;
    flow_.time = last_good_time_;
    throw SolverError(
        fmt::format("{}. The last good fields and a report are in {}", message, (folder_.path() / "failure").string()));
  }

  void warn_if_outside(std::size_t outside) {
    if (outside == 0 || warned_outside_ || !tells_) return;
    warned_outside_ = true;
    progress_.finish();
    fmt::print(stderr,
               "warning: at t = {:.4f} s {} fluid particle(s) left the box around the walls; they are still "
               "computed, and counted in summary.json. Remedy: higher walls\n",
               flow_.time, outside);
  }

  void write_fields() {
    if (last_fields_time_ == flow_.time && series_.size() > 0) return;
    last_fields_time_ = flow_.time;
    const FluidFields<Dim> fields(flow_, flow_.particles, spec_.output.fields);
    series_.write(flow_.time, fields.view(), ranks_);
    if (!flow_.wall_motion.moving().empty()) {
      do_on_root(ranks_, [&] { wall_series_.write(flow_.time, WallFields<Dim>(flow_.boundary).view()); });
    }
  }

  void record_probes(const FlowMeasures& measures) {
    if (!probes_.is_due(flow_.time)) return;
    probes_.record({.particles = flow_.particles,
                    .grid = flow_.neighbourhood.grid(),
                    .kernel = flow_.neighbourhood.kernel(),
                    .boundary = flow_.boundary,
                    .density = flow_.density,
                    .gravity = flow_.gravity,
                    .spacing = flow_.spacing,
                    .time = flow_.time,
                    .totals = {.kinetic_energy = measures.kinetic_energy,
                               .potential_energy = measures.potential_energy,
                               .density_error_mean = measures.density_error_mean,
                               .density_error_rms = measures.density_error_rms,
                               .volume_out = measures.departed.volume},
                    .ranks = ranks_});
  }

  Water water_out() const {
    Departed all;
    for (const OpenEnd<Dim>& end : flow_.open_ends) all += end.departed;
    return {all.particles, all.volume};
  }

  nlohmann::ordered_json water_balance() const {
    nlohmann::ordered_json outlets = nlohmann::ordered_json::array();
    for (const OpenEnd<Dim>& end : flow_.open_ends) {
      outlets.push_back({{"name", end.outlet.name},
                         {"particles", end.departed.particles},
                         {"volume_m3", end.departed.volume},
                         {"energy_J", end.departed.energy}});
    }
    return {{"start", water_at_start_.json()},
            {"inside", water_in(flow_).json()},
            {"out", water_out().json()},
            {"outlets", outlets}};
  }

  void print_water_balance() const {
    if (flow_.open_ends.empty()) return;
    const Water inside = water_in(flow_);
    if (!tells_) return;
    fmt::print(stderr, "water: {} at the start, {} inside, {} out\n", water_at_start_.text(), inside.text(),
               water_out().text());
  }

  void write_summary(const std::string& status, ExitCode code, const std::string& message) {
    const double wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const double cpu = ranks_.sum(cpu_seconds() - cpu_start_);
    const double memory = ranks_.sum(peak_memory_bytes());
    const auto fluid = static_cast<std::size_t>(water_in(flow_).particles);
    const std::size_t all = ranks_.sum(flow_.particles.owned);
    nlohmann::ordered_json summary = {{"title", spec_.general.title},
                                      {"case", options_.case_file.string()},
                                      {"status", status},
                                      {"exit_code", static_cast<int>(code)},
                                      {"message", message},
                                      {"spacing_m", spec_.particles.spacing},
                                      {"particles", {{"fluid", fluid}, {"wall", all - fluid}}},
                                      {"time_s", {{"end", spec_.time.end}, {"reached", flow_.time}}},
                                      {"cost",
                                       {{"wall_clock_s", wall_seconds},
                                        {"cpu_s", cpu},
                                        {"cpu_s_per_simulated_s", flow_.time > 0.0 ? cpu / flow_.time : 0.0},
                                        {"peak_memory_bytes", memory}}},
                                      {"ranks", rank_log_.json()}};
    summary.update(statistics_.json(fluid, static_cast<std::size_t>(water_at_start_.particles)));
    summary["water_balance"] = water_balance();
    summary.update(provenance());
    if (ranks_.is_root()) write_text_file(folder_.summary(), summary.dump(2) + "\n");
  }

  const CaseSpec& spec_;
  const RunOptions& options_;
  Communicator ranks_;
  bool tells_;  ///< speaks to the user: the root, unless it shall be quiet
  Flow<Dim> flow_;
  Water water_at_start_;
  std::vector<Probe<Dim>> probe_list_;  // made before the folder: a probe in the wrong place leaves nothing behind
  RunFolder folder_;
  PvdSeries series_;
  PvdSeries wall_series_;            ///< only when a wall moves
  std::optional<StepLog> step_log_;  ///< on the root
  RankLog rank_log_;
  ProbeSet<Dim> probes_;
  Progress progress_;
  RunStatistics statistics_;
  Particles<Dim> last_good_;
  double last_good_time_ = 0.0;
  double last_fields_time_ = -1.0;
  bool warned_outside_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double cpu_start_ = cpu_seconds();
};

template <int Dim>
void require_sound_geometry_in(const CaseSpec& spec, bool quiet) {
  std::vector<Finding> findings = check_memory<Dim>(spec, available_memory());
  if (findings.empty()) {
    const Boundary<Dim> boundary = make_boundary<Dim>(spec);
    findings = check_geometry(spec, boundary, make_fluid_particles(spec, boundary));
  }
  std::string errors;
  for (const Finding& finding : findings) {
    if (finding.severity == Severity::error) {
      errors += (errors.empty() ? "" : "\n") + finding.message;
    } else if (!quiet) {
      fmt::print(stderr, "warning: {}\n", finding.message);
    }
  }
  if (!errors.empty()) throw InputError(errors);
}

}  // namespace

void require_sound_geometry(const CaseSpec& spec, bool quiet) {
  if (spec.general.dimension == 2) {
    require_sound_geometry_in<2>(spec, quiet);
  } else {
    require_sound_geometry_in<3>(spec, quiet);
  }
}

ExitCode run_case(const CaseSpec& spec, const RunOptions& options, const Communicator& ranks) {
  require_sound_geometry(spec, options.quiet || !ranks.is_root());
  return spec.general.dimension == 2 ? Run<2>(spec, options, ranks).execute() : Run<3>(spec, options, ranks).execute();
}

}  // namespace tailwater
