#include "app/commands.h"
#include "app/python_package.h"

namespace tailwater {

void add_study_command(CLI::App& app, ExitCode&) {
  CLI::App* command =
      app.add_subcommand("study", "Run a case at several spacings, and say how well its numbers are known");
  command->set_help_flag();  // the Python program explains its own options
  command->prefix_command();
  command->callback([command] { become_python("tailwater.study_command", command->remaining()); });
}

}  // namespace tailwater
