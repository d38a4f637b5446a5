// The commands that are programs in Python. Each prints the help of its own options.
#include <array>
#include <string>

#include "app/commands.h"
#include "app/python_package.h"

namespace tailwater {
namespace {

struct PythonCommand {
  const char* name;
  const char* what;
  const char* module;
  const char* example;
};

constexpr std::array<PythonCommand, 2> benches{{
    {"robustness", "Run the robustness suite", "tailwater_validation.robustness", ""},
    {"speed", "Measure CPU time and memory, and their growth", "tailwater_validation.speed", ""},
}};

constexpr std::array<PythonCommand, 9> python_commands{{
    {"validate", "Compare with laboratory data and theory; write a report", "tailwater_validation.validate", ""},
    {"study", "Estimate the uncertainty of results from several spacings", "tailwater.study_command", ""},
    {"refine", "Propose zones of finer particles from a coarse run", "tailwater.refine",
     "Example: tailwater refine my.toml --level 2 --write my_refined.toml"},
    {"report", "Write a dossier of a study or a run that others can check", "tailwater.report_command",
     "Example: tailwater report my_study --answer upstream"},
    {"waves", "Print wave heights, periods and reflection; write spectra", "tailwater.waves",
     "Example: tailwater waves my_run g1 g2 g3 --from 20"},
    {"bed", "Make a wall mesh from surveyed terrain (GeoTIFF, XYZ)", "tailwater.bed",
     "Example: tailwater bed terrain.tif --to bed.stl --box 512000 5401000 512400 5401200 --step 0.5"},
    {"paddle", "Compute wave maker motion from a wave record or a spectrum", "tailwater.paddle",
     "Example: tailwater paddle gauge.csv --to paddle.csv --depth 0.4 --distance 5"},
    {"pictures", "Draw images of a run; in 3D also mesh the water surface", "tailwater.pictures",
     "Example: tailwater pictures my_run --count 12 --from 1 -1 0.5"},
    {"export", "Export a run to VTKHDF, NetCDF and a ParaView state", "tailwater.export_command",
     "Example: tailwater export my_run --vtkhdf water.vtkhdf --netcdf gauges.nc --paraview state.py"},
}};

void add(CLI::App& app, const PythonCommand& python) {
  CLI::App* command = app.add_subcommand(python.name, python.what);
  command->set_help_flag();
  command->prefix_command();
  command->footer(python.example);
  command->callback([command, module = std::string(python.module)] { become_python(module, command->remaining()); });
}

}  // namespace

void add_python_commands(CLI::App& app) {
  CLI::App* bench = app.add_subcommand("bench", "Measure robustness or speed");
  bench->require_subcommand(1);
  bench->footer(
      "Examples: tailwater bench robustness --list\n"
      "          tailwater bench robustness --out my_bench --gate tank --gate noise\n"
      "          tailwater bench speed --compare before/speed.json");
  for (const PythonCommand& command : benches) add(*bench, command);
  for (const PythonCommand& command : python_commands) add(app, command);
}

}  // namespace tailwater
