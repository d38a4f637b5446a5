#include "results/probe_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string_view>

#include "case/probe_columns.h"
#include "probes/discharge.h"
#include "probes/wall_pressure.h"
#include "results/probe_table.h"

namespace tailwater {
namespace {

/// With fewer readings than that, a mean is marked with their number.
constexpr int many_readings = 5;

std::string mean_in_words(int readings, int trend) {
  const std::string mean = readings >= many_readings ? "mean of the second half"
                           : readings > 1            ? fmt::format("mean of {} readings in the second half", readings)
                                                     : "only reading in the second half";
  if (trend == 0) return mean;
  return mean + (trend > 0 ? ", still rising" : ", still falling");
}

/// The time [s] of the largest mean of a probe.
double averaging_time_of(const ProbeTable& probe, const CaseSpec& spec, double speed) {
  if (probe.type == ProbeType::discharge) {
    return spec.general.dimension == 2 ? discharge_mean_over<2>(probe, spec) : discharge_mean_over<3>(probe, spec);
  }
  const double gravity = std::sqrt(
      std::inner_product(spec.physics.gravity.begin(), spec.physics.gravity.end(), spec.physics.gravity.begin(), 0.0));
  return averaging_time(probe.averaging_time, spec.particles.spacing, speed, gravity);
}

/// Whether a column has the readings that a statistic takes.
bool is_known(Statistic statistic, const ColumnDigest& column) {
  switch (statistic) {
    case Statistic::mean:
      return column.mean_of_second_half().has_value();
    case Statistic::rate:
      return column.rate_in_second_half().has_value();
    case Statistic::max_rate:
      return column.largest_rate.is_known();
    case Statistic::max_mean:
      return column.largest_mean.is_known();
    case Statistic::max_moving_mean:
      return column.largest_moving_mean.has_value();
    case Statistic::rise:
      return column.largest_rate.rise() > 0.0;
    default:
      return column.count > 0;
  }
}

/// The result of a statistic that is known.
Quantity quantity_of(const DeclaredResult& declared, Measure measure, const ColumnDigest& column, double last_time,
                     const ProbeTable& probe, const CaseSpec& spec, double speed) {
  const int dimension = spec.general.dimension;
  const auto at = [](double time) { return fmt::format("at {:.4g} s", time); };
  const auto quantity = [&](double value, const std::string& what) {
    return Quantity{.name = std::string(declared.name),
                    .label = std::string(declared.label),
                    .value = value,
                    .unit = std::string(unit_of(measure_of(declared.statistic, measure), dimension)),
                    .what = what};
  };
  switch (declared.statistic) {
    case Statistic::mean:
      return quantity(*column.mean_of_second_half(),
                      mean_in_words(column.readings_in_second_half(), column.trend_of_mean()));
    case Statistic::rate:
      return quantity(*column.rate_in_second_half(),
                      mean_in_words(column.readings_in_second_half(), column.trend_of_rate()));
    case Statistic::max_rate:
    case Statistic::max_mean: {
      const LargestMean& largest =
          declared.statistic == Statistic::max_rate ? column.largest_rate : column.largest_mean;
      const double over = std::max(averaging_time_of(probe, spec, speed), largest.over());
      if (over == 0.0) return quantity(largest.value(), at(largest.time()));
      return quantity(largest.value(), fmt::format("{}, mean over {:.2g} s", at(largest.time()), over));
    }
    case Statistic::rise:
      return quantity(column.largest_rate.rise(), "from a tenth to the largest");
    case Statistic::max:
    case Statistic::max_magnitude:
      return quantity(column.largest, at(column.time_of_largest));
    case Statistic::max_moving_mean: {
      const ColumnDigest::MovingMean& largest = *column.largest_moving_mean;
      return quantity(largest.value, fmt::format("{}, mean over {:.2g} s", at(largest.time), largest.over));
    }
    case Statistic::range: {
      Quantity range = quantity(column.least, "least and largest");
      range.to = column.largest;
      return range;
    }
    case Statistic::last:
      return quantity(column.last, at(last_time));
    case Statistic::last_min:
      return quantity(column.min_of_last, at(last_time));
    case Statistic::last_max:
      break;
  }
  return quantity(column.largest_of_last, at(last_time));
}

/// Lets the largest moving mean, the last of the quantities, not be below the mean, the first of them. The mean is over
/// a longer time, and where few rows of particles pass, its count of whole particles can exceed all moving means.
void keep_at_mean(std::vector<Quantity>& quantities) {
  const Quantity& mean = quantities.front();
  if (quantities.size() > 1 && mean.value > quantities.back().value) {
    quantities.back().value = mean.value;
    quantities.back().what = mean.what;
  }
}

/// Four digits of the size `largest`, without an exponent for sizes from 1e-4 to 1e7. Less than a thousandth of it is
/// 0: where a component is 0 by symmetry, rounding and noise are left of it.
std::string number_in_words(double value, double largest) {
  const double size = std::abs(value);
  if (size < 1e-3 * largest) return "0";
  if (largest != 0.0 && (largest < 1e-4 || largest >= 1e7)) return fmt::format("{:.3e}", value);
  if (size == std::floor(size) && size >= 1000.0) return fmt::format("{:.0f}", value);
  const int digits = largest == 0.0 ? 0 : std::clamp(3 - static_cast<int>(std::floor(std::log10(largest))), 0, 7);
  return fmt::format("{:.{}f}", value, digits);
}

double size_of(const Quantity& quantity) {
  return std::max(std::abs(quantity.value), std::abs(quantity.to.value_or(0.0)));
}

/// The size of the largest component of the vector to which a quantity belongs; 0 if it is no component of one.
double size_of_vector(const std::vector<Quantity>& quantities, const Quantity& component) {
  const auto is_component = [](const Quantity& quantity) {
    constexpr std::string_view of_moment = "moment ";
    std::string_view label = quantity.label;
    if (label.starts_with(of_moment)) label.remove_prefix(of_moment.size());
    return label.size() == 1 && std::string_view("xyzuvw").find(label[0]) != std::string_view::npos;
  };
  double largest = 0.0;
  if (!is_component(component)) return largest;
  for (const Quantity& other : quantities) {
    const bool is_of_the_vector = is_component(other) && other.unit == component.unit && other.what == component.what;
    if (is_of_the_vector) largest = std::max(largest, size_of(other));
  }
  return largest;
}

}  // namespace

std::string ProbeResult::words() const {
  std::string text;
  for (std::size_t k = 0; k < quantities.size(); ++k) {
    const Quantity& quantity = quantities[k];
    const double vector = size_of_vector(quantities, quantity);
    const auto in_words = [vector](double value) { return number_in_words(value, std::max(vector, std::abs(value))); };
    if (k > 0) text += ", ";
    if (!quantity.label.empty()) text += quantity.label + " ";
    text += in_words(quantity.value);
    if (quantity.to) text += " to " + in_words(*quantity.to);
    if (!quantity.unit.empty()) text += " " + quantity.unit;
    const bool is_last_of_these = k + 1 == quantities.size() || quantities[k + 1].what != quantity.what;
    if (is_last_of_these) text += fmt::format(" ({})", quantity.what);
  }
  return text;
}

std::vector<ProbeResult> probe_results(const CaseSpec& spec, const RunFolder& folder, double time, double speed) {
  std::vector<ProbeResult> results;
  for (const ProbeTable& probe : spec.probes) {
    const TableDigest table =
        digest_probe_table(folder.probe(probe.name), 0.5 * time, averaging_time_of(probe, spec, speed));
    ProbeResult result{probe.name, std::string(name_of(probe.type)), {}};
    const std::vector<OutputColumn> columns = columns_of(probe, spec.general.dimension);
    for (const DeclaredResult& declared : info_of(probe.type).results) {
      const auto column = std::ranges::find(columns, declared.column, &OutputColumn::name);
      if (column == columns.end()) continue;
      const auto place = std::ranges::find(table.names, column->heading) - table.names.begin();
      if (place == std::ssize(table.names)) continue;
      const ColumnDigest& digest = declared.statistic != Statistic::max_magnitude ? table.columns[place]
                                   : column->measure == Measure::moment           ? table.magnitude_of_moment
                                                                                  : table.magnitude_of_force;
      if (!is_known(declared.statistic, digest)) continue;
      result.quantities.push_back(quantity_of(declared, column->measure, digest, table.last_time, probe, spec, speed));
      if (declared.statistic == Statistic::max_moving_mean) keep_at_mean(result.quantities);
    }
    if (!result.quantities.empty()) results.push_back(std::move(result));
  }
  return results;
}

Json json_of(const std::vector<ProbeResult>& results) {
  Json all = Json::object();
  for (const ProbeResult& result : results) {
    Json quantities = Json::array();
    for (const Quantity& quantity : result.quantities) {
      Json one{{"name", quantity.name}, {"value", quantity.value}};
      if (quantity.to) one["to"] = *quantity.to;
      one["unit"] = quantity.unit;
      one["what"] = quantity.what;
      quantities.push_back(std::move(one));
    }
    all[result.probe] = {{"type", result.type}, {"words", result.words()}, {"quantities", std::move(quantities)}};
  }
  return all;
}

}  // namespace tailwater
