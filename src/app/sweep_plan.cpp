#include "app/sweep_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/input_file.h"
#include "base/json.h"
#include "case/overrides.h"
#include "case/reader.h"
#include "case/toml_text.h"
#include "geometry/from_spec.h"
#include "io/write_file.h"
#include "probes/probe_set.h"
#include "results/provenance.h"
#include "run/run_case.h"

namespace tailwater {
namespace {

/// Maximum number of folders in one folder; more is a mistake in the values.
constexpr std::size_t max_members = 1000;

/// Bytes in the name of a member's folder; file systems allow 255.
constexpr std::size_t longest_folder_name = 200;

constexpr int sweep_record_format = 1;

constexpr std::string_view sweep_usage =
    "write --sweep table.key=value,value, as in --sweep particles.spacing=0.02,0.01";

SweepKey parse_sweep_key(const std::string& option) {
  const std::size_t equals = option.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError("--sweep {}: a key or its values are missing; {}", option, sweep_usage);
  }
  SweepKey key{std::string(without_spaces(option.substr(0, equals))), split_at_commas(option.substr(equals + 1))};
  std::set<std::string> seen;
  for (const std::string& value : key.values) {
    if (value.empty()) throw InputError("--sweep {}: a value is missing; {}", option, sweep_usage);
    if (!seen.insert(value).second) {
      throw InputError("--sweep {}: the value {} is given twice; remedy: give each value once", option, value);
    }
  }
  return key;
}

std::string override_text(const std::string& key, const std::string& value) { return fmt::format("{}={}", key, value); }

/// "particles.spacing=0.02_scheme.integrator=implicit"; special characters of shells and file systems become "_".
std::string folder_name(const std::vector<std::string>& keys, const std::vector<std::string>& values) {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < keys.size(); ++k) parts.push_back(override_text(keys[k], values[k]));
  std::string name = fmt::format("{}", fmt::join(parts, "_")).substr(0, longest_folder_name);
  constexpr std::string_view harmless = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.=+-_";
  for (char& c : name) {
    if (harmless.find(c) == std::string_view::npos) c = '_';
  }
  return name;
}

template <int Dim>
void require_sound_probes(const CaseSpec& spec) {
  make_probes<Dim>(spec, make_boundary<Dim>(spec));
}

CaseSpec read_member(const std::filesystem::path& case_file, const std::vector<std::string>& overrides) {
  CaseSpec spec = read_case(case_file, overrides);
  with_places(spec, [&] {
    require_sound_geometry(spec, {}, CaseWarnings::left_out);
    if (spec.general.dimension == 2) {
      require_sound_probes<2>(spec);
    } else {
      require_sound_probes<3>(spec);
    }
  });
  return spec;
}

/// A finding about a member's case with the option of the command line that causes it, or else with the member.
std::string line_of_sweep(const Finding& finding, const std::vector<std::string>& swept, const std::string& folder) {
  for (const std::string& text : swept) {
    if (finding.position.file != fmt::format("{}{}", override_prefix, text)) continue;
    return fmt::format("--sweep {}: {}", text, finding.message());
  }
  return fmt::format("{} (with {})", finding.line(), folder);
}

}  // namespace

SweepPlan sweep_plan(const std::vector<std::string>& options) {
  std::vector<SweepKey> keys;
  std::size_t count = 1;
  for (const std::string& option : options) {
    SweepKey key = parse_sweep_key(option);
    for (const SweepKey& other : keys) {
      if (other.key != key.key) continue;
      throw InputError("--sweep {}: the key is swept twice; remedy: give all its values in one --sweep", option);
    }
    count *= key.values.size();
    if (count > max_members) {
      throw InputError("--sweep {}: makes more than {} members; remedy: fewer values", option, max_members);
    }
    keys.push_back(std::move(key));
  }
  SweepPlan plan;
  for (const SweepKey& key : keys) plan.keys.push_back(key.key);
  std::set<std::string> folders;
  for (std::size_t number = 0; number < count; ++number) {
    SweepMember member;
    std::size_t rest = number;
    member.values.resize(keys.size());
    for (std::size_t k = keys.size(); k-- > 0;) {  // the last key's values change first
      const std::vector<std::string>& values = keys[k].values;
      member.values[k] = values[rest % values.size()];
      rest /= values.size();
    }
    member.folder = folder_name(plan.keys, member.values);
    while (!folders.insert(member.folder).second) member.folder += "_";
    plan.members.push_back(std::move(member));
  }
  return plan;
}

std::vector<CaseSpec> cases_of_sweep(const std::filesystem::path& case_file, const std::vector<std::string>& overrides,
                                     const SweepPlan& plan) {
  std::vector<CaseSpec> cases;
  std::vector<std::string> problems;
  for (const SweepMember& member : plan.members) {
    std::vector<std::string> swept;
    for (std::size_t k = 0; k < plan.keys.size(); ++k) swept.push_back(override_text(plan.keys[k], member.values[k]));
    std::vector<std::string> all = overrides;
    all.insert(all.end(), swept.begin(), swept.end());
    try {
      cases.push_back(read_member(case_file, all));
    } catch (const CaseError& error) {
      for (const Finding& finding : error.findings()) {
        const std::string line = line_of_sweep(finding, swept, member.folder);
        if (std::find(problems.begin(), problems.end(), line) == problems.end()) problems.push_back(line);
      }
    }
  }
  if (!problems.empty()) throw InputError("{}", fmt::join(problems, "\n"));
  return cases;
}

bool is_sweep(const std::filesystem::path& folder) {
  std::error_code error;
  return std::filesystem::exists(folder / sweep_record_name, error);
}

SweepPlan read_sweep_record(const std::filesystem::path& folder) {
  constexpr std::string_view remedy = "remedy: begin the sweep in another folder";
  const std::filesystem::path path = folder / sweep_record_name;
  std::ifstream file = open_input_file(path);
  if (!file) throw IoError("cannot read '{}'", path.string());
  try {
    const Json record = Json::parse(file);
    if (record.at("format") != sweep_record_format) {
      throw IoError("'{}' has format {}, and this program reads format {}; remedy: use {}", path.string(),
                    record.at("format").dump(), sweep_record_format, record.value("program", "another"));
    }
    SweepPlan plan;
    record.at("keys").get_to(plan.keys);
    for (const Json& member : record.at("members")) {
      plan.members.push_back({member.at("folder"), member.at("values")});
      if (plan.members.back().values.size() == plan.keys.size()) continue;
      throw IoError("'{}': a member has not as many values as there are keys; {}", path.string(), remedy);
    }
    return plan;
  } catch (const Json::exception& error) {
    throw IoError("'{}' is not the record of a sweep: {}; {}", path.string(), error.what(), remedy);
  }
}

void write_sweep_record(const std::filesystem::path& folder, const SweepPlan& plan) {
  Json members = Json::array();
  for (const SweepMember& member : plan.members) {
    members.push_back({{"folder", member.folder}, {"values", member.values}});
  }
  const Json record = {
      {"format", sweep_record_format}, {"program", version_line()}, {"keys", plan.keys}, {"members", members}};
  write_text_file(folder / sweep_record_name, record.dump(2) + "\n");
}

}  // namespace tailwater
