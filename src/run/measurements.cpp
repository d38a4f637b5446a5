#include "run/measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "case/probe_columns.h"
#include "run/probe_results.h"
#include "run/probe_table.h"

namespace tailwater {
namespace {

/// Shifts that are tried between 0 and the largest, either way.
constexpr int shifts_one_way = 100;

/// The measured samples that a run up to `end` [s] can be compared with, whatever the shift.
Curve within_run(const TimeSeries& series, double end) {
  Curve measured;
  for (std::size_t k = 0; k < series.time.size(); ++k) {
    if (series.time[k] < 0.0 || series.time[k] > end) continue;
    measured.time.push_back(series.time[k]);
    measured.value.push_back(series.columns[0][k]);
  }
  return measured;
}

nlohmann::ordered_json json_of(const Difference& difference, double scatter) {
  nlohmann::ordered_json json{{"rms", difference.rms}, {"bias", difference.bias}};
  if (scatter > 0.0) json["share_inside"] = difference.share_inside;
  return json;
}

}  // namespace

double Curve::at(double when) const {
  const auto after = std::ranges::upper_bound(time, when);
  if (after == time.begin()) return value.front();
  if (after == time.end()) return value.back();
  const auto k = static_cast<std::size_t>(after - time.begin());
  const double share = (when - time[k - 1]) / (time[k] - time[k - 1]);
  return value[k - 1] + share * (value[k] - value[k - 1]);
}

Difference difference(const Curve& measured, const Curve& computed, double shift, double scatter) {
  const std::size_t count = measured.time.size();
  double weights = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  double inside = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double before = measured.time[k == 0 ? 0 : k - 1];
    const double after = measured.time[std::min(k + 1, count - 1)];
    const double weight = count == 1 ? 1.0 : 0.5 * (after - before);
    const double off = computed.at(measured.time[k] + shift) - measured.value[k];
    weights += weight;
    sum += weight * off;
    squares += weight * off * off;
    if (std::abs(off) <= scatter) inside += weight;
  }
  return {std::sqrt(squares / weights), sum / weights, inside / weights};
}

MeasurementScore score(const MeasurementTable& measurement, const Curve& computed) {
  MeasurementScore score;
  score.probe = measurement.probe;
  score.column = measurement.column;
  score.file = measurement.file;
  score.scatter = measurement.scatter;
  score.most_shift = measurement.shift;
  if (computed.time.empty()) return score;
  // What a late curve shows at the end of the run cannot be known, so the largest shift is left out at the end.
  const Curve measured = within_run(measurement.series, computed.time.back() - measurement.shift);
  score.samples = measured.time.size();
  if (measured.time.empty()) return score;
  score.from = measured.time.front();
  score.to = measured.time.back();
  score.as_timed = score.shifted = difference(measured, computed, 0.0, measurement.scatter);
  for (int k = -shifts_one_way; k <= shifts_one_way && measurement.shift > 0.0; ++k) {
    const double shift = measurement.shift * k / shifts_one_way;
    const Difference tried = difference(measured, computed, shift, measurement.scatter);
    if (tried.rms >= score.shifted.rms) continue;
    score.best_shift = shift;
    score.shifted = tried;
  }
  return score;
}

std::string MeasurementScore::words() const {
  const std::string name = std::filesystem::path(file).filename().string();
  if (samples == 0) return fmt::format("{}: the run has no reading at the times of {}", column, name);
  std::string text = fmt::format("{} against {}, {} samples of {:.4g} to {:.4g} s: rms {:.3g} {}, bias {:+.3g} {}",
                                 column, name, samples, from, to, as_timed.rms, unit, as_timed.bias, unit);
  if (most_shift > 0.0) {
    const bool is_at_limit = std::abs(best_shift) >= most_shift;
    text +=
        fmt::format("; best {:.3g} s {}{}: rms {:.3g} {}", std::abs(best_shift), best_shift < 0.0 ? "early" : "late",
                    is_at_limit ? ", which is all that is allowed" : "", shifted.rms, unit);
  }
  if (scatter > 0.0) {
    text += fmt::format("; {} the scatter of {:.3g} {}, within it {:.0f} % of the time",
                        is_inside() ? "inside" : "outside", scatter, unit, 100.0 * shifted.share_inside);
  }
  return text;
}

std::vector<MeasurementScore> measurement_scores(const CaseSpec& spec, const std::filesystem::path& run) {
  std::vector<MeasurementScore> scores;
  for (const MeasurementTable& measurement : spec.measurements) {
    const SeriesColumn column = compared_with(measurement, spec).column;
    const ProbeColumn found =
        read_probe_column(run / "probes" / (measurement.probe + ".csv"),
                          [&](std::string_view heading) { return is_heading_of(column, heading); });
    MeasurementScore one = score(measurement, {found.time, found.value});
    one.unit = unit_of_column(found.name, spec.general.dimension);
    scores.push_back(std::move(one));
  }
  return scores;
}

nlohmann::ordered_json json_of(const std::vector<MeasurementScore>& scores) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const MeasurementScore& score : scores) {
    nlohmann::ordered_json one{{"probe", score.probe}, {"column", score.column},   {"unit", score.unit},
                               {"file", score.file},   {"samples", score.samples}, {"words", score.words()}};
    if (score.samples > 0) {
      one.update({{"from_s", score.from}, {"to_s", score.to}});
      one.update(json_of(score.as_timed, score.scatter));
      if (score.most_shift > 0.0) {
        one["most_shift_s"] = score.most_shift;
        one["best_shift_s"] = score.best_shift;
        one["shifted"] = json_of(score.shifted, score.scatter);
      }
      if (score.scatter > 0.0) {
        one["scatter"] = score.scatter;
        one["is_inside"] = score.is_inside();
      }
    }
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace tailwater
