#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/ranks.h"
#include "app/run_arguments.h"
#include "app/sweep.h"
#include "case/reader.h"
#include "case_help/help.h"
#include "io/messages.h"
#include "run/run_case.h"

namespace tailwater {
namespace {

struct NewRunArguments : RunArguments {
  std::vector<std::string> sweep;
  std::string help_case;
};

std::string help_on_cases(const std::string& format) {
  if (format == "markdown") return case_reference_markdown();
  if (format == "json") return case_reference_json();
  if (format == "schema") return case_schema();
  if (format == "probes") return probe_reference_markdown();
  return format == "study" ? study_reference_markdown() : case_help();
}

ExitCode execute_run(NewRunArguments arguments, const Communicator& ranks, const std::vector<std::string>& words) {
  if (!arguments.help_case.empty()) {
    if (ranks.is_root()) fmt::print("{}", help_on_cases(arguments.help_case));
    return ExitCode::done;
  }
  if (arguments.run.case_file.empty() || arguments.run.out.empty()) {
    throw InputError("tailwater run needs a case file and --out DIR, as in: tailwater run my.toml --out my_run");
  }
  ignore_hangup_and_open_messages(ranks, arguments.quiet);
  arguments.run.wall_time.limit = wall_time_of(arguments.wall_time);
  if (arguments.ranks) require_possible(*arguments.ranks);
  if (!arguments.sweep.empty()) {
    if (arguments.pictures > 0) {
      throw InputError("--pictures and --sweep: remedy: tailwater pictures DIR/MEMBER, when a member is done");
    }
    if (arguments.run.force) {
      throw InputError(
          "--force and --sweep: a sweep continues with the members that are not done; remedy: another --out");
    }
    return run_sweep(arguments.run.case_file, arguments.overrides, arguments.sweep,
                     {.out = arguments.run.out,
                      .jobs = arguments.jobs.value_or(1),
                      .ranks = arguments.ranks,
                      .wall_time = arguments.run.wall_time});
  }
  if (arguments.jobs) throw InputError("--jobs is for sweeps; remedy: leave it out, or add --sweep KEY=VALUE,VALUE");
  const CaseSpec spec = read_case(arguments.run.case_file, arguments.overrides);
  if (ranks.is_alone()) {
    const int count = arguments.ranks ? *arguments.ranks : ranks_by_default(spec);
    if (count > 1 && !arguments.ranks) tell("on {} ranks; -n 1 for one", count);
    if (count > 1) return launch_ranks(count, words, arguments.run.out);
  }
  return run_here(arguments, ranks, [&] { return run_case(spec, arguments.run, ranks); });
}

}  // namespace

void add_run_command(CLI::App& app, ExitCode& code, const Communicator& ranks, const std::vector<std::string>& words) {
  auto arguments = std::make_shared<NewRunArguments>();
  CLI::App* command = app.add_subcommand("run", "Run a case or a sweep");
  command->add_option("case", arguments->run.case_file, "Case file")->type_name("");
  command->add_option("--out", arguments->run.out, "Folder for the results; created by the run")->type_name("DIR");
  command
      ->add_option("--set", arguments->overrides,
                   "Override a key, for example scheme.integrator=implicit; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command
      ->add_option("--sweep", arguments->sweep,
                   "Run the case for each value of a key, for example particles.spacing=0.02,0.01. Several --sweep "
                   "options run all combinations.")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE,...");
  add_jobs_option(*command, *arguments);
  add_rank_and_time_options(*command, *arguments,
                            "Number of ranks, started with mpirun (default: 1; for large cases up to one per core)");
  command->add_flag("--force", arguments->run.force, "Replace the results of an earlier run in the same folder");
  add_picture_and_voice_options(*command, *arguments);
  command
      ->add_option(
          "--help-case", arguments->help_case,
          "Print the reference of all case keys as text, markdown, json or schema (for editors); study: print the keys "
          "for numerical studies; probes: print the output of each type of probe")
      ->expected(0, 1)
      ->default_str("text")
      ->check(CLI::IsMember({"text", "markdown", "json", "schema", "study", "probes"}).description(""))
      ->type_name("FORMAT");
  command->footer(
      "Examples: tailwater run my.toml --out my_run\n"
      "          tailwater run my.toml --out my_run -n 8 --pictures 12\n"
      "          tailwater run my.toml --out fine --set particles.spacing=0.01 --set scheme.integrator=implicit\n"
      "          tailwater run my.toml --out sweep --sweep particles.spacing=0.02,0.015,0.01 --jobs 2\n"
      "\n"
      "Output: DIR/case.effective.toml (the case with the values of all keys),\n"
      "DIR/steps.csv, DIR/probes/NAME.csv, DIR/fields/fields.pvd (for ParaView) and\n"
      "DIR/summary.json. A run that fails also writes DIR/failure/.\n"
      "\n"
      "To stop a run: Ctrl-C, or touch DIR/STOP. The run stops after the current time\n"
      "step, its output is complete, and `tailwater resume DIR` continues it.\n"
      "\n"
      "Checkpoints are written every output.checkpoint_interval seconds of elapsed\n"
      "time, at the end of the run, and on request: touch DIR/CHECKPOINT.\n"
      "\n"
      "A sweep writes one folder per member and a table of all members, DIR/sweep.csv.\n"
      "To continue a sweep, repeat the command or use `tailwater resume DIR`. If a\n"
      "member fails, the other members still run.");
  command->callback([arguments, &code, ranks, words] { code = execute_run(*arguments, ranks, words); });
}

}  // namespace tailwater
