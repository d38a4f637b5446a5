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

#include "base/json.h"
#include "checks/check.h"
#include "geometry/from_spec.h"
#include "geometry/opening.h"
#include "io/messages.h"
#include "parallel/at_start.h"
#include "results/summary_file.h"
#include "run/estimate.h"
#include "run/folder_output.h"
#include "run/requests.h"
#include "run/simulation.h"

namespace tailwater {
namespace {

/// dx; all checks beside walls are within this distance.
constexpr double reach_of_checks = 3.0;

/// A simulation with its folder, until it ends, fails or receives a request to stop.
template <int Dim>
class Run {
 public:
  /// Resumes from the checkpoint if there is one.
  Run(const CaseSpec& spec, const RunOptions& options, const Communicator& ranks,
      std::optional<Checkpoint<Dim>> checkpoint)
      : goes_on_(checkpoint.has_value()),
        wall_time_(options.wall_time),
        simulation_(spec, ranks),
        output_(spec, options, simulation_, std::move(checkpoint)) {}

  ExitCode execute() {
    try {
      output_.begin();
      const ExitCode code = loop();
      output_.finish(code);
      return code;
    } catch (const UserError& error) {
      output_.finish_failed(error.code(), error.what());
      throw;
    }
  }

 private:
  ExitCode loop() {
    Requests requests(output_.folder(), simulation_.flow().setup.ranks, wall_time_);
    if (!goes_on_) simulation_.start();
    while (!simulation_.has_ended()) {
      const Asked asked = requests.look(output_.checkpoint_is_due());
      if ((asked.stop || asked.checkpoint) && output_.write_checkpoint()) requests.fulfil_checkpoint();
      if (asked.stop) return ExitCode::interrupted;
      simulation_.step();
    }
    output_.write_checkpoint();
    return ExitCode::done;
  }

  bool goes_on_;  ///< whether it resumes from a checkpoint
  WallTime wall_time_;
  Simulation<Dim> simulation_;
  FolderOutput<Dim> output_;
};

template <int Dim>
ExitCode run_in(const CaseSpec& spec, const RunOptions& options, const Communicator& ranks,
                const SealedFile* checkpoint) {
  std::optional<Checkpoint<Dim>> read;
  if (checkpoint != nullptr) read = read_checkpoint<Dim>(*checkpoint, ranks);
  const auto make_run = [&] {
    try {
      return std::make_unique<Run<Dim>>(spec, options, ranks, std::move(read));
    } catch (const Json::exception& error) {
      if (checkpoint == nullptr) throw;
      throw IoError(
          "checkpoint '{}' has no record of the progress of the output: {}; remedy: remove it, to continue from the "
          "one before",
          checkpoint->path.string(), error.what());
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
void require_sound_geometry_in(const CaseSpec& spec, const Communicator& ranks, CaseWarnings warnings) {
  Boundary<Dim> boundary = make_boundary<Dim>(spec);
  // The memory of this machine for its ranks is scaled to the ranks of all machines.
  const double available = available_memory() * ranks.size() / ranks_on_this_machine(ranks);
  Findings findings = check_memory(spec, boundary, ranks.least(available));
  if (findings.empty()) {
    boundary.file_faces(reach_of_checks * spec.particles.spacing);
    // The velocities are computed, and refused if wrong, when the flow is made.
    const auto fluid = make_fluid_particles(spec, boundary, ranks, 0, StartVelocities::left_out);
    findings = check_geometry(spec, boundary, fluid);
  }
  Findings errors;
  for (const Finding& finding : merge_alike(spec.sources.located(findings))) {
    if (finding.severity == Severity::error) {
      errors.push_back(finding);
    } else if (warnings == CaseWarnings::told) {
      warn(finding);
    }
  }
  if (!errors.empty()) throw CaseError(errors);
}

}  // namespace

void require_sound_geometry(const CaseSpec& spec, const Communicator& ranks, CaseWarnings warnings) {
  if (spec.general.dimension == 2) {
    require_sound_geometry_in<2>(spec, ranks, warnings);
  } else {
    require_sound_geometry_in<3>(spec, ranks, warnings);
  }
}

ExitCode run_case(const CaseSpec& spec, const RunOptions& options, const Communicator& ranks,
                  const SealedFile* checkpoint) {
  return with_places(spec, [&] {
    const CaseSpec complete = with_sections_found(spec);
    require_sound_geometry(complete, ranks, checkpoint == nullptr ? CaseWarnings::told : CaseWarnings::left_out);
    return spec.general.dimension == 2 ? run_in<2>(complete, options, ranks, checkpoint)
                                       : run_in<3>(complete, options, ranks, checkpoint);
  });
}

}  // namespace tailwater
