#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.h"
#include "case/help.h"
#include "case/reader.h"
#include "linear/session.h"
#include "run/run_case.h"

namespace tailwater {
namespace {

struct RunArguments {
  RunOptions run;
  std::vector<std::string> overrides;
  int ranks = 1;
  std::string help_case;
};

ExitCode execute(const RunArguments& arguments) {
  if (!arguments.help_case.empty()) {
    fmt::print("{}", arguments.help_case == "markdown" ? case_reference_markdown() : case_help());
    return ExitCode::done;
  }
  if (arguments.run.case_file.empty() || arguments.run.out.empty()) {
    throw InputError("tailwater run needs a case file and --out DIR, as in: tailwater run my.toml --out my_run");
  }
  if (arguments.ranks != 1) {
    throw InputError(fmt::format("-n {}: this version runs on one rank; remedy: leave -n out", arguments.ranks));
  }
  const CaseSpec spec = read_case(arguments.run.case_file, arguments.overrides);
  const LinearSession session;
  const ExitCode code = run_case(spec, arguments.run, Communicator::world());
  if (!arguments.run.quiet) {
    fmt::print(stderr, "{}: results in {}\n", code == ExitCode::done ? "done" : "interrupted",
               arguments.run.out.string());
  }
  return code;
}

}  // namespace

void add_run_command(CLI::App& app, ExitCode& code) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Run a case");
  command->add_option("case", arguments->run.case_file, "The case file")->type_name("");
  command->add_option("--out", arguments->run.out, "Folder for the results; made by the run")->type_name("DIR");
  command->add_option("--set", arguments->overrides, "Override a key, as in --set scheme.integrator=implicit")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_option("-n", arguments->ranks, "Number of ranks; this version runs on one")->type_name("COUNT");
  command->add_flag("--force", arguments->run.force, "Replace the results of an earlier run in the same folder");
  command->add_flag("--quiet", arguments->run.quiet, "No progress and no warnings");
  command->add_option("--help-case", arguments->help_case, "Explain every key of a case file (text or markdown)")
      ->expected(0, 1)
      ->default_str("text")
      ->check(CLI::IsMember({"text", "markdown"}))
      ->type_name("FORMAT");
  command->footer(
      "Examples: tailwater run my.toml --out my_run\n"
      "          tailwater run my.toml --out fine --set particles.spacing=0.01 --set scheme.integrator=implicit\n"
      "Writes DIR/case.effective.toml (the case with all its values), DIR/steps.csv, DIR/probes/NAME.csv,\n"
      "DIR/fields/fields.pvd (open it in ParaView) and DIR/summary.json; if the run fails, also DIR/failure/.\n"
      "Ctrl-C ends a run in order: what it has written can be used.");
  command->callback([arguments, &code] { code = execute(*arguments); });
}

}  // namespace tailwater
