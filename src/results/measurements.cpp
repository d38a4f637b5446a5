#include "results/measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "case/probe_columns.h"
#include "results/probe_results.h"

namespace tailwater {
namespace {

/// Number of shifts that are tried between 0 and the largest, in each direction.
constexpr int shifts_each_way = 100;

/// The measured samples that a run up to `end` [s] can be compared with, for any shift.
TimeSeries within_run(const TimeSeries& series, double end) {
  TimeSeries measured{.file = series.file, .line = {}, .time = {}, .columns = {}};
  measured.columns.resize(series.columns.size());
  for (std::size_t k = 0; k < series.time.size(); ++k) {
    if (series.time[k] < 0.0 || series.time[k] > end) continue;
    measured.time.push_back(series.time[k]);
    for (std::size_t c = 0; c < series.columns.size(); ++c) measured.columns[c].push_back(series.columns[c][k]);
  }
  return measured;
}

/// Interpolates between values at ascending places; outside them the nearest value counts.
double interpolated(const std::vector<double>& places, const std::vector<double>& values, double where) {
  const auto after = std::ranges::upper_bound(places, where);
  if (after == places.begin()) return values.front();
  if (after == places.end()) return values.back();
  const auto k = static_cast<std::size_t>(after - places.begin());
  const double share = (where - places[k - 1]) / (places[k] - places[k - 1]);
  return values[k - 1] + share * (values[k] - values[k - 1]);
}

/// Interpolates linearly between places and between times.
double at(const ProbeProfiles& profiles, double when, double where) {
  const auto later = static_cast<std::size_t>(std::ranges::upper_bound(profiles.time, when) - profiles.time.begin());
  const auto value = [&](std::size_t k) { return interpolated(profiles.x[k], profiles.value[k], where); };
  if (later == 0) return value(0);
  if (later == profiles.time.size()) return value(later - 1);
  const double before = profiles.time[later - 1];
  const double share = (when - before) / (profiles.time[later] - before);
  return (1.0 - share) * value(later - 1) + share * value(later);
}

/// The weight of a sample in time; only the ratios of the weights matter.
double weight_of(const std::vector<double>& time, std::size_t k) {
  if (time.size() == 1) return 1.0;
  return 0.5 * (time[std::min(k + 1, time.size() - 1)] - time[k == 0 ? 0 : k - 1]);
}

/// The difference for values whose error off(k) has the weight weight(k).
template <class Off, class Weight>
Difference difference_of(std::size_t count, double scatter, const Off& off, const Weight& weight) {
  double weights = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  double inside = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double own = weight(k);
    const double away = off(k);
    weights += own;
    sum += own * away;
    squares += own * away * away;
    if (std::abs(away) <= scatter) inside += own;
  }
  return {std::sqrt(squares / weights), sum / weights, inside / weights};
}

/// `end` [s] is the last computed time; `with(measured, shift)` returns the difference with a shift.
template <class With>
MeasurementScore scored(const MeasurementTable& measurement, std::optional<double> end, const With& with) {
  MeasurementScore score;
  score.probe = measurement.probe;
  score.column = measurement.column;
  score.file = measurement.file;
  score.scatter = measurement.scatter;
  score.max_shift = measurement.shift;
  if (!end) return score;
  // The end of a late curve is not yet computed, so the largest shift is left out at the end.
  const TimeSeries measured = within_run(measurement.series, *end - measurement.shift);
  score.samples = measured.time.size();
  if (measured.time.empty()) return score;
  score.from = measured.time.front();
  score.to = measured.time.back();
  score.as_timed = score.shifted = with(measured, 0.0);
  for (int k = -shifts_each_way; k <= shifts_each_way && measurement.shift > 0.0; ++k) {
    const double shift = measurement.shift * k / shifts_each_way;
    const Difference tried = with(measured, shift);
    if (tried.rms >= score.shifted.rms) continue;
    score.best_shift = shift;
    score.shifted = tried;
  }
  return score;
}

std::optional<double> last_of(const std::vector<double>& time) {
  return time.empty() ? std::nullopt : std::optional(time.back());
}

Json difference_json(const Difference& difference, double scatter) {
  Json json{{"rms", difference.rms}, {"bias", difference.bias}};
  if (scatter > 0.0) json["share_inside"] = difference.share_inside;
  return json;
}

}  // namespace

double Curve::at(double when) const { return interpolated(time, value, when); }

Difference difference(const Curve& measured, const Curve& computed, double shift, double scatter) {
  return difference_of(
      measured.time.size(), scatter,
      [&](std::size_t k) { return computed.at(measured.time[k] + shift) - measured.value[k]; },
      [&](std::size_t k) { return weight_of(measured.time, k); });
}

MeasurementScore score(const MeasurementTable& measurement, const Curve& computed) {
  return scored(measurement, last_of(computed.time), [&](const TimeSeries& measured, double shift) {
    return difference({measured.time, measured.columns[0]}, computed, shift, measurement.scatter);
  });
}

MeasurementScore score(const MeasurementTable& measurement, const ProbeProfiles& computed) {
  return scored(measurement, last_of(computed.time), [&](const TimeSeries& measured, double shift) {
    return difference_of(
        measured.time.size(), measurement.scatter,
        [&](std::size_t k) {
          return at(computed, measured.time[k] + shift, measured.columns[1][k]) - measured.columns[0][k];
        },
        [](std::size_t) { return 1.0; });
  });
}

std::string MeasurementScore::words() const {
  const std::string name = std::filesystem::path(file).filename().string();
  if (samples == 0) return fmt::format("{}: the run has no reading at the times of {}", column, name);
  std::string text = fmt::format("{} against {}, {} samples of {:.4g} to {:.4g} s: rms {:.3g} {}, bias {:+.3g} {}",
                                 column, name, samples, from, to, as_timed.rms, unit, as_timed.bias, unit);
  if (max_shift > 0.0) {
    const bool is_at_limit = std::abs(best_shift) >= max_shift;
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
    const Compared compared = compared_with(measurement, spec);
    const std::filesystem::path table = run / "probes" / (measurement.probe + ".csv");
    if (spec.probes[compared.probe].type == ProbeType::profile) {
      scores.push_back(score(measurement, read_probe_profiles(table, compared.column.heading)));
    } else {
      const ProbeColumn found = read_probe_column(table, compared.column.heading);
      scores.push_back(score(measurement, Curve{found.time, found.value}));
    }
    scores.back().unit = unit_of(compared.column.measure, spec.general.dimension);
  }
  return scores;
}

Json json_of(const std::vector<MeasurementScore>& scores) {
  Json all = Json::array();
  for (const MeasurementScore& score : scores) {
    Json one{{"probe", score.probe}, {"column", score.column},   {"unit", score.unit},
             {"file", score.file},   {"samples", score.samples}, {"words", score.words()}};
    if (score.samples > 0) {
      one.update({{"from_s", score.from}, {"to_s", score.to}});
      one.update(difference_json(score.as_timed, score.scatter));
      if (score.max_shift > 0.0) {
        one["most_shift_s"] = score.max_shift;
        one["best_shift_s"] = score.best_shift;
        one["shifted"] = difference_json(score.shifted, score.scatter);
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
