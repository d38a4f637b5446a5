#include "app/sweep_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "base/input_file.h"
#include "base/json.h"
#include "io/run_folder.h"

namespace tailwater {
namespace {

struct TableColumn {
  const char* name;
  const char* place;  ///< in summary.json, or in a measurement of it
};

constexpr std::array<TableColumn, 26> summary_columns{{
    {"time_reached_s", "/time_s/reached"},
    {"time_end_s", "/time_s/end"},
    {"steps", "/steps/count"},
    {"dt_mean_s", "/steps/dt_mean_s"},
    {"fluid_particles", "/particles/fluid"},
    {"wall_particles", "/particles/wall"},
    {"ranks", "/ranks/count"},
    {"wall_clock_s", "/cost/wall_clock_s"},
    {"cpu_s", "/cost/cpu_s"},
    {"cpu_s_per_simulated_s", "/cost/cpu_s_per_simulated_s"},
    {"peak_memory_bytes", "/cost/peak_memory_bytes"},
    {"iterations_per_solve", "/pressure_solver/iterations_per_solve"},
    {"energy_start_J", "/energy/start_J"},
    {"energy_end_J", "/energy/end_J"},
    {"energy_largest_rise_J", "/energy/largest_rise_J"},
    {"energy_largest_rise_over_start", "/energy/largest_rise_over_start"},
    {"density_error_mean", "/volume/density_error_mean"},
    {"density_error_rms", "/volume/density_error_rms"},
    {"mass_start_kg", "/water_balance/start/mass_kg"},
    {"mass_in_kg", "/water_balance/in/mass_kg"},
    {"mass_inside_kg", "/water_balance/inside/mass_kg"},
    {"mass_outside_kg", "/water_balance/outside/mass_kg"},
    {"mass_out_kg", "/water_balance/out/mass_kg"},
    {"stopped_at_walls", "/interventions/stopped_at_walls"},
    {"capped_shifts", "/interventions/capped_shifts"},
    {"restarted_solves", "/interventions/restarted_solves"},
}};

/// The summary of a member; empty if there is none or it cannot be read.
Json summary_of(const std::filesystem::path& member) {
  std::ifstream file = open_input_file(member / summary_name);
  Json summary = Json::parse(file, nullptr, false);
  return summary.is_object() ? summary : Json::object();
}

std::string quoted_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string status_of(const Json& summary, const MemberNews& news) {
  if (news.is_running) return "running";
  const std::string status = summary.value("status", "waiting");
  if (status == "running") return "killed";  // no process is running
  const bool has_failed_before_its_summary = news.exit_code.value_or(0) == 2 || news.exit_code.value_or(0) == 4;
  return status != "done" && has_failed_before_its_summary ? "failed" : status;
}

/// A number of the summary as the table shows it; empty where there is none.
std::string number_at(const Json& summary, const char* place) {
  const Json::json_pointer pointer(place);
  return summary.contains(pointer) && summary.at(pointer).is_number() ? summary.at(pointer).dump() : "";
}

/// The scores of a member's run: for each measurement its name in the table and its numbers.
using Scores = std::map<std::string, Json>;

/// Keys are "PROBE_COLUMN", for a second file of both "PROBE_COLUMN_2".
Scores scores_of(const Json& summary) {
  Scores scores;
  for (const Json& score : summary.value("measurements", Json::array())) {
    const std::string name = score.value("probe", "") + "_" + score.value("column", "");
    std::string own = name;
    for (int k = 2; scores.contains(own); ++k) own = fmt::format("{}_{}", name, k);
    scores[own] = score;
  }
  return scores;
}

constexpr std::array<TableColumn, 5> score_columns{{{"rms", "/rms"},
                                                    {"bias", "/bias"},
                                                    {"best_shift_s", "/best_shift_s"},
                                                    {"shifted_rms", "/shifted/rms"},
                                                    {"is_inside", "/is_inside"}}};

/// See number_at; a boolean is shown as 0 or 1.
std::string score_at(const Scores& scores, const std::string& name, const char* place) {
  const auto found = scores.find(name);
  if (found == scores.end()) return "";
  const Json::json_pointer pointer(place);
  if (found->second.contains(pointer) && found->second.at(pointer).is_boolean()) {
    return found->second.at(pointer).get<bool>() ? "1" : "0";
  }
  return number_at(found->second, place);
}

/// The names of all measurements of all members, in their order.
std::set<std::string> measured_in(const std::vector<Json>& summaries) {
  std::set<std::string> names;
  for (const Json& summary : summaries) {
    for (const auto& [name, score] : scores_of(summary)) names.insert(name);
  }
  return names;
}

}  // namespace

std::string member_status(const std::filesystem::path& member, const MemberNews& news) {
  return status_of(summary_of(member), news);
}

std::string sweep_table(const std::filesystem::path& sweep, const SweepPlan& plan,
                        const std::vector<MemberNews>& news) {
  std::vector<std::string> names{"member"};
  for (const std::string& key : plan.keys) names.push_back(quoted_field(key));
  names.insert(names.end(), {"status", "exit_code"});
  for (const TableColumn& column : summary_columns) names.emplace_back(column.name);
  std::vector<Json> summaries;
  for (const SweepMember& member : plan.members) summaries.push_back(summary_of(sweep / member.folder));
  const std::set<std::string> measured = measured_in(summaries);
  for (const std::string& name : measured) {
    for (const TableColumn& column : score_columns) names.push_back(quoted_field(name + "_" + column.name));
  }
  names.insert(names.end(), {"warnings", "message"});
  std::string table = fmt::format("{}\n", fmt::join(names, ","));
  for (std::size_t m = 0; m < plan.members.size(); ++m) {
    const SweepMember& member = plan.members[m];
    Json& summary = summaries[m];
    const std::string status = status_of(summary, news[m]);
    if (status == "running") summary = Json::object();  // that of its start, or of an earlier part
    std::vector<std::string> fields{quoted_field(member.folder)};
    for (const std::string& value : member.values) fields.push_back(quoted_field(value));
    fields.push_back(status);
    fields.push_back(news[m].exit_code ? std::to_string(*news[m].exit_code) : number_at(summary, "/exit_code"));
    for (const TableColumn& column : summary_columns) fields.push_back(number_at(summary, column.place));
    const Scores scores = scores_of(summary);
    for (const std::string& name : measured) {
      for (const TableColumn& column : score_columns) fields.push_back(score_at(scores, name, column.place));
    }
    fields.push_back(summary.contains("warnings") ? std::to_string(summary["warnings"].size()) : "");
    const bool has_message = status == "failed";
    const std::string message = summary.value("message", "");
    fields.push_back(has_message ? quoted_field(message.empty() ? news[m].message : message) : "");
    table += fmt::format("{}\n", fmt::join(fields, ","));
  }
  return table;
}

std::string sweep_digest(const std::filesystem::path& sweep, const SweepPlan& plan) {
  std::string text = fmt::format("{:12}  {:>12}  {:>8}  {:>10}  {:>12}  {:>13}  {}\n", "status", "time reached",
                                 "steps", "CPU s", "energy rise", "density error", "member");
  for (const SweepMember& member : plan.members) {
    const Json summary = summary_of(sweep / member.folder);
    const auto number = [&](const char* place) {
      const Json::json_pointer pointer(place);
      return summary.contains(pointer) ? fmt::format("{:.4g}", summary.at(pointer).get<double>()) : "";
    };
    text += fmt::format("{:12}  {:>12}  {:>8}  {:>10}  {:>12}  {:>13}  {}\n", status_of(summary, {}),
                        number("/time_s/reached"), number("/steps/count"), number("/cost/cpu_s"),
                        number("/energy/largest_rise_over_start"), number("/volume/density_error_rms"), member.folder);
  }
  return text;
}

}  // namespace tailwater
