#include "case/measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "case/nearest_name.h"
#include "case/probe_columns.h"
#include "case_files/linked_files.h"

namespace tailwater {
namespace {

/// Times whose relative difference is no larger are equal, because files contain a limited number of digits.
constexpr double same_time = 1e-4;

/// Reports problems with `key` of measurement k; if the key is not given, at its table.
class Reporter {
 public:
  Reporter(std::size_t k, const toml::table& root, Problems& problems) : k_(k), root_(root), problems_(problems) {}

  void wrong(MessageId id, const char* key, const std::string& message) const {
    const CaseLabel label = CaseLabel("measurement", k_).with_key(key);
    const toml::node* node = root_["measurement"][k_][key].node();
    if (node == nullptr) {
      problems_.add(id, &root_["measurement"][k_].node()->source(), label, fmt::format("{}: {}", label, message));
    } else {
      problems_.wrong(id, label, *node, message);
    }
  }

 private:
  std::size_t k_;
  const toml::table& root_;
  Problems& problems_;
};

template <class Tables, class Name>
std::vector<std::string_view> names_in(const Tables& tables, Name name) {
  std::vector<std::string_view> names;
  for (const auto& table : tables) names.push_back(table.*name);
  return names;
}

void read(MeasurementTable& measurement, const CaseSpec& spec, const Reporter& reporter) {
  const auto probe = std::ranges::find(spec.probes, measurement.probe, &ProbeTable::name);
  if (probe == spec.probes.end()) {
    reporter.wrong("measurement-probe-unknown", "probe",
                   fmt::format("there is no such probe; {}",
                               unknown_name_hint(measurement.probe, names_in(spec.probes, &ProbeTable::name))));
    return;
  }
  const std::vector<OutputColumn> columns = comparable_columns(*probe, spec.general.dimension);
  if (columns.empty()) {
    reporter.wrong("measurement-of-probe-type", "probe",
                   fmt::format("a {} probe{} cannot be compared with measured values; give a probe of another "
                               "type, such as \"depth\" or \"velocity\"",
                               name_of(probe->type), spec.general.dimension == 3 ? " in 3D" : ""));
    return;
  }
  if (measurement.column.empty()) measurement.column = columns.front().name;
  const auto column = std::ranges::find(columns, measurement.column, &OutputColumn::name);
  if (column == columns.end()) {
    reporter.wrong("measurement-column", "column",
                   fmt::format("a {} probe has no such column; {}", name_of(probe->type),
                               unknown_name_hint(measurement.column, names_in(columns, &OutputColumn::name))));
    return;
  }
  try {
    measurement.series = read_measured_series(
        measurement.file, std::array<std::string_view, 2>{probe->name, column->name}, column->measure,
        probe->type == ProbeType::profile ? Samples::of_profiles : Samples::of_one_place);
  } catch (const UserError& error) {
    reporter.wrong("linked-file", "file", error.what());
    return;
  }
  // A measurement that begins after the end of the run is allowed, because the run may have been shortened.
  if (measurement.series.time.back() <= 0.0) {
    reporter.wrong(
        "measurement-before-run", "file",
        fmt::format(
            "{} ends at t = {:.9g} s, where the run begins; shift its times so that t = 0 is the start of the run",
            measurement.file, measurement.series.time.back()));
  }
  if (probe->type != ProbeType::profile) return;
  const auto is_taken = [&](double time) {
    return time < 0.0 || std::ranges::any_of(probe->times, [&](double taken) {
             return std::abs(taken - time) <= same_time * std::abs(time);
           });
  };
  const auto missing = std::ranges::find_if_not(measurement.series.time, is_taken);
  if (missing == measurement.series.time.end()) return;
  reporter.wrong(
      "measurement-off-times", "file",
      fmt::format("{} has values at t = {:.9g} s, but probe \"{}\" takes no profile then; add this time to its times",
                  measurement.file, *missing, probe->name));
}

}  // namespace

void read_measurements(CaseSpec& spec, const toml::table& root, Problems& problems) {
  for (std::size_t k = 0; k < spec.measurements.size(); ++k) {
    read(spec.measurements[k], spec, Reporter(k, root, problems));
  }
}

}  // namespace tailwater
