#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "app/case_templates.h"
#include "app/commands.h"
#include "app/files_of_others.h"
#include "base/input_file.h"
#include "io/write_file.h"
#include "templates.h"

namespace tailwater {
namespace {

const std::map<std::string, const char*> templates_by_name{
    {"dam-break", templates::dam_break},
    {"dam-break-box", templates::dam_break_box},
    {"tank", templates::tank},
    {"pier", templates::pier},
    {"channel", templates::channel},
    {"river-reach", templates::river_reach},
    {"weir", templates::weir},
    {"broad-weir", templates::broad_weir},
    {"ogee", templates::ogee},
    {"spillway", templates::spillway},
    {"sluice-gate", templates::sluice_gate},
    {"hydraulic-jump", templates::hydraulic_jump},
    {"backwater", templates::backwater},
    {"circulation", templates::circulation},
    {"run-up", templates::run_up},
    {"shore", templates::shore},
    {"wave-flume", templates::wave_flume},
    {"rubble-mound", templates::rubble_mound},
    {"tailings", templates::tailings},
    {"debris-flow", templates::debris_flow},
    {"concrete-slump", templates::concrete_slump},
    {"lock-exchange", templates::lock_exchange},
    {"solitary-wave", templates::solitary_wave},
    {"sloshing", templates::sloshing},
    {"floating-box", templates::floating_box},
};

/// The files that a template reads, which are written beside it: name and content.
const std::map<std::string, std::pair<std::string, const char*>> files_read_by_template{
    {"pier", {"pier.obj", templates::pier_obj}},
    {"river-reach", {"bed.csv", templates::bed_csv}},
};

struct NewOptions {
  std::string kind;
  std::filesystem::path file;
  bool force = false;
};

/// Refuses to replace an existing file, unless it belongs to this user and `force` is given.
void require_place(const std::filesystem::path& file, bool force) {
  const std::filesystem::file_status status = std::filesystem::symlink_status(file);
  if (!std::filesystem::exists(status)) return;
  require_own_regular_file(file);
  if (force) return;
  throw InputError("'{}' exists and is not overwritten; remedy: choose another name, or add --force", file.string());
}

bool holds(const std::filesystem::path& file, std::string_view text) {
  std::ifstream stream = open_input_file(file);
  return std::string(std::istreambuf_iterator<char>(stream), {}) == text;
}

void write_new_case(const NewOptions& options) {
  require_place(options.file, options.force);
  const auto read = files_read_by_template.find(options.kind);
  std::string beside;
  if (read != files_read_by_template.end()) {
    const auto& [name, text] = read->second;
    const std::filesystem::path file = options.file.parent_path() / name;
    if (!holds(file, text)) {
      require_place(file, options.force);
      write_text_file(file, text);
    }
    beside = fmt::format(" and {}, which it reads", file.string());
  }
  write_text_file(options.file, templates_by_name.at(options.kind));
  fmt::print("Wrote {0}{1}. Next:\n  tailwater check {0}\n  tailwater run {0} --out {2}_run\n", options.file.string(),
             beside, options.file.stem().string());
}

}  // namespace

const std::map<std::string, const char*>& case_templates() { return templates_by_name; }

void add_new_command(CLI::App& app, ExitCode&) {
  auto options = std::make_shared<NewOptions>();
  CLI::App* command = app.add_subcommand("new", "Write a case file from a template");
  command->add_option("template", options->kind, "Name of the template")
      ->required()
      ->check(CLI::IsMember(templates_by_name).description(""))
      ->type_name("NAME");
  command->add_option("file", options->file, "Case file to write")->required()->type_name("");
  command->add_flag("--force", options->force, "Overwrite an existing file");
  command->footer(
      "Example: tailwater new dam-break my.toml\n\n"
      "Templates:\n"
      "  dam-break       a water column collapses onto a dry bed\n"
      "  dam-break-box   the column hits a box, with fine particles around it\n"
      "  tank            water at rest\n"
      "  channel         uniform flow with inlet, tailwater and a discharge probe\n"
      "  river-reach     flow over a surveyed bed from a CSV file\n"
      "  weir            sharp-crested weir\n"
      "  broad-weir      broad-crested weir\n"
      "  ogee            ogee crest at its design head\n"
      "  spillway        3D notch in a dam, with fine particles at the notch\n"
      "  sluice-gate     flow under a sluice gate\n"
      "  hydraulic-jump  hydraulic jump against a tailwater\n"
      "  backwater       backwater in a sloping channel with rough side walls\n"
      "  circulation     long channel; outflow re-enters at the inlet\n"
      "  run-up          solitary wave on a plane beach\n"
      "  shore           solitary wave on a beach, with fine particles at the shore\n"
      "  pier            3D dam break against a pier from a mesh file\n"
      "  wave-flume      regular waves, wave gauges and a damping zone\n"
      "  rubble-mound    regular waves on a porous breakwater of two layers\n"
      "  tailings        tailings run out over a slope until they stop\n"
      "  debris-flow     debris runs down a slope and stops on the fan before it\n"
      "  concrete-slump  3D slump of fresh concrete whose mould is lifted\n"
      "  lock-exchange   brine flows under fresh water, two liquids\n"
      "  solitary-wave   solitary wave from a piston\n"
      "  sloshing        water in a rolling tank\n"
      "  floating-box    floating body on two mooring lines");
  command->callback([options] { write_new_case(*options); });
}

}  // namespace tailwater
