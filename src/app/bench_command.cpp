#include "app/commands.h"
#include "app/python_package.h"

namespace tailwater {

void add_bench_command(CLI::App& app, ExitCode&) {
  CLI::App* command = app.add_subcommand("bench", "Run and score a set of cases whose outcome is known");
  command->require_subcommand(1);
  command->footer(
      "Examples: tailwater bench robustness --list\n"
      "          tailwater bench robustness --out my_bench --gate tank --gate noise");
  CLI::App* robustness = command->add_subcommand("robustness", "The gates of the robust core");
  robustness->set_help_flag();  // the bench explains its own options
  robustness->prefix_command();
  robustness->callback([robustness] { become_python("robustness", robustness->remaining()); });
}

}  // namespace tailwater
