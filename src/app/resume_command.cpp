#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/ranks.h"
#include "app/run_arguments.h"
#include "app/sweep.h"
#include "app/sweep_plan.h"
#include "run/resume.h"

namespace tailwater {
namespace {

ExitCode execute_resume(RunArguments arguments, const Communicator& ranks, const std::vector<std::string>& words) {
  ignore_hangup_and_open_messages(ranks, arguments.quiet);
  arguments.run.wall_time.limit = wall_time_of(arguments.wall_time);
  if (is_sweep(arguments.run.out)) {
    if (arguments.pictures > 0) {
      throw InputError("--pictures: a sweep; remedy: tailwater pictures DIR/MEMBER, when a member is done");
    }
    if (arguments.ranks) require_possible(*arguments.ranks);
    if (!arguments.overrides.empty()) {
      throw InputError(
          "--set {}: '{}' is a sweep, whose members have cases of their own; remedy: resume one member, {}/MEMBER, or "
          "start another sweep",
          arguments.overrides.front(), arguments.run.out.string(), arguments.run.out.string());
    }
    return resume_sweep({.out = arguments.run.out,
                         .jobs = arguments.jobs.value_or(1),
                         .ranks = arguments.ranks,
                         .wall_time = arguments.run.wall_time});
  }
  if (arguments.jobs) throw InputError("--jobs is for sweeps; remedy: leave it out");
  const int wanted = arguments.ranks.value_or(ranks.is_alone() ? ranks_of_run(arguments.run.out) : ranks.size());
  if (arguments.ranks) require_possible(wanted);
  if (wanted > 1 && ranks_in_environment() == 0) return launch_ranks(wanted, words, arguments.run.out);
  return run_here(arguments, ranks, [&] { return resume_run(arguments.run, arguments.overrides, ranks); });
}

}  // namespace

void add_resume_command(CLI::App& app, ExitCode& code, const Communicator& ranks,
                        const std::vector<std::string>& words) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("resume", "Continue a run or a sweep that was stopped, killed or finished");
  command->add_option("run", arguments->run.out, "Folder of the run or the sweep")->required()->type_name("");
  command
      ->add_option("--set", arguments->overrides,
                   "Override a key that does not affect earlier results, for example time.end=20")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  add_rank_and_time_options(*command, *arguments, "Number of ranks (default: the number that the run had)");
  add_jobs_option(*command, *arguments);
  add_picture_and_voice_options(*command, *arguments);
  command->footer(
      "Examples: tailwater resume my_run\n"
      "          tailwater resume my_sweep --jobs 2\n"
      "          tailwater resume my_run --set time.end=20\n"
      "\n"
      "The run continues from the newest checkpoint in DIR/checkpoints, or from the\n"
      "start if there is none. Tables and field files are truncated to the checkpoint.\n"
      "On the number of ranks that wrote the checkpoint, results are bit-identical to\n"
      "those of a run without interruption.\n"
      "\n"
      "--set may change time.end, output.fields_interval, output.view_interval and\n"
      "output.checkpoint_interval.");
  command->callback([arguments, &code, ranks, words] { code = execute_resume(*arguments, ranks, words); });
}

}  // namespace tailwater
