#include "run/run_case.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/for_each.h"
#include "checks/check.h"
#include "flow/verbs.h"
#include "geometry/from_spec.h"
#include "io/messages.h"
#include "parallel/at_start.h"
#include "run/checkpoint_keeper.h"
#include "run/estimate.h"
#include "run/requests.h"
#include "run/run_output.h"
#include "run/step_guard.h"
#include "run/summary_file.h"
#include "schemes/advance.h"

namespace tailwater {
namespace {

/// Particles drift slowly out of cache order and out of their rank's part of space. Sorting and sharing them out at
/// this interval costs next to nothing.
constexpr std::int64_t steps_between_sorts = 10;

/// dx; what is checked beside walls is nearer.
constexpr double reach_of_checks = 3.0;

template <int Dim>
class Run {
 public:
  /// Goes on from the checkpoint if there is one.
  Run(const CaseSpec& spec, const RunOptions& options, const Communicator& ranks,
      std::optional<Checkpoint<Dim>> checkpoint)
      : end_(spec.time.end),
        wall_time_(options.wall_time),
        flow_(spec, ranks),
        output_(spec, options, flow_, checkpoint ? &checkpoint->output : nullptr),
        guard_(flow_, output_.folder()),
        keeper_(spec, output_.folder(), ranks) {
    if (!checkpoint) return;
    go_on_from(*checkpoint);
    tell(fmt::format("going on from step {}, t = {:.4f} s", flow_.state.step, flow_.state.time));
  }

  ExitCode execute() {
    try {
      output_.begin(flow_);
      const ExitCode code = loop();
      output_.finish(flow_, code);
      return code;
    } catch (const UserError& error) {
      output_.finish_failed(flow_, error.code(), error.what());
      throw;
    }
  }

 private:
  /// Whether walls, what drives them, and open ends of the state are those of the case.
  bool fits(const State<Dim>& state) const {
    const std::size_t misplaced = count_each(state.particles.owned, [&](std::size_t i) {
      const std::int64_t number = state.particles.id[i] - flow_.setup.first_wall_id;
      return !state.particles.is_fluid(i) && (number < 0 || number >= flow_.walls.particles.numbers);
    });
    std::size_t ways = 0;
    for (const FloatingBody<Dim>& body : flow_.setup.bodies) ways += body.free.size();
    const MotionState<Dim>& motion = state.motion;
    const bool moves_alike = motion.wave_makers.size() == flow_.state.motion.wave_makers.size() &&
                             motion.bodies.each.size() == flow_.setup.bodies.size() &&
                             (motion.bodies.inertia.empty() || motion.bodies.inertia.size() == ways * ways);
    return misplaced == 0 && moves_alike && state.wall_velocity.size() == flow_.state.wall_velocity.size() &&
           state.open_ends.size() == flow_.state.open_ends.size() &&
           state.section_volumes.size() == flow_.state.section_volumes.size();
  }

  void go_on_from(Checkpoint<Dim>& checkpoint) {
    if (flow_.setup.ranks.any(!fits(checkpoint.state)) ||
        !flow_.shared_rows.find_rows(flow_.walls, checkpoint.state.particles, 0, flow_.setup.first_wall_id)) {
      throw IoError(fmt::format(
          "the checkpoint does not fit the walls, bodies, open ends and probes of its case; remedy: remove the newest "
          "file in '{}', to go on from the one before",
          output_.folder().checkpoints().string()));
    }
    keeper_.go_on_from(checkpoint.state.step);
    flow_.restore(std::move(checkpoint.state));
    output_.rank_log().restore(checkpoint.rank_log);
    output_.restore_probe_memory(checkpoint.probe_memory);
    guard_.restore_reference_step(checkpoint.reference_step);
    goes_on_ = true;
    if (!checkpoint.is_shared_out) return;
    if (!flow_.setup.ranks.is_alone()) flow_.decomposition.cuts().restore(std::move(checkpoint.cuts));
    shared_out_step_ = flow_.state.step;
  }

  ExitCode loop() {
    Requests requests(output_.folder(), flow_.setup.ranks, wall_time_);
    if (!goes_on_) begin();
    while (flow_.state.time < end_) {
      const Asked asked = requests.look(keeper_.is_due());
      if ((asked.stop || asked.checkpoint) && keeper_.write(flow_, output_)) requests.fulfil_checkpoint();
      if (asked.stop) return ExitCode::interrupted;
      output_.write_due_fields(flow_);
      step();
    }
    keeper_.write(flow_, output_);
    return ExitCode::done;
  }

  void begin() {
    guard_.remember_good();
    locate(flow_);
    guard_.require_sound_step(next_time_step(flow_));
    guard_.attempt([&] { start(flow_); });
    output_.record_probes(flow_, measure(flow_));
  }

  void step() {
    guard_.remember_good();
    const double dt = next_time_step(flow_);
    guard_.require_sound_step(dt);
    rearrange();
    StepReport report;
    // The last step is not cut to the end time: the density source is proportional to 1/dt^2, and a tiny step would
    // kick the water.
    guard_.attempt([&] { report = advance(flow_, std::min(dt, end_)); });
    output_.record_step(flow_, report);
  }

  /// Everything that changes the indices of particles: every few steps all are shared out and sorted, and those that
  /// have passed an open end are removed, and new ones come in. A checkpoint is of the moment between: before water
  /// that may have limited the time step has left.
  void rearrange() {
    const bool is_shared_out = flow_.state.step % steps_between_sorts == 0;
    if (is_shared_out) {
      if (flow_.state.step != shared_out_step_) output_.record_sharing(flow_, share_out(flow_));
      keeper_.remember(flow_, output_, guard_);
    }
    const bool some_left = let_go(flow_);
    const bool some_came = let_in(flow_);
    if (some_left || some_came || is_shared_out) guard_.remember_good();
  }

  double end_;  ///< s
  WallTime wall_time_;
  Flow<Dim> flow_;
  RunOutput<Dim> output_;
  StepGuard<Dim> guard_;
  CheckpointKeeper<Dim> keeper_;
  bool goes_on_ = false;               ///< from a checkpoint
  std::int64_t shared_out_step_ = -1;  ///< at which particles are as the checkpoint has them
};

template <int Dim>
ExitCode run_in(const CaseSpec& spec, const RunOptions& options, const Communicator& ranks,
                const SealedFile* checkpoint) {
  std::optional<Checkpoint<Dim>> read;
  if (checkpoint != nullptr) read = read_checkpoint<Dim>(*checkpoint, ranks);
  const auto make_run = [&] {
    try {
      return std::make_unique<Run<Dim>>(spec, options, ranks, std::move(read));
    } catch (const nlohmann::json::exception& error) {
      if (checkpoint == nullptr) throw;
      throw IoError(
          fmt::format("checkpoint '{}' does not say how far the output had come: {}; remedy: remove it, to go on from "
                      "the one before",
                      checkpoint->path.string(), error.what()));
    }
  };
  std::unique_ptr<Run<Dim>> run = make_run();
  try {
    return run->execute();
  } catch (const UserError&) {
    throw;
  } catch (const std::exception& error) {
    const bool is_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
    const std::string message = is_memory ? std::string("out of memory; ") + remedy_for_memory : error.what();
    run.reset();  // the summary needs some of its memory
    mark_as_failed(options.out / summary_name, ExitCode::solver_failed, message);
    throw SolverError(message);
  }
}

template <int Dim>
void require_sound_geometry_in(const CaseSpec& spec, const Communicator& ranks, bool warns) {
  Boundary<Dim> boundary = make_boundary<Dim>(spec);
  // What a machine has for its ranks is enough for as many times more on all machines.
  const double available = available_memory() * ranks.size() / ranks_on_this_machine(ranks);
  std::vector<Finding> findings = check_memory(spec, boundary, ranks.least(available));
  if (findings.empty()) {
    boundary.file_faces(reach_of_checks * spec.particles.spacing);
    // The velocities are found, and refused, when the flow is made.
    const auto fluid = make_fluid_particles(spec, boundary, ranks, 0, StartVelocities::left_out);
    findings = check_geometry(spec, boundary, fluid);
  }
  constexpr std::size_t most_shown = 50;
  std::vector<std::string> errors;
  for (const Finding& finding : findings) {
    if (finding.severity == Severity::error) {
      errors.push_back(finding.message);
    } else if (warns) {
      warn(spec.sources.placed(finding.message));
    }
  }
  if (errors.empty()) return;
  if (errors.size() > most_shown) {
    errors[most_shown] = fmt::format("and {} more problems", errors.size() - most_shown);
    errors.resize(most_shown + 1);
  }
  throw InputError(fmt::format("{}", fmt::join(errors, "\n")));
}

}  // namespace

void require_sound_geometry(const CaseSpec& spec, const Communicator& ranks, bool warns) {
  if (spec.general.dimension == 2) {
    require_sound_geometry_in<2>(spec, ranks, warns);
  } else {
    require_sound_geometry_in<3>(spec, ranks, warns);
  }
}

ExitCode run_case(const CaseSpec& spec, const RunOptions& options, const Communicator& ranks,
                  const SealedFile* checkpoint) {
  return with_places(spec, [&] {
    require_sound_geometry(spec, ranks, checkpoint == nullptr);
    return spec.general.dimension == 2 ? run_in<2>(spec, options, ranks, checkpoint)
                                       : run_in<3>(spec, options, ranks, checkpoint);
  });
}

}  // namespace tailwater
