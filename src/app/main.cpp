// tailwater: the command line. Data goes to standard output, messages and progress to standard error; exit codes are
// those of ExitCode.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands.h"
#include "base/fp_traps.h"
#include "case/nearest_name.h"
#include "run/provenance.h"

namespace tailwater {
namespace {

/// "error: " before every line: a case may have several problems, one line each.
void show_error(std::string_view message) {
  for (std::size_t start = 0; start < message.size();) {
    const std::size_t end = std::min(message.find('\n', start), message.size());
    fmt::print(stderr, "error: {}\n", message.substr(start, end - start));
    start = end + 1;
  }
}

/// What is wrong with the command line, in the words of this program.
std::string command_line_problem(CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> command = app.get_subcommands();
  const std::vector<std::string> rest = app.remaining();
  if (!command.empty()) {
    return fmt::format("{}; see: tailwater {} --help", error.what(), command.front()->get_name());
  }
  if (rest.empty() || rest.front().starts_with('-')) {
    return fmt::format("{}; see: tailwater --help", error.what());
  }
  std::vector<std::string_view> names;
  for (const CLI::App* valid : app.get_subcommands(nullptr)) names.push_back(valid->get_name());
  return fmt::format("unknown command \"{}\"; {}", rest.front(), unknown_name_hint(rest.front(), names));
}

}  // namespace
}  // namespace tailwater

int main(int argc, char** argv) {
  using namespace tailwater;
  const char* traps = std::getenv("TAILWATER_FP_TRAPS");
  if (traps != nullptr && std::string_view(traps) == "1") enable_fp_traps();

  CLI::App app(
      "Tailwater: free-surface water flow by incompressible smoothed particle hydrodynamics.\n\n"
      "Start with:\n"
      "  tailwater new dam-break my.toml\n"
      "  tailwater check my.toml\n"
      "  tailwater run my.toml --out my_run\n",
      "tailwater");
  app.set_version_flag("--version", version_line());
  app.require_subcommand(1);
  app.footer(
      "`tailwater COMMAND --help` tells more. All keys of a case file: tailwater run --help-case\n"
      "Exit codes: 0 done, 2 bad input, 3 the solver failed, 4 a file cannot be read or written, 130 interrupted.");
  ExitCode code = ExitCode::done;
  add_new_command(app, code);
  add_check_command(app, code);
  add_run_command(app, code);
  add_info_command(app, code);
  add_bench_command(app, code);
  add_validate_command(app, code);

  if (argc == 1) {
    fmt::print(stderr, "{}", app.help());
    return static_cast<int>(ExitCode::bad_input);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help and --version
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    show_error(command_line_problem(app, error));
    return static_cast<int>(ExitCode::bad_input);
  } catch (const UserError& error) {
    show_error(error.what());
    return static_cast<int>(error.code());
  } catch (const std::bad_alloc&) {
    show_error("out of memory; remedy: a larger particles.spacing (see: tailwater check)");
    return static_cast<int>(ExitCode::solver_failed);
  } catch (const std::exception& error) {
    show_error(error.what());
    return static_cast<int>(ExitCode::solver_failed);
  }
  return static_cast<int>(code);
}
