#include "app/commands.h"
#include "app/python_package.h"

namespace tailwater {

void add_waves_command(CLI::App& app, ExitCode&) {
  CLI::App* command = app.add_subcommand("waves", "Wave heights, periods, spectra and reflection from a run's gauges");
  command->set_help_flag();  // the Python program explains its own options
  command->prefix_command();
  command->footer("Example: tailwater waves my_run g1 g2 g3 --from 20");
  command->callback([command] { become_python("tailwater_validation.waves", command->remaining()); });
}

}  // namespace tailwater
