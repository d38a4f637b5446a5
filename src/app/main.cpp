// tailwater: the command line. Data goes to standard output, messages and progress to standard error; exit codes are
// those of ExitCode.
#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>

#include "app/commands.h"
#include "base/fp_traps.h"
#include "run/provenance.h"

int main(int argc, char** argv) {
  using namespace tailwater;
  const char* traps = std::getenv("TAILWATER_FP_TRAPS");
  if (traps != nullptr && std::string_view(traps) == "1") enable_fp_traps();

  CLI::App app(
      "Tailwater: free-surface water flow by incompressible smoothed particle hydrodynamics.\n"
      "Start with:  tailwater new dam-break my.toml;  tailwater check my.toml;  tailwater run my.toml --out my_run");
  app.set_version_flag("--version", version_line());
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 2 bad input, 3 the solver failed, 4 a file cannot be read or written, 130 interrupted.");
  ExitCode code = ExitCode::done;
  add_new_command(app, code);
  add_check_command(app, code);
  add_run_command(app, code);
  add_info_command(app, code);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::bad_input);
  } catch (const UserError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return static_cast<int>(error.code());
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "error: out of memory; remedy: a larger particles.spacing (see tailwater check)\n");
    return static_cast<int>(ExitCode::solver_failed);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return static_cast<int>(ExitCode::solver_failed);
  }
  return static_cast<int>(code);
}
