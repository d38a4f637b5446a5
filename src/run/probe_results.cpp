#include "run/probe_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "case/probe_columns.h"
#include "run/probe_table.h"

namespace tailwater {
namespace {

constexpr const char* second_half = "mean of the second half";

/// What is told of a column.
enum class Tell { mean, largest, last, range, rate, largest_rate, rise, least_of_last, largest_of_last };

struct Rule {
  const char* name;
  const char* label;
  const char* column;  ///< the begin of its name
  Tell tell;
};

namespace rules {
inline constexpr std::array depth{Rule{"depth", "", "connected_m", Tell::mean},
                                  Rule{"highest water", "highest", "highest_m", Tell::largest}};
inline constexpr std::array pressure{Rule{"pressure", "", "pressure_Pa", Tell::mean},
                                     Rule{"largest pressure", "largest", "pressure_Pa", Tell::largest}};
// From the impulse, so that no step between two lines is left out.
inline constexpr std::array wall_pressure{Rule{"pressure", "", "impulse_Pa_s", Tell::rate},
                                          Rule{"largest pressure", "largest", "impulse_Pa_s", Tell::largest_rate},
                                          Rule{"rise", "risen in", "impulse_Pa_s", Tell::rise},
                                          Rule{"impulse", "impulse", "impulse_Pa_s", Tell::last}};
inline constexpr std::array front{Rule{"front", "", "front_connected_m", Tell::last}};
inline constexpr std::array profile{Rule{"least depth", "depth from", "connected_m", Tell::least_of_last},
                                    Rule{"largest depth", "to", "connected_m", Tell::largest_of_last}};
inline constexpr std::array velocity{Rule{"u", "u", "u_m_s", Tell::mean}, Rule{"v", "v", "v_m_s", Tell::mean},
                                     Rule{"w", "w", "w_m_s", Tell::mean}};
inline constexpr std::array energy{Rule{"energy", "", "total_J", Tell::last}};
inline constexpr std::array volume{Rule{"particles", "", "particles", Tell::last},
                                   Rule{"volume in", "in", "volume_in_m3", Tell::last},
                                   Rule{"volume out", "out", "volume_out_m3", Tell::last}};
inline constexpr std::array discharge{Rule{"discharge", "", "volume_m3", Tell::rate},
                                      Rule{"largest discharge", "largest", "discharge_m3_per_s", Tell::largest}};
inline constexpr std::array force{
    Rule{"force x", "x", "force_x", Tell::mean}, Rule{"force y", "y", "force_y", Tell::mean},
    Rule{"force z", "z", "force_z", Tell::mean}, Rule{"largest force", "largest", magnitude_of_force, Tell::largest}};
inline constexpr std::array pressure_map{Rule{"largest pressure", "largest", "largest_Pa", Tell::largest}};
inline constexpr std::array motion{Rule{"displacement x", "x", "displacement_x_m", Tell::range},
                                   Rule{"displacement y", "y", "displacement_y_m", Tell::range},
                                   Rule{"displacement z", "z", "displacement_z_m", Tell::range},
                                   Rule{"angle", "angle", "angle_rad", Tell::range},
                                   Rule{"angle about x", "angle about x", "angle_x_rad", Tell::range},
                                   Rule{"angle about y", "angle about y", "angle_y_rad", Tell::range},
                                   Rule{"angle about z", "angle about z", "angle_z_rad", Tell::range}};
inline constexpr std::array run_up{Rule{"run-up", "", "connected_m", Tell::largest},
                                   Rule{"highest drop", "drops to", "highest_m", Tell::largest}};
inline constexpr std::array level_map{Rule{"level", "", "mean_m", Tell::mean},
                                      Rule{"highest level", "highest", "highest_m", Tell::largest}};
inline constexpr std::array pockets{Rule{"pressure", "", "pressure_Pa", Tell::range},
                                    Rule{"volume", "volume", "volume_m3", Tell::last},
                                    Rule{"pockets", "pockets", "pockets", Tell::last}};
inline constexpr std::array velocity_profile{
    Rule{"mean u", "u", "mean_u_m_s", Tell::last}, Rule{"mean v", "v", "mean_v_m_s", Tell::last},
    Rule{"mean w", "w", "mean_w_m_s", Tell::last}, Rule{"depth", "depth", "depth_m", Tell::last}};
}  // namespace rules

/// Columns that a probe does not have in the dimension of the case are left out.
std::span<const Rule> rules_of(ProbeType type) {
  switch (type) {
    case ProbeType::depth:
      return rules::depth;
    case ProbeType::wall_pressure:
    case ProbeType::wall_pressure_mean:
      return rules::wall_pressure;
    case ProbeType::pressure:
      return rules::pressure;
    case ProbeType::front:
      return rules::front;
    case ProbeType::profile:
      return rules::profile;
    case ProbeType::velocity:
      return rules::velocity;
    case ProbeType::energy:
      return rules::energy;
    case ProbeType::volume:
      return rules::volume;
    case ProbeType::discharge:
      return rules::discharge;
    case ProbeType::force:
      return rules::force;
    case ProbeType::pressure_map:
      return rules::pressure_map;
    case ProbeType::motion:
      return rules::motion;
    case ProbeType::run_up:
      return rules::run_up;
    case ProbeType::level_map:
      return rules::level_map;
    case ProbeType::pockets:
      return rules::pockets;
    case ProbeType::velocity_profile:
      break;
  }
  return rules::velocity_profile;
}

/// Of a unit like "Pa s" or "m^3 per m".
std::string per_second(std::string unit) {
  if (unit.ends_with(" s")) return unit.substr(0, unit.size() - 2);
  return unit.insert(std::min(unit.find(' '), unit.size()), "/s");
}

Quantity quantity_of(const Rule& rule, const std::string& name, const ColumnDigest& column, const TableDigest& table,
                     int dimension) {
  Quantity quantity{.name = rule.name, .label = rule.label, .unit = unit_of_column(name, dimension), .what = ""};
  const std::string at_last = fmt::format("at {:.4g} s", table.last_time);
  switch (rule.tell) {
    case Tell::mean:
      quantity.value = column.mean_of_second_half();
      quantity.what = second_half;
      break;
    case Tell::rate:
      quantity.value = column.rate_in_second_half();
      quantity.unit = per_second(std::move(quantity.unit));
      quantity.what = second_half;
      break;
    case Tell::largest_rate:
      quantity.value = column.largest_rate;
      quantity.unit = per_second(std::move(quantity.unit));
      quantity.what = fmt::format("at {:.4g} s", column.time_of_largest_rate);
      break;
    case Tell::rise:
      quantity.value = column.rise;
      quantity.unit = "s";
      quantity.what = "from a tenth of it";
      break;
    case Tell::largest:
      quantity.value = column.largest;
      quantity.what = fmt::format("at {:.4g} s", column.time_of_largest);
      break;
    case Tell::range:
      quantity.value = column.least;
      quantity.to = column.largest;
      quantity.what = "least and largest";
      break;
    case Tell::last:
      quantity.value = column.last;
      quantity.what = at_last;
      break;
    case Tell::least_of_last:
      quantity.value = column.least_of_last;
      quantity.what = at_last;
      break;
    case Tell::largest_of_last:
      quantity.value = column.largest_of_last;
      quantity.what = at_last;
      break;
  }
  return quantity;
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
      if (is_told) result.quantities.push_back(quantity_of(rule, *column, digest, table, spec.general.dimension));
    }
    if (!result.quantities.empty()) results.push_back(std::move(result));
  }
  return results;
}

nlohmann::ordered_json json_of(const std::vector<ProbeResult>& results) {
  nlohmann::ordered_json all = nlohmann::ordered_json::object();
  for (const ProbeResult& result : results) {
    nlohmann::ordered_json quantities = nlohmann::ordered_json::array();
    for (const Quantity& quantity : result.quantities) {
      nlohmann::ordered_json one{{"name", quantity.name}, {"value", quantity.value}};
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
