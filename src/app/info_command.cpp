#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "io/run_folder.h"
#include "run/provenance.h"

namespace tailwater {
namespace {

void show_program() {
  const nlohmann::ordered_json about = provenance();
  const auto& machine = about["machine"];
  fmt::print("{}\nlibraries: {}\nmachine:   {}, {} ({} cores)\n", version_line(), about["libraries"].get<std::string>(),
             machine["name"].get<std::string>(), machine["processor"].get<std::string>(), machine["cores"].get<int>());
}

void show_run(const std::filesystem::path& run) {
  const std::filesystem::path path = run / "summary.json";
  std::ifstream file(path);
  if (!file) {
    throw IoError(
        fmt::format("cannot read '{}'; is '{}' the folder of a run that has ended?", path.string(), run.string()));
  }
  const auto summary = nlohmann::ordered_json::parse(file, nullptr, false);
  if (summary.is_discarded()) throw IoError(fmt::format("'{}' is not valid JSON", path.string()));
  fmt::print("{}\n", summary.dump(2));
}

}  // namespace

void add_info_command(CLI::App& app, ExitCode&) {
  auto run = std::make_shared<std::filesystem::path>();
  CLI::App* command = app.add_subcommand("info", "Tell about this program, or about a finished run");
  command->add_option("run", *run, "Folder of a run; without it: version, libraries, machine")->type_name("");
  command->footer("Examples: tailwater info\n          tailwater info my_run");
  command->callback([run] {
    if (run->empty()) {
      show_program();
    } else {
      show_run(*run);
    }
  });
}

}  // namespace tailwater
