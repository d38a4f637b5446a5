#include "app/commands.h"
#include "app/python_package.h"

namespace tailwater {

void add_bed_command(CLI::App& app, ExitCode&) {
  CLI::App* command = app.add_subcommand("bed", "Make the mesh of a wall from a surveyed terrain, GeoTIFF or XYZ");
  command->set_help_flag();  // the Python program explains its own options
  command->prefix_command();
  command->footer("Example: tailwater bed terrain.tif --to bed.stl --box 512000 5401000 512400 5401200 --step 0.5");
  command->callback([command] { become_python("tailwater_validation.bed", command->remaining()); });
}

}  // namespace tailwater
