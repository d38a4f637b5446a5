#include <utility>

#include "app/commands.h"
#include "app/python_package.h"

namespace tailwater {

void add_bench_command(CLI::App& app, ExitCode&) {
  CLI::App* command = app.add_subcommand("bench", "Measure robustness or speed with a set of cases");
  command->require_subcommand(1);
  command->footer(
      "Examples: tailwater bench robustness --list\n"
      "          tailwater bench robustness --out my_bench --gate tank --gate noise\n"
      "          tailwater bench speed --compare before/speed.json");
  const std::pair<const char*, const char*> benches[] = {
      {"robustness", "The gates of the robust core"},
      {"speed", "CPU time and memory of cases, steps and rooms, and how they grow"},
  };
  for (const auto& [name, what] : benches) {
    CLI::App* bench = command->add_subcommand(name, what);
    bench->set_help_flag();  // the bench explains its own options
    bench->prefix_command();
    bench->callback([bench] { become_python("tailwater_validation." + bench->get_name(), bench->remaining()); });
  }
}

}  // namespace tailwater
