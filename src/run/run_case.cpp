#include "run/run_case.h"

#include <algorithm>

#include "flow/verbs.h"
#include "geometry/check.h"
#include "geometry/from_spec.h"
#include "io/messages.h"
#include "run/estimate.h"
#include "run/requests.h"
#include "run/run_output.h"
#include "run/step_guard.h"
#include "schemes/advance.h"

namespace tailwater {
namespace {

/// Particles drift slowly out of cache order and out of their rank's part of space. Sorting and sharing them out at
/// this interval costs next to nothing.
constexpr std::int64_t steps_between_sorts = 5;

template <int Dim>
class Run {
 public:
  Run(const CaseSpec& spec, const RunOptions& options, const Communicator& ranks)
      : end_(spec.time.end),
        flow_(spec, ranks),
        output_(spec, options, flow_),
        guard_(flow_, output_.folder(), spec.limits.smallest_step) {}

  ExitCode execute() {
    try {
      const ExitCode code = loop();
      output_.finish(flow_, code);
      return code;
    } catch (const SolverError& error) {
      output_.finish_failed(flow_, error.what());
      throw;
    }
  }

 private:
  ExitCode loop() {
    Requests requests(output_.folder(), flow_.setup.ranks);
    begin();
    while (flow_.state.time < end_) {
      if (requests.stop_is_asked()) return ExitCode::interrupted;
      output_.write_due_fields(flow_);
      step();
    }
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
  /// have passed an outlet are removed.
  void rearrange() {
    const bool is_shared_out = flow_.state.step % steps_between_sorts == 0;
    if (is_shared_out) output_.record_sharing(flow_, share_out(flow_));
    const bool some_left = let_go(flow_);
    if (some_left || is_shared_out) guard_.remember_good();
  }

  double end_;  ///< s
  Flow<Dim> flow_;
  RunOutput<Dim> output_;
  StepGuard<Dim> guard_;
};

template <int Dim>
void require_sound_geometry_in(const CaseSpec& spec) {
  std::vector<Finding> findings = check_memory<Dim>(spec, available_memory());
  if (findings.empty()) {
    const Boundary<Dim> boundary = make_boundary<Dim>(spec);
    findings = check_geometry(spec, boundary, make_fluid_particles(spec, boundary));
  }
  std::string errors;
  for (const Finding& finding : findings) {
    if (finding.severity == Severity::error) {
      errors += (errors.empty() ? "" : "\n") + finding.message;
    } else {
      warn(spec.sources.placed(finding.message));
    }
  }
  if (!errors.empty()) throw InputError(errors);
}

}  // namespace

void require_sound_geometry(const CaseSpec& spec) {
  if (spec.general.dimension == 2) {
    require_sound_geometry_in<2>(spec);
  } else {
    require_sound_geometry_in<3>(spec);
  }
}

ExitCode run_case(const CaseSpec& spec, const RunOptions& options, const Communicator& ranks) {
  return with_places(spec, [&] {
    require_sound_geometry(spec);
    return spec.general.dimension == 2 ? Run<2>(spec, options, ranks).execute()
                                       : Run<3>(spec, options, ranks).execute();
  });
}

}  // namespace tailwater
