#include <fmt/format.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/ranks.h"
#include "case/help.h"
#include "case/reader.h"
#include "io/messages.h"
#include "linear/session.h"
#include "run/run_case.h"

namespace tailwater {
namespace {

struct RunArguments {
  RunOptions run;
  std::vector<std::string> overrides;
  std::optional<int> ranks;
  std::string help_case;
  bool quiet = false;
};

void require_possible(int wanted) {
  if (wanted < 1)
    throw InputError(fmt::format("-n {}: a run has at least one rank; remedy: -n 2, or leave -n out", wanted));
  if (const int most = most_ranks_here(); wanted > most) {
    throw InputError(
        fmt::format("-n {}: this machine's cores can share at most {} ranks; remedy: -n {}, or more nodes "
                    "in a batch job",
                    wanted, most, usable_cores()));
  }
  const int started = ranks_in_environment();
  if (started > 0 && wanted != started) {
    throw InputError(
        fmt::format("-n {}: mpirun (or srun) has started {} rank(s) already; remedy: leave -n out", wanted, started));
  }
}

ExitCode execute(const RunArguments& arguments, const Communicator& ranks, const std::vector<std::string>& words) {
  if (!arguments.help_case.empty()) {
    if (ranks.is_root()) fmt::print("{}", arguments.help_case == "markdown" ? case_reference_markdown() : case_help());
    return ExitCode::done;
  }
  if (arguments.run.case_file.empty() || arguments.run.out.empty()) {
    throw InputError("tailwater run needs a case file and --out DIR, as in: tailwater run my.toml --out my_run");
  }
  std::signal(SIGHUP, SIG_IGN);  // the terminal may go; the run need not
  if (ranks.is_root()) {
    set_voice(arguments.quiet ? Voice::quiet : Voice::aloud);
  } else {
    set_voice(Voice::silent);
  }
  if (arguments.ranks) {
    require_possible(*arguments.ranks);
    if (*arguments.ranks > 1 && ranks.is_alone()) return launch_ranks(*arguments.ranks, words, arguments.run.out);
  }
  const CaseSpec spec = read_case(arguments.run.case_file, arguments.overrides);
  std::optional<LinearSession> session;  // several ranks have one already
  if (ranks.is_alone()) session.emplace();
  const ExitCode code = run_case(spec, arguments.run, ranks);
  tell(fmt::format("{}: results in {}", code == ExitCode::done ? "done" : "interrupted", arguments.run.out.string()));
  return code;
}

}  // namespace

void add_run_command(CLI::App& app, ExitCode& code, const Communicator& ranks, const std::vector<std::string>& words) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Run a case");
  command->add_option("case", arguments->run.case_file, "The case file")->type_name("");
  command->add_option("--out", arguments->run.out, "Folder for the results; made by the run")->type_name("DIR");
  command->add_option("--set", arguments->overrides, "Override a key, as in --set scheme.integrator=implicit")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_option("-n", arguments->ranks, "Number of ranks, which this program starts by mpirun; default 1")
      ->type_name("COUNT");
  command->add_flag("--force", arguments->run.force, "Replace the results of an earlier run in the same folder");
  command->add_flag("--quiet", arguments->quiet, "No progress and no warnings");
  command->add_option("--help-case", arguments->help_case, "Explain every key of a case file (text or markdown)")
      ->expected(0, 1)
      ->default_str("text")
      ->check(CLI::IsMember({"text", "markdown"}))
      ->type_name("FORMAT");
  command->footer(
      "Examples: tailwater run my.toml --out my_run\n"
      "          tailwater run my.toml --out my_run -n 8\n"
      "          tailwater run my.toml --out fine --set particles.spacing=0.01 --set scheme.integrator=implicit\n"
      "Writes DIR/case.effective.toml (the case with all its values), DIR/steps.csv, DIR/probes/NAME.csv,\n"
      "DIR/fields/fields.pvd (open it in ParaView) and DIR/summary.json; if the run fails, also DIR/failure/.\n"
      "Ctrl-C, or the file DIR/STOP (touch DIR/STOP), ends a run in order after the present step: what it has written\n"
      "can be used.");
  command->callback([arguments, &code, ranks, words] { code = execute(*arguments, ranks, words); });
}

}  // namespace tailwater
