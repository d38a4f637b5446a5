#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/sweep_plan.h"
#include "app/sweep_table.h"
#include "base/json.h"
#include "base/text.h"
#include "results/provenance.h"
#include "results/run_info.h"

namespace tailwater {
namespace {

void show_program() {
  const Json about = provenance();
  const auto& machine = about["machine"];
  fmt::print("{}\nbuild:     {}, {}\nlibraries: {}\nmachine:   {}, {} ({} cores)\n", version_line(),
             about["compiler"].get<std::string>(), about["options"].get<std::string>(),
             about["libraries"].get<std::string>(), machine["name"].get<std::string>(),
             machine["processor"].get<std::string>(), machine["cores"].get<int>());
}

void print_line(const std::string& label, const std::string& text) { fmt::print("{:<10} {}\n", label + ":", text); }

/// Prints the facts that a user needs before the numbers of a run are used. The summary of a run that goes on, or
/// was killed, is that of its start, so its facts come from its tables.
void show_digest(const std::filesystem::path& run, const Json& summary) {
  fmt::print("{}\n", printable(summary.at("title").get<std::string>()));
  if (summary.value("status", "") != "running") {
    for (const auto& [label, text] : summary_digest(summary)) print_line(label, text);
    return;
  }
  const Json info = run_info(run);
  print_line("time", fmt::format("{:.6g} of {:.6g} s", info["time"].get<double>(), info["end"].get<double>()));
  for (const Json& line : info["lines"]) print_line(line["label"].get<std::string>(), line["text"].get<std::string>());
}

void show_run(const std::filesystem::path& run, bool as_json) {
  if (is_sweep(run)) {
    if (as_json) {
      throw InputError("--json: '{}' is a sweep; remedy: read {}, or name the folder of one member", run.string(),
                       (run / sweep_table_name).string());
    }
    fmt::print("{}", sweep_digest(run, read_sweep_record(run)));
    return;
  }
  const Json summary = read_summary(run);
  if (as_json) {
    fmt::print("{}\n", summary.dump(2));
    return;
  }
  try {
    show_digest(run, summary);
  } catch (const Json::exception& error) {
    throw IoError("'{}' is not the summary of a run of this version ({}); remedy: tailwater info {} --json",
                  (run / "summary.json").string(), error.what(), run.string());
  }
}

}  // namespace

void add_info_command(CLI::App& app, ExitCode&) {
  auto run = std::make_shared<std::filesystem::path>();
  auto as_json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("info", "Print the results of a run, or the version of this program");
  command
      ->add_option("run", *run,
                   "Folder of a run or a sweep. Without it, version, build, libraries and machine are printed.")
      ->type_name("");
  command->add_flag("--json", *as_json, "Print the complete summary of the run as JSON");
  command->footer("Examples: tailwater info\n          tailwater info my_run\n          tailwater info my_run --json");
  command->callback([run, as_json] {
    if (run->empty()) {
      show_program();
    } else {
      show_run(*run, *as_json);
    }
  });
}

}  // namespace tailwater
