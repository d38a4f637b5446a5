// tailwater: the command line. Data goes to standard output, messages and progress to standard error; exit codes are
// those of ExitCode.
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "app/commands.h"
#include "app/fastest_build.h"
#include "app/ranks.h"
#include "base/fp_traps.h"
#include "base/text.h"
#include "case/nearest_name.h"
#include "io/messages.h"
#include "linear/session.h"
#include "results/provenance.h"
#include "run/run_case.h"

namespace tailwater {
namespace {

/// `text` with line breaks between its words, so that a line has at most `width` characters.
std::string broken_into_lines(std::string_view text, std::size_t width) {
  std::string lines;
  std::size_t length = 0;  // of the last line
  for (const std::string_view word : split(text, ' ')) {
    const bool fits = length + 1 + word.size() <= width;
    if (length > 0) lines += fits ? ' ' : '\n';
    lines += word;
    length = length > 0 && fits ? length + 1 + word.size() : word.size();
  }
  return lines;
}

/// Help for terminals of 80 columns.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() {
    column_width(26);
    label("SUBCOMMAND", "COMMAND");
  }
  /// An option that may be repeated takes one value each time, unlike one with "...".
  std::string make_option_opts(const CLI::Option* option) const override {
    constexpr std::string_view several = " ...";
    std::string text = CLI::Formatter::make_option_opts(option);
    if (!option->get_allow_extra_args() && text.ends_with(several)) text.resize(text.size() - several.size());
    return text;
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    return broken_into_lines(option->get_description(), 80 - get_column_width());
  }
  std::string make_subcommand(const CLI::App* command) const override {
    return fmt::format("  {:<12}{}\n", command->get_name(), command->get_description());
  }
};

/// The error message for a command line that cannot be parsed.
std::string command_line_problem(CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> command = app.get_subcommands();
  const std::vector<std::string> rest = app.remaining();
  const std::vector<std::string> all_rest = app.remaining(true);  // including those of commands
  const auto option = std::ranges::find_if(all_rest, [](const std::string& word) { return word.starts_with('-'); });
  if (option != all_rest.end()) {
    const bool is_before_command = !rest.empty() && *option == rest.front();
    const std::string of_command = command.empty() || is_before_command ? "" : command.front()->get_name() + " ";
    return fmt::format("unknown option \"{}\"; see: tailwater {}--help", *option, of_command);
  }
  if (!command.empty()) {
    return fmt::format("{}; see: tailwater {} --help", error.what(), command.front()->get_name());
  }
  if (rest.empty()) {
    return fmt::format("{}; see: tailwater --help", error.what());
  }
  std::vector<std::string_view> names;
  for (const CLI::App* valid : app.get_subcommands(nullptr)) names.push_back(valid->get_name());
  return fmt::format("unknown command \"{}\"; {}", rest.front(), unknown_name_hint(rest.front(), names));
}

/// Rejects arguments that are no text: no message could show them, and no file of results could contain them.
void require_printable(int argc, char** argv) {
  for (int k = 1; k < argc; ++k) {
    if (is_printable(argv[k])) continue;
    throw InputError(
        "word {} of the command line, \"{}\", has control characters or bytes that are not UTF-8; remedy: write it, or "
        "name the file, in printable characters",
        k, shortened(printable(argv[k]), 200));
  }
}

/// MPI for the whole program if several ranks were started, so that they can end together.
class Ranks {
 public:
  Ranks() {
    const int count = ranks_in_environment();
    if (count <= 1) return;
    session_.emplace();
    communicator_ = Communicator::world();
    MPI_Comm_dup(communicator_.handle(), &meeting_);
    if (communicator_.size() == count) return;
    throw InputError(
        "{} processes were started, but MPI reports {} of them as ranks of one program; remedy: start them with the "
        "mpirun of the MPI of this program, or srun --mpi=pmix",
        count, communicator_.size());
  }
  ~Ranks() {
    if (meeting_ != MPI_COMM_SELF) MPI_Comm_free(&meeting_);
  }
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  const Communicator& communicator() const { return communicator_; }
  MPI_Comm meeting() const { return meeting_; }

 private:
  std::optional<LinearSession> session_;
  Communicator communicator_;
  MPI_Comm meeting_ = MPI_COMM_SELF;
};

/// The outcome if standard output has not taken all data. `error_number` is 0 if it has failed before.
Outcome output_failure(int error_number) {
  if (error_number == EPIPE) return {};  // the reader has closed the pipe
  return {ExitCode::io_failed,
          fmt::format("cannot write to standard output{}",
                      error_number == 0 ? "" : ": " + std::generic_category().message(error_number))};
}

void add_commands(CLI::App& app, int argc, char** argv, ExitCode& code, const Communicator& ranks) {
  add_new_command(app, code);
  add_check_command(app, code);
  add_explain_command(app, code);
  add_migrate_command(app, code);
  add_run_command(app, code, ranks, {argv + 1, argv + argc});
  add_resume_command(app, code, ranks, {argv + 1, argv + argc});
  add_info_command(app, code);
  add_python_commands(app);
  add_view_command(app, code);
  add_help_commands(app);
  for (CLI::App* command : app.get_subcommands(nullptr)) {
    command->group("Commands");
    for (CLI::App* nested : command->get_subcommands(nullptr)) nested->group("Commands");
  }
}

void show_lines(const std::string& text) {
  for (const std::string_view line : lines_of(text)) tell(line);
}

/// Executes the command line.
Outcome execute(int argc, char** argv, const Communicator& ranks) {
  CLI::App app(
      "Tailwater simulates free-surface water flow with incompressible smoothed\n"
      "particle hydrodynamics (ISPH).\n\n"
      "First steps:\n"
      "  tailwater new dam-break my.toml\n"
      "  tailwater check my.toml\n"
      "  tailwater run my.toml --out my_run\n",
      "tailwater");
  app.set_version_flag("--version", version_line());
  app.require_subcommand(1);
  app.formatter(std::make_shared<HelpFormatter>());
  app.footer(
      "Options of a command:  tailwater COMMAND --help\n"
      "Keys of a case file:   tailwater run --help-case\n"
      "Exit codes: 0 done, 2 bad input, 3 the solver failed, 4 a file cannot be read or\n"
      "written, 130 interrupted.");
  ExitCode code = ExitCode::done;
  add_commands(app, argc, argv, code, ranks);

  try {
    require_printable(argc, argv);
    if (argc == 1) {
      if (ranks.is_root()) show_lines(app.help());
      return {ExitCode::bad_input, ""};
    }
    const std::string_view command = argv[1];
    if (!ranks.is_alone() && command != "run" && command != "resume") {
      throw InputError(
          "{} ranks were started, but only `tailwater run` and `resume` use more than one; remedy: tailwater {} "
          "without mpirun",
          ranks.size(), argv[1]);
    }
    app.parse(argc, argv);
    if (std::fflush(stdout) != 0) return output_failure(errno);
    if (std::ferror(stdout) != 0) return output_failure(0);  // MPI detects it too, because it flushes when it ends
  } catch (const CLI::Success& request) {                    // --help and --version
    if (ranks.is_root()) app.exit(request);
  } catch (const CLI::ParseError& error) {
    return {ExitCode::bad_input, command_line_problem(app, error)};
  } catch (const UserError& error) {
    return {error.code(), error.what()};
  } catch (const std::bad_alloc&) {
    return {ExitCode::solver_failed, std::string("out of memory; ") + remedy_for_memory};
  } catch (const std::system_error& error) {
    if (std::ferror(stdout) != 0) return output_failure(error.code().value());
    return {ExitCode::io_failed, error.what()};
  } catch (const std::exception& error) {
    return {ExitCode::solver_failed, error.what()};
  }
  return {code, ""};
}

}  // namespace
}  // namespace tailwater

int main(int argc, char** argv) {
  using namespace tailwater;
  become_fastest_build(argv);
  survive_lost_terminal();
  const char* traps = std::getenv("TAILWATER_FP_TRAPS");
  if (traps != nullptr && std::string_view(traps) == "1") enable_fp_traps();
  try {
    const Ranks ranks;
    return static_cast<int>(
        end_together(ranks.communicator(), ranks.meeting(), execute(argc, argv, ranks.communicator())));
  } catch (const UserError& error) {  // MPI does not start
    return static_cast<int>(
        end_together({}, MPI_COMM_SELF, {error.code(), is_root_in_environment() ? error.what() : ""}));
  }
}
