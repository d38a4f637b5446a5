#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/sweep_plan.h"
#include "app/sweep_table.h"
#include "base/text.h"
#include "io/run_folder.h"
#include "run/progress.h"
#include "run/provenance.h"

namespace tailwater {
namespace {

void show_program() {
  const nlohmann::ordered_json about = provenance();
  const auto& machine = about["machine"];
  fmt::print("{}\nbuild:     {}, {}\nlibraries: {}\nmachine:   {}, {} ({} cores)\n", version_line(),
             about["compiler"].get<std::string>(), about["options"].get<std::string>(),
             about["libraries"].get<std::string>(), machine["name"].get<std::string>(),
             machine["processor"].get<std::string>(), machine["cores"].get<int>());
}

using Json = nlohmann::ordered_json;

Json read_summary(const std::filesystem::path& run) {
  const std::filesystem::path path = run / "summary.json";
  std::ifstream file(path);
  if (!file) {
    throw IoError(
        fmt::format("cannot read '{}'; is '{}' the folder of a run that has ended?", path.string(), run.string()));
  }
  Json summary = Json::parse(file, nullptr, false);
  if (summary.is_discarded()) throw IoError(fmt::format("'{}' is not valid JSON", path.string()));
  return summary;
}

/// What an engineer wants to know before the numbers of a run are used.
void show_digest(const Json& summary) {
  const auto number = [](const Json& block, const char* key) { return block.at(key).get<double>(); };
  const auto text = [](const Json& block, const char* key) { return printable(block.at(key).get<std::string>()); };
  fmt::print("{}\nstatus:    {}\n", text(summary, "title"), text(summary, "status"));
  if (!text(summary, "message").empty()) fmt::print("message:   {}\n", text(summary, "message"));
  const Json& warnings = summary.at("warnings");
  fmt::print("warnings:  {}\n", warnings.empty() ? "none" : fmt::format("{}", warnings.size()));
  for (const Json& warning : warnings) fmt::print("  {}\n", printable(warning.get<std::string>()));

  // Runs of earlier versions have none.
  if (const auto results = summary.find("results"); results != summary.end()) {
    for (const auto& [probe, result] : results->items()) {
      fmt::print("{:<10} {}\n", printable(probe) + ":", text(result, "words"));
    }
  }
  const Json& time = summary.at("time_s");
  const Json& steps = summary.at("steps");
  fmt::print("time:      {:.6g} of {:.6g} s, {:.0f} steps of {:.3g} s ({:.3g} to {:.3g})\n", number(time, "reached"),
             number(time, "end"), number(steps, "count"), number(steps, "dt_mean_s"), number(steps, "dt_least_s"),
             number(steps, "dt_largest_s"));
  const Json& particles = summary.at("particles");
  fmt::print("particles: {:.0f} fluid, {:.0f} wall, spacing {:g} m\n", number(particles, "fluid"),
             number(particles, "wall"), number(summary, "spacing_m"));
  const Json& water = summary.at("water_balance");
  fmt::print("water:     {:.6g} kg at the start", number(water.at("start"), "mass_kg"));
  for (const char* part : {"in", "inside", "outside", "out"}) {
    fmt::print(", {:.6g} {}", number(water.at(part), "mass_kg"), part);
  }
  const Json& energy = summary.at("energy");
  const Json& volume = summary.at("volume");
  fmt::print("\nenergy:    {:.6g} J at the start, {:.6g} J at the end, largest rise {:.2g} J\n",
             number(energy, "start_J"), number(energy, "end_J"), number(energy, "largest_rise_J"));
  fmt::print("density:   error {:.2g} in the mean, {:.2g} rms\n", number(volume, "density_error_mean"),
             number(volume, "density_error_rms"));
  const Json& solver = summary.at("pressure_solver");
  const Json& interventions = summary.at("interventions");
  fmt::print(
      "solver:    {:.3g} iterations per solve, {:.0f} restarted; {:.0f} particles put back from walls, {:.0f} capped "
      "shifts\n",
      number(solver, "iterations_per_solve"), number(interventions, "restarted_solves"),
      number(interventions, "put_back_from_walls"), number(interventions, "capped_shifts"));
  const Json& cost = summary.at("cost");
  fmt::print("cost:      {}, {:.3g} CPU s per simulated s, {:.0f} MB on {:.0f} rank(s)\n",
             readable_duration(number(cost, "wall_clock_s")), number(cost, "cpu_s_per_simulated_s"),
             number(cost, "peak_memory_bytes") / 1e6, number(summary.at("ranks"), "count"));
  fmt::print("program:   tailwater {} (commit {}), {}, on {}\n", text(summary, "version"), text(summary, "commit"),
             text(summary, "libraries"), text(summary.at("machine"), "name"));
}

void show_run(const std::filesystem::path& run, bool as_json) {
  if (is_sweep(run)) {
    if (as_json) {
      throw InputError(fmt::format("--json: '{}' is a sweep; remedy: read {}, or name the folder of one member",
                                   run.string(), (run / sweep_table_name).string()));
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
    show_digest(summary);
  } catch (const Json::exception& error) {
    throw IoError(fmt::format("'{}' is not the summary of a run of this version ({}); remedy: tailwater info {} --json",
                              (run / "summary.json").string(), error.what(), run.string()));
  }
}

}  // namespace

void add_info_command(CLI::App& app, ExitCode&) {
  auto run = std::make_shared<std::filesystem::path>();
  auto as_json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("info", "Tell about this program, or about a finished run");
  command->add_option("run", *run, "Folder of a run or of a sweep; without it: version, libraries, machine")
      ->type_name("");
  command->add_flag("--json", *as_json, "The whole summary, for programs");
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
