#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/ranks.h"
#include "app/run_arguments.h"
#include "app/sweep.h"
#include "case/help.h"
#include "case/reader.h"
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
  survive_hang_up_and_speak(ranks, arguments.quiet);
  arguments.run.wall_time.limit = wall_time_of(arguments.wall_time);
  if (arguments.ranks) require_possible(*arguments.ranks);
  if (!arguments.sweep.empty()) {
    if (arguments.pictures > 0) {
      throw InputError("--pictures and --sweep: remedy: tailwater pictures DIR/MEMBER, when a member is done");
    }
    if (arguments.run.force) {
      throw InputError("--force and --sweep: a sweep goes on with what is not done; remedy: another --out");
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
  CLI::App* command = app.add_subcommand("run", "Run a case");
  command->add_option("case", arguments->run.case_file, "The case file")->type_name("");
  command->add_option("--out", arguments->run.out, "Folder for the results; made by the run")->type_name("DIR");
  command->add_option("--set", arguments->overrides, "Override a key, as in --set scheme.integrator=implicit")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command
      ->add_option("--sweep", arguments->sweep,
                   "Run the case once for each value of a key, as in --sweep particles.spacing=0.02,0.01; several "
                   "--sweep make the product")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE,...");
  add_jobs_option(*command, *arguments);
  add_rank_and_time_options(
      *command, *arguments,
      "Number of ranks, which this program starts by mpirun; default: 1, in large cases one for each core");
  command->add_flag("--force", arguments->run.force, "Replace the results of an earlier run in the same folder");
  add_picture_and_voice_options(*command, *arguments);
  command
      ->add_option(
          "--help-case", arguments->help_case,
          "Explain every key of a case file (text, markdown, json, or schema for editors), or those of studies (study)")
      ->expected(0, 1)
      ->default_str("text")
      ->check(CLI::IsMember({"text", "markdown", "json", "schema", "study"}))
      ->type_name("FORMAT");
  command->footer(
      "Examples: tailwater run my.toml --out my_run\n"
      "          tailwater run my.toml --out my_run -n 8 --pictures 12\n"
      "          tailwater run my.toml --out fine --set particles.spacing=0.01 --set scheme.integrator=implicit\n"
      "          tailwater run my.toml --out sweep --sweep particles.spacing=0.02,0.015,0.01 --jobs 2\n"
      "Writes DIR/case.effective.toml (the case with all its values), DIR/steps.csv, DIR/probes/NAME.csv,\n"
      "DIR/fields/fields.pvd (open it in ParaView) and DIR/summary.json; if the run fails, also DIR/failure/.\n"
      "Ctrl-C, or the file DIR/STOP (touch DIR/STOP), ends a run in order after the present step: what it has written\n"
      "can be used, and `tailwater resume DIR` goes on. Checkpoints are also written every output.checkpoint_interval\n"
      "seconds, at the end, and when there is a file DIR/CHECKPOINT, which is removed when that is done.\n"
      "A sweep has a folder for each member in DIR, and a table of all, DIR/sweep.csv. The same command again, or\n"
      "`tailwater resume DIR`, goes on with what is not done. A member that fails does not end the others.");
  command->callback([arguments, &code, ranks, words] { code = execute_run(*arguments, ranks, words); });
}

}  // namespace tailwater
