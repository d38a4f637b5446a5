#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <regex>
#include <string>

#include "app/commands.h"
#include "io/write_file.h"
#include "templates.h"

namespace tailwater {
namespace {

const std::map<std::string, const char*> templates_by_name{
    {"dam-break", templates::dam_break},
    {"tank", templates::tank},
    {"pier", templates::pier},
    {"channel", templates::channel},
    {"river-reach", templates::river_reach},
    {"weir", templates::weir},
    {"broad-weir", templates::broad_weir},
    {"ogee", templates::ogee},
    {"sluice-gate", templates::sluice_gate},
    {"hydraulic-jump", templates::hydraulic_jump},
    {"backwater", templates::backwater},
    {"circulation", templates::circulation},
    {"run-up", templates::run_up},
    {"wave-flume", templates::wave_flume},
    {"solitary-wave", templates::solitary_wave},
    {"sloshing", templates::sloshing},
    {"floating-box", templates::floating_box},
};

struct NewOptions {
  std::string kind;
  std::filesystem::path file;
  bool force = false;
};

/// The file that a case reads, which its template does not bring; empty if there is none.
std::string file_read_by(const std::string& text) {
  static const std::regex key(R"re((?:^|\n)(?:points_)?file = "([^"]+)")re");
  std::smatch found;
  return std::regex_search(text, found, key) ? found[1].str() : std::string();
}

void write_new_case(const NewOptions& options) {
  if (std::filesystem::exists(options.file) && !options.force) {
    throw InputError(
        fmt::format("'{}' exists and is not overwritten; remedy: another name, or --force", options.file.string()));
  }
  const std::string text = templates_by_name.at(options.kind);
  write_text_file(options.file, text);
  const std::string file = options.file.string();
  const std::string read = file_read_by(text);
  const std::string first =
      read.empty() ? "" : fmt::format("Its first lines say how to make {}, which it reads. ", read);
  fmt::print("Wrote {0}. {2}Next:\n  tailwater check {0}\n  tailwater run {0} --out {1}_run\n", file,
             options.file.stem().string(), first);
}

}  // namespace

void add_new_command(CLI::App& app, ExitCode&) {
  auto options = std::make_shared<NewOptions>();
  CLI::App* command = app.add_subcommand("new", "Start a case file from a template");
  command
      ->add_option(
          "template", options->kind,
          "dam-break (a column collapses in a tank), tank (water at rest), channel (an inlet, a tailwater and a "
          "discharge probe), river-reach (the same over a surveyed bed from a CSV file), weir, broad-weir, ogee, "
          "sluice-gate, hydraulic-jump and backwater (steady flow in a flume), circulation, run-up, pier (3D, a dam "
          "breaks against a pier from an STL file), wave-flume (regular waves, gauges and a damping zone), "
          "solitary-wave, sloshing (a tank that rolls) or floating-box (a body on two lines)")
      ->required()
      ->check(CLI::IsMember(templates_by_name))
      ->type_name("NAME");
  command->add_option("file", options->file, "The case file to write")->required()->type_name("");
  command->add_flag("--force", options->force, "Overwrite the file if it exists");
  command->footer("Example: tailwater new dam-break my.toml");
  command->callback([options] { write_new_case(*options); });
}

}  // namespace tailwater
