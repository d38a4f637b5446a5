#include "results/run_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "base/input_file.h"
#include "base/text.h"
#include "case/reader.h"
#include "io/folder_lock.h"
#include "io/run_folder.h"
#include "results/measurements.h"
#include "results/progress.h"

namespace tailwater {
namespace {

namespace fs = std::filesystem;

double number_of(const Json& block, const char* key) { return block.at(key).get<double>(); }
std::string text_of_key(const Json& block, const char* key) { return printable(block.at(key).get<std::string>()); }

/// Text behind a unit: in 2D all is per metre of width. Summaries of earlier programs do not contain the dimension.
std::string_view per_metre(const Json& summary) { return summary.value("dimension", 3) == 2 ? " per m" : ""; }

/// Name of the line of the balance.
std::string name_of_balance(const Json& summary) { return summary.contains("liquid") ? "mass" : "water"; }

std::string water_line(const Json& summary) {
  const Json& water = summary.at("water_balance");
  std::string line =
      fmt::format("{:.6g} kg{} at the start", number_of(water.at("start"), "mass_kg"), per_metre(summary));
  for (const char* part : {"in", "inside", "outside", "out"}) {
    const std::string_view word = std::string_view(part) == "outside" ? "spilled" : part;
    line += fmt::format(", {:.6g} {}", number_of(water.at(part), "mass_kg"), word);
  }
  return line;
}

/// The lines of a liquid whose viscous forces are solved for, and of each of several liquids.
void append_liquids(const Json& summary, std::vector<InfoLine>& lines) {
  if (const auto liquid = summary.find("liquid"); liquid != summary.end()) {
    lines.push_back(
        {"liquid", fmt::format("{} ({}), viscous forces solved for in {:.0f} iterations in the last step; "
                               "{:.3g} of the volume flowed",
                               text_of_key(*liquid, "name"), text_of_key(*liquid, "rheology"),
                               number_of(*liquid, "viscous_iterations"), number_of(*liquid, "yielded_fraction"))});
  }
  if (const auto liquids = summary.find("liquids"); liquids != summary.end()) {
    for (const Json& each : *liquids) {
      lines.push_back({printable(each.at("name").get<std::string>()),
                       fmt::format("{:.6g} kg{}, {:.2g} of its volume mixed with others", number_of(each, "mass_kg"),
                                   per_metre(summary), number_of(each, "mixed_fraction"))});
    }
  }
}

std::string pockets_in_words(double count, double volume, double pressure, std::string_view per_metre) {
  if (count == 0.0) return "no pocket";
  return fmt::format("{:.0f} pocket{}, {:.4g} m^3{}, {:.4g} Pa in the largest", count, count == 1.0 ? "" : "s", volume,
                     per_metre, pressure);
}

std::string air_line(const Json& air, std::string_view per_metre) {
  double volume = 0.0;
  double largest = 0.0;
  double pressure = 0.0;
  for (const Json& pocket : air.at("now")) {
    const double own = number_of(pocket, "volume_m3");
    volume += own;
    if (own > largest) pressure = number_of(pocket, "pressure_Pa");
    largest = std::max(largest, own);
  }
  std::string line =
      fmt::format("{}; {:.0f} begun, {:.0f} ended, which lost {:.4g} m^3{} of gas",
                  pockets_in_words(static_cast<double>(air.at("now").size()), volume, pressure, per_metre),
                  number_of(air, "begun"), number_of(air, "ended"), number_of(air, "gas_lost_m3"), per_metre);
  const double vented = air.value("gas_vented_m3", 0.0);
  if (vented != 0.0) {
    line +=
        fmt::format("; {:.4g} m^3{} {} through vents", std::abs(vented), per_metre, vented > 0.0 ? "left" : "came in");
  }
  return line;
}

/// Seconds until a running run is done, from its speed since its start; null if that is unknown.
Json time_left(const fs::path& run, const Json& summary, double time, double end) {
  std::error_code error;
  const auto began = fs::last_write_time(run / summary_name, error);
  if (error) return {};
  const std::chrono::duration<double> gone = fs::file_time_type::clock::now() - began;
  const double advance = time - number_of(summary.at("time_s"), "reached");
  if (!(advance > 0.0) || !(gone.count() > 0.0)) return {};
  return std::max(0.0, (end - time) / advance * gone.count());
}

/// The digest of a running run, whose summary is that of its start.
std::vector<InfoLine> live_digest(const Json& summary, const std::map<std::string, double>& step) {
  const auto value = [&](const char* name) {
    const auto found = step.find(name);
    return found == step.end() ? 0.0 : found->second;
  };
  std::vector<InfoLine> lines;
  if (!step.empty()) {
    lines.push_back({"step", fmt::format("{:.0f}, of {:.3g} s", value("step"), value("dt_s"))});
    lines.push_back({"speed", fmt::format("{:.3g} m/s at most", value("speed_max_m_per_s"))});
    lines.push_back({"energy", fmt::format("{:.4g} J{} kinetic, {:.4g} potential", value("kinetic_J"),
                                           per_metre(summary), value("potential_J"))});
    if (step.contains("pockets")) {
      lines.push_back({"air", pockets_in_words(value("pockets"), value("pockets_volume_m3"),
                                               value("pocket_pressure_Pa"), per_metre(summary))});
    }
    lines.push_back({"density", fmt::format("error {:.2g} on average, {:.2g} rms", value("density_error_mean"),
                                            value("density_error_rms"))});
    lines.push_back({"solver", fmt::format("{:.0f} iterations in the last step", value("iterations"))});
    lines.push_back({name_of_balance(summary),
                     fmt::format("{:.6g} kg{} at the start, {:.4g} m^3{} in, {:.4g} out",
                                 number_of(summary.at("water_balance").at("start"), "mass_kg"), per_metre(summary),
                                 value("volume_in_m3"), per_metre(summary), value("volume_out_m3"))});
  }
  const Json& particles = summary.at("particles");
  lines.push_back(
      {"particles", fmt::format("{:.0f} fluid at the start, {:.0f} wall, spacing {:g} m", number_of(particles, "fluid"),
                                number_of(particles, "wall"), number_of(summary, "spacing_m"))});
  lines.push_back({"ranks", fmt::format("{:.0f}", number_of(summary.at("ranks"), "count"))});
  return lines;
}

/// The scores of a running run, from the tables that it has written; empty if these or the case cannot be read.
Json scores_so_far(const fs::path& run) {
  try {
    return json_of(measurement_scores(read_effective_case(run / effective_case_name), run));
  } catch (const UserError&) {
    return Json::array();
  }
}

/// The state as viewers name it. A summary with "running" but without a running process is that of a killed run.
std::string state_of(const std::string& status, bool is_at_work) {
  if (is_at_work) return status == "running" ? "running" : "waiting";  // it has not begun its steps yet
  if (status == "done" || status == "failed") return status;
  return status.empty() ? "waiting" : "stopped";
}

/// The controls of a run: a run that is done can be resumed only with a later end.
Json controls_of(const std::string& state, bool is_at_work) {
  if (is_at_work) return Json::array({"stop", "checkpoint"});
  return state == "done" ? Json::array() : Json::array({"resume"});
}

Json info_from(const fs::path& run, const Json& summary) {
  const bool is_at_work = FolderLock::is_held(run);
  const std::string status = summary.value("status", "");
  const std::string state = state_of(status, is_at_work);
  const bool is_live = status == "running";
  const std::map<std::string, double> step = is_live ? last_step(run) : std::map<std::string, double>();
  const double end = number_of(summary.at("time_s"), "end");
  const double time = step.contains("time_s") ? step.at("time_s") : number_of(summary.at("time_s"), "reached");
  std::vector<InfoLine> lines = is_live ? live_digest(summary, step) : summary_digest(summary);
  if (is_live && !is_at_work) {
    lines.insert(lines.begin(),
                 InfoLine{"status", fmt::format("killed; to continue: tailwater resume {}", run.string())});
  }
  Json shown = Json::array();
  for (const InfoLine& line : lines) shown.push_back({{"label", line.label}, {"text", line.text}});
  return {{"state", state},
          {"time", time},
          {"end", end},
          {"progress", end > 0.0 ? std::min(1.0, time / end) : 0.0},
          {"time_left", state == "running" ? time_left(run, summary, time, end) : Json()},
          {"particles", summary.at("particles").at("fluid")},
          {"lines", std::move(shown)},
          {"warnings", summary.at("warnings")},
          {"measurements", is_live ? scores_so_far(run) : summary.value("measurements", Json::array())},
          {"controls", controls_of(state, is_at_work)}};
}

}  // namespace

std::map<std::string, double> last_step(const fs::path& run) {
  constexpr std::streamoff enough = 4096;
  std::ifstream file = open_input_file(run / "steps.csv");
  std::string head;
  if (!std::getline(file, head)) return {};
  file.seekg(0, std::ios::end);
  const std::streamoff size = file.tellg();
  file.seekg(std::max<std::streamoff>(static_cast<std::streamoff>(head.size()), size - enough));
  const std::string tail(std::istreambuf_iterator<char>(file), {});
  const std::vector<std::string_view> lines = split(tail, '\n');  // text after the last line end is no whole line
  if (lines.size() < 3) return {};
  const std::vector<std::string_view> names = split(head, ',');
  const std::vector<std::string_view> fields = split(lines[lines.size() - 2], ',');
  std::map<std::string, double> values;
  for (std::size_t k = 0; k < std::min(names.size(), fields.size()); ++k) {
    double value = 0.0;
    const char* end = fields[k].data() + fields[k].size();
    if (std::from_chars(fields[k].data(), end, value).ec == std::errc{}) values[std::string(names[k])] = value;
  }
  return values;
}

Json read_summary(const fs::path& run) {
  const fs::path path = run / summary_name;
  std::ifstream file = open_input_file(path);
  if (!file) {
    std::error_code ignored;
    if (fs::exists(run / effective_case_name, ignored)) throw IoError("cannot read '{}'", path.string());
    throw InputError(
        "'{}' is not the folder of a run: it has no {}; remedy: name the folder that a run was given by --out",
        run.string(), summary_name);
  }
  Json summary = Json::parse(file, nullptr, false);
  if (summary.is_discarded()) throw IoError("'{}' is not valid JSON", path.string());
  return summary;
}

std::vector<InfoLine> summary_digest(const Json& summary) {
  std::vector<InfoLine> lines{{"status", text_of_key(summary, "status")}};
  if (!text_of_key(summary, "message").empty()) lines.push_back({"message", text_of_key(summary, "message")});
  const std::size_t count = summary.at("warnings").size();
  std::string warnings = count == 0 ? "none" : fmt::format("{}", count);
  for (const Json& warning : summary.at("warnings"))
    warnings += fmt::format("\n  {}", printable(warning.get<std::string>()));
  lines.push_back({"warnings", warnings});
  if (const auto results = summary.find("results"); results != summary.end()) {  // runs of earlier versions have none
    for (const auto& [probe, result] : results->items())
      lines.push_back({printable(probe), text_of_key(result, "words")});
  }
  if (const auto scores = summary.find("measurements"); scores != summary.end()) {
    for (const Json& score : *scores) lines.push_back({text_of_key(score, "probe"), text_of_key(score, "words")});
  }
  const Json& time = summary.at("time_s");
  const Json& steps = summary.at("steps");
  lines.push_back({"time", fmt::format("{:.6g} of {:.6g} s, {:.0f} steps of {:.3g} s ({:.3g} to {:.3g})",
                                       number_of(time, "reached"), number_of(time, "end"), number_of(steps, "count"),
                                       number_of(steps, "dt_mean_s"), number_of(steps, "dt_least_s"),
                                       number_of(steps, "dt_largest_s"))});
  const Json& particles = summary.at("particles");
  lines.push_back({"particles", fmt::format("{:.0f} fluid, {:.0f} wall, spacing {:g} m", number_of(particles, "fluid"),
                                            number_of(particles, "wall"), number_of(summary, "spacing_m"))});
  lines.push_back({name_of_balance(summary), water_line(summary)});
  if (const auto air = summary.find("pockets"); air != summary.end()) {
    lines.push_back({"air", air_line(*air, per_metre(summary))});
  }
  append_liquids(summary, lines);
  const Json& energy = summary.at("energy");
  lines.push_back({"energy", fmt::format("{:.6g} J{} at the start, {:.6g} at the end, largest rise {:.2g}",
                                         number_of(energy, "start_J"), per_metre(summary), number_of(energy, "end_J"),
                                         number_of(energy, "largest_rise_J"))});
  const Json& volume = summary.at("volume");
  lines.push_back(
      {"density", fmt::format("error {:.2g} on average, {:.2g} rms", number_of(volume, "density_error_mean"),
                              number_of(volume, "density_error_rms"))});
  const Json& solver = summary.at("pressure_solver");
  const Json& interventions = summary.at("interventions");
  lines.push_back(
      {"solver",
       fmt::format("{:.3g} iterations per solve, {:.0f} restarted; {:.0f} moves stopped at walls, {:.0f} capped shifts",
                   number_of(solver, "iterations_per_solve"), number_of(interventions, "restarted_solves"),
                   number_of(interventions, "stopped_at_walls"), number_of(interventions, "capped_shifts"))});
  const Json& cost = summary.at("cost");
  lines.push_back(
      {"cost", fmt::format("{}, {:.3g} CPU s per simulated s, {:.0f} MB on {:.0f} rank(s)",
                           readable_duration(number_of(cost, "wall_clock_s")), number_of(cost, "cpu_s_per_simulated_s"),
                           number_of(cost, "peak_memory_bytes") / 1e6, number_of(summary.at("ranks"), "count"))});
  lines.push_back({"program", fmt::format("tailwater {} (commit {}), {}, on {}", text_of_key(summary, "version"),
                                          text_of_key(summary, "commit"), text_of_key(summary, "libraries"),
                                          text_of_key(summary.at("machine"), "name"))});
  return lines;
}

Json run_info(const fs::path& run) {
  try {
    return info_from(run, read_summary(run));
  } catch (const UserError&) {
  } catch (const Json::exception&) {
  }
  return {{"state", "waiting"},
          {"time", 0.0},
          {"end", nullptr},
          {"progress", 0.0},
          {"time_left", nullptr},
          {"particles", nullptr},
          {"lines", Json::array()},
          {"warnings", Json::array()},
          {"measurements", Json::array()},
          {"controls", Json::array()}};
}

}  // namespace tailwater
