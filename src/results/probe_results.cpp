#include "results/probe_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "case/probe_columns.h"
#include "probes/discharge.h"
#include "results/probe_table.h"

namespace tailwater {
namespace {

constexpr const char* second_half = "mean of the second half";

/// What is told of a column.
enum class Tell {
  mean,
  largest,
  largest_discharge,
  last,
  range,
  rate,
  largest_rate,
  rise,
  least_of_last,
  largest_of_last
};

struct Rule {
  const char* name;
  const char* label;
  const char* column;  ///< the begin of its name
  Tell tell;
};

/// Columns that a probe does not have in the dimension of the case are left out. Means of a wall's pressure are from
/// its impulse, so that no step between two lines is left out.
std::vector<Rule> rules_of(ProbeType type) {
  switch (type) {
    case ProbeType::depth:
      return {{"depth", "", "connected_m", Tell::mean}, {"highest water", "highest", "highest_m", Tell::largest}};
    case ProbeType::wall_pressure:
    case ProbeType::wall_pressure_mean:
      return {{"pressure", "", "impulse_Pa_s", Tell::rate},
              {"largest pressure", "largest", "impulse_Pa_s", Tell::largest_rate},
              {"rise", "risen in", "impulse_Pa_s", Tell::rise},
              {"impulse", "impulse", "impulse_Pa_s", Tell::last}};
    case ProbeType::pressure:
      return {{"pressure", "", "pressure_Pa", Tell::mean},
              {"largest pressure", "largest", "pressure_Pa", Tell::largest}};
    case ProbeType::front:
      return {{"front", "", "front_connected_m", Tell::last}};
    case ProbeType::profile:
      return {{"least depth", "depth from", "connected_m", Tell::least_of_last},
              {"largest depth", "to", "connected_m", Tell::largest_of_last}};
    case ProbeType::velocity:
      return {{"u", "u", "u_m_s", Tell::mean}, {"v", "v", "v_m_s", Tell::mean}, {"w", "w", "w_m_s", Tell::mean}};
    case ProbeType::energy:
      return {{"energy", "", "total_J", Tell::last}};
    case ProbeType::volume:
      return {{"particles", "", "particles", Tell::last},
              {"volume in", "in", "volume_in_m3", Tell::last},
              {"volume out", "out", "volume_out_m3", Tell::last}};
    case ProbeType::discharge:
      return {{"discharge", "", "volume_m3", Tell::rate},
              {"largest discharge", "largest", "discharge_m3_per_s", Tell::largest_discharge}};
    case ProbeType::force:
      return {{"force x", "x", "force_x", Tell::mean},
              {"force y", "y", "force_y", Tell::mean},
              {"force z", "z", "force_z", Tell::mean},
              {"largest force", "largest", magnitude_of_force, Tell::largest}};
    case ProbeType::pressure_map:
      return {{"largest pressure", "largest", "largest_Pa", Tell::largest}};
    case ProbeType::motion:
      return {{"displacement x", "x", "displacement_x_m", Tell::range},
              {"displacement y", "y", "displacement_y_m", Tell::range},
              {"displacement z", "z", "displacement_z_m", Tell::range},
              {"angle", "angle", "angle_rad", Tell::range},
              {"angle about x", "angle about x", "angle_x_rad", Tell::range},
              {"angle about y", "angle about y", "angle_y_rad", Tell::range},
              {"angle about z", "angle about z", "angle_z_rad", Tell::range}};
    case ProbeType::run_up:
      return {{"run-up", "", "connected_m", Tell::largest}, {"highest drop", "drops to", "highest_m", Tell::largest}};
    case ProbeType::level_map:
      return {{"level", "", "mean_m", Tell::mean}, {"highest level", "highest", "highest_m", Tell::largest}};
    case ProbeType::pockets:
      return {{"pressure", "", "pressure_Pa", Tell::range},
              {"volume", "volume", "volume_m3", Tell::last},
              {"pockets", "pockets", "pockets", Tell::last}};
    case ProbeType::velocity_profile:
      return {{"mean u", "u", "mean_u_m_s", Tell::last},
              {"mean v", "v", "mean_v_m_s", Tell::last},
              {"mean w", "w", "mean_w_m_s", Tell::last},
              {"depth", "depth", "depth_m", Tell::last}};
  }
  return {};
}

/// Of a unit like "Pa s" or "m^3 per m".
std::string per_second(std::string unit) {
  if (unit.ends_with(" s")) return unit.substr(0, unit.size() - 2);
  return unit.insert(std::min(unit.find(' '), unit.size()), "/s");
}

Quantity quantity_of(const Rule& rule, const std::string& name, const ColumnDigest& column, const TableDigest& table,
                     const ProbeTable& probe, const CaseSpec& spec) {
  const std::string unit = unit_of_column(name, spec.general.dimension);
  const auto at = [](double time) { return fmt::format("at {:.4g} s", time); };
  const auto quantity = [&](double value, const std::string& in, const std::string& what) {
    return Quantity{.name = rule.name, .label = rule.label, .value = value, .unit = in, .what = what};
  };
  switch (rule.tell) {
    case Tell::mean:
      return quantity(column.mean_of_second_half(), unit, second_half);
    case Tell::rate:
      return quantity(column.rate_in_second_half(), per_second(unit), second_half);
    case Tell::largest_rate:
      return quantity(column.largest_rate, per_second(unit), at(column.time_of_largest_rate));
    case Tell::rise:
      return quantity(column.rise, "s", "from a tenth of it");
    case Tell::largest:
      return quantity(column.largest, unit, at(column.time_of_largest));
    case Tell::largest_discharge: {
      const double over = spec.general.dimension == 2 ? discharge_smoothed_over<2>(probe, spec)
                                                      : discharge_smoothed_over<3>(probe, spec);
      return quantity(column.largest, unit,
                      fmt::format("{}, smoothed over {:.2g} s", at(column.time_of_largest), over));
    }
    case Tell::range: {
      Quantity range = quantity(column.least, unit, "least and largest");
      range.to = column.largest;
      return range;
    }
    case Tell::last:
      return quantity(column.last, unit, at(table.last_time));
    case Tell::least_of_last:
      return quantity(column.least_of_last, unit, at(table.last_time));
    case Tell::largest_of_last:
      break;
  }
  return quantity(column.largest_of_last, unit, at(table.last_time));
}

/// Four digits, as one writes them.
std::string number_in_words(double value) {
  const double size = std::abs(value);
  if (size != 0.0 && (size < 1e-4 || size >= 1e7)) return fmt::format("{:.3e}", value);
  if (size == std::floor(size) && size >= 1000.0) return fmt::format("{:.0f}", value);
  const int digits = size == 0.0 ? 0 : std::clamp(3 - static_cast<int>(std::floor(std::log10(size))), 0, 7);
  return fmt::format("{:.{}f}", value, digits);
}

}  // namespace

std::string ProbeResult::words() const {
  std::string text;
  for (std::size_t k = 0; k < quantities.size(); ++k) {
    const Quantity& quantity = quantities[k];
    if (k > 0) text += ", ";
    if (!quantity.label.empty()) text += quantity.label + " ";
    text += number_in_words(quantity.value);
    if (quantity.to) text += " to " + number_in_words(*quantity.to);
    if (!quantity.unit.empty()) text += " " + quantity.unit;
    const bool is_last_of_these = k + 1 == quantities.size() || quantities[k + 1].what != quantity.what;
    if (is_last_of_these) text += fmt::format(" ({})", quantity.what);
  }
  return text;
}

std::vector<ProbeResult> probe_results(const CaseSpec& spec, const RunFolder& folder, double time) {
  std::vector<ProbeResult> results;
  for (const ProbeTable& probe : spec.probes) {
    const TableDigest table = digest_probe_table(folder.probe(probe.name), 0.5 * time);
    ProbeResult result{probe.name, std::string(name_of(probe.type)), {}};
    for (const Rule& rule : rules_of(probe.type)) {
      const auto column =
          std::ranges::find_if(table.names, [&](const std::string& n) { return n.starts_with(rule.column); });
      if (column == table.names.end()) continue;
      const ColumnDigest& digest = table.columns[static_cast<std::size_t>(column - table.names.begin())];
      const bool is_told = digest.count > 0 && (rule.tell != Tell::rise || digest.rise > 0.0);
      if (is_told) result.quantities.push_back(quantity_of(rule, *column, digest, table, probe, spec));
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
