#include "app/commands.h"
#include "app/python_package.h"

namespace tailwater {

void add_validate_command(CLI::App& app, ExitCode&) {
  CLI::App* command =
      app.add_subcommand("validate", "Run the papers' cases and the exact solutions, and write a report of the scores");
  command->set_help_flag();  // the Python program explains its own options
  command->prefix_command();
  command->callback([command] { become_python("tailwater_validation.validate", command->remaining()); });
}

}  // namespace tailwater
