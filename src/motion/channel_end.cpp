#include "motion/channel_end.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <string_view>

#include "case/named_numbers.h"
#include "geometry/ducts.h"
#include "geometry/from_spec.h"

namespace tailwater {
namespace {

/// A smaller fraction of gravity along an opening is rounding error.
constexpr double min_gravity_share = 1e-9;
/// Lines along a column of a section, and the steps in which its ends are found.
constexpr int lines_per_column = 4;
constexpr double steps_per_spacing = 50.0;
/// Parts of a tabulated profile. Each part has the discharge of its middle: a seventh root loses 1e-4 of the total.
constexpr int profile_parts = 1000;
/// By which the mean of a profile may change with twice as many parts. A profile that grows without bound towards the
/// bed or the surface has a mean only if it grows slower than 1/s; with s^-0.9 it still changes by 2 %.
constexpr double max_change_of_mean = 0.01;

/// The values of a profile in the middle of equal parts of the depth.
std::vector<double> profile_values(Formula& formula, int parts, const CaseLabel& owner) {
  std::vector<double> values;
  for (int k = 0; k < parts; ++k) {
    const double share = (k + 0.5) / parts;
    values.push_back(formula.at(std::array{share}));
    if (!std::isfinite(values.back())) {
      throw CaseError("inlet-profile-not-finite",
                      {"{} has no finite value at s = {:.4g}", owner.with_key("profile"), share},
                      {"give an expression that has one everywhere from the bed, s = 0, to the surface, s = 1"});
    }
  }
  return values;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Throws CaseError for the mean of a profile that lets no water in.
void require_inflow(double mean, const CaseLabel& owner) {
  if (mean > 0.0) return;
  throw CaseError(
      "inlet-profile-mean",
      {"{} has the mean {:.4g}; a discharge or a velocity below 0 lets water out", owner.with_key("profile"), mean},
      {"give one whose mean is above 0"});
}

/// EndFlow::profile.
std::vector<double> tabulated_profile(const std::optional<Varying>& profile, const CaseSpec& spec,
                                      const CaseLabel& owner) {
  if (!profile) return {};
  if (const double* uniform = std::get_if<double>(&*profile)) {
    require_inflow(*uniform, owner);
    return {};
  }
  NamedNumbers numbers = named_numbers(spec);
  numbers.erase(std::string(height_name[0]));
  Formula formula(std::get<std::string>(*profile), numbers, height_name);
  const std::vector<double> values = profile_values(formula, profile_parts, owner);
  const double mean = mean_of(values);
  require_inflow(mean, owner);
  const double finer = mean_of(profile_values(formula, 2 * profile_parts, owner));
  if (std::abs(finer - mean) > max_change_of_mean * mean) {
    const bool at_bed = std::abs(values.front()) > std::abs(values.back());
    throw CaseError("inlet-profile-unbounded",
                    {"{} grows without bound towards s = {}, so that it has no mean", owner.with_key("profile"),
                     at_bed ? "0, the bed" : "1, the surface"},
                    {"limit it there, as in min(10, ...)"});
  }
  std::vector<double> below{0.0};
  for (const double value : values) below.push_back(below.back() + value / (mean * profile_parts));
  return below;
}

/// The quantity from its key or from a column of the file.
std::optional<TimeFunction> time_function(const std::optional<Varying>& value, const TimeSeries& series,
                                          std::size_t column, const NamedNumbers& numbers,
                                          std::span<const std::string_view> names = time_name) {
  if (value) return TimeFunction(*value, numbers, names);
  if (column >= series.columns.size() || series.columns[column].empty()) return std::nullopt;
  return TimeFunction(SmoothCurve(series.time, series.columns[column]));
}

/// The part of a column within the outline of a section, on average over lines along it; none if it is less than half a
/// spacing high.
template <int Dim>
std::optional<SectionColumn> open_part(const Opening<Dim>& opening, const SectionColumn& column, const Vec<Dim>& low,
                                       const Vec<Dim>& aside, const Vec<Dim>& rise, double spacing) {
  if (opening.outline.corners().empty()) return column;
  const int steps = std::max(1, static_cast<int>(std::ceil(steps_per_spacing * column.top / spacing)));
  const double step = column.top / steps;
  SectionColumn open{column.aside, column.width, 0.0, 0.0};
  for (int line = 0; line < lines_per_column; ++line) {
    const double across = column.aside + ((line + 0.5) / lines_per_column - 0.5) * column.width;
    const auto is_open = [&](int k) { return opening.spans(Vec<Dim>(low + across * aside + (k + 0.5) * step * rise)); };
    int bottom = 0;
    while (bottom < steps && !is_open(bottom)) ++bottom;
    int top = bottom;
    while (top < steps && is_open(top)) ++top;
    // A line without an open part closes its part of the column.
    const double closed = 0.5 * column.top;
    open.bottom += (bottom < steps ? bottom * step : closed) / lines_per_column;
    open.top += (bottom < steps ? top * step : closed) / lines_per_column;
  }
  if (open.top - open.bottom < 0.5 * spacing) return std::nullopt;
  return open;
}

/// The lowest height [m] from 0 to `top` where a condition holds that holds above it, too; `top` where it never does.
template <class Condition>
double lowest_where(Condition&& holds, double top) {
  double low = 0.0;
  double high = top;
  for (int halvings = 0; halvings < 60; ++halvings) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace

double EndFlow::profile_of_row(double share, double row) const {
  if (profile.empty()) return 1.0;
  const auto below = [&](double height) {
    const double place = height * static_cast<double>(profile.size() - 1);
    const auto k = std::min(static_cast<std::size_t>(place), profile.size() - 2);
    return std::lerp(profile[k], profile[k + 1], place - static_cast<double>(k));
  };
  const double high = std::clamp(row, 1.0 / static_cast<double>(profile.size() - 1), 1.0);
  const double bottom = std::clamp(share - 0.5 * high, 0.0, 1.0 - high);
  return (below(bottom + high) - below(bottom)) / high;
}

double EndFlow::largest_in_profile(int rows) const {
  double largest = 0.0;
  for (int k = 0; k < rows; ++k) largest = std::max(largest, profile_of_row((k + 0.5) / rows, 1.0 / rows));
  return largest;
}

template <int Dim>
ChannelEnd<Dim>::ChannelEnd(const Opening<Dim>& place, EndFlow what_flows, const Vec<Dim>& full_gravity, double spacing,
                            double duct_length)
    : mouth(place), duct(duct_length), opening(place.moved_out(duct_length)), flow(std::move(what_flows)) {
  const Vec<Dim> along = full_gravity - opening.normal.dot(full_gravity) * opening.normal;
  gravity = along.norm() > min_gravity_share * full_gravity.norm() ? along.norm() : 0.0;
  up = gravity > 0.0 ? Vec<Dim>(-along / gravity) : Vec<Dim>(Vec<Dim>::Zero());
  floor = up.dot(opening.corner);
  for (const Vec<Dim>& edge : opening.edges) floor += std::min(0.0, up.dot(edge));
  width = 1.0;
  Vec<Dim> upright = opening.edges[0];
  low = opening.corner;
  if constexpr (Dim == 3) {
    const bool first_is_wide = std::abs(up.dot(opening.edges[0])) < std::abs(up.dot(opening.edges[1]));
    const Vec<3>& wide = opening.edges[first_is_wide ? 0 : 1];
    upright = opening.edges[first_is_wide ? 1 : 0];
    width = wide.norm();
    aside = wide / width;
  }
  if (up.dot(upright) < 0.0) {
    low += upright;
    upright = -upright;
  }
  height = upright.norm();
  rise = upright / height;
  const int count = Dim == 2 ? 1 : std::max(1, static_cast<int>(std::lround(width / spacing)));
  for (int c = 0; c < count; ++c) {
    const SectionColumn whole{width * (c + 0.5) / count, width / count, 0.0, height};
    const auto open = open_part(opening, whole, low, aside, rise, spacing);
    if (open || count == 1) columns.push_back(open.value_or(whole));
  }
}

template <int Dim>
double ChannelEnd<Dim>::area_below(double depth) const {
  double area = 0.0;
  for (const SectionColumn& column : columns) {
    area += column.width * std::clamp(depth - column.bottom, 0.0, column.top - column.bottom);
  }
  return area;
}

template <int Dim>
double ChannelEnd<Dim>::breadth_at(double depth) const {
  double breadth = 0.0;
  for (const SectionColumn& column : columns) {
    if (depth > column.bottom && depth <= column.top) breadth += column.width;
  }
  return breadth;
}

template <int Dim>
double ChannelEnd<Dim>::depth_of_area(double area) const {
  return lowest_where([&](double depth) { return area_below(depth) >= area; }, height);
}

template <int Dim>
bool ChannelEnd<Dim>::is_passed_by(const Vec<Dim>& x) const {
  if (!air()) return opening.is_passed_by(x);
  constexpr double shell = 3.0;  // [far_out]; other water of the case may be farther away on the same side of the plane
  const double out = mouth.beyond(x);
  const double farthest = std::max(out, mouth.aside(x));
  return out > 0.0 && farthest > far_out && farthest <= shell * far_out;
}

template <int Dim>
double ChannelEnd<Dim>::depth_at_level(double level) const {
  return gravity > 0.0 ? std::clamp(level - floor, 0.0, height) : height;
}

template <int Dim>
double ChannelEnd<Dim>::discharge(double time, double depth) const {
  if (flow.discharge) return flow.discharge->at(time);
  return flow.velocity ? flow.velocity->at(time) * area_below(depth) : 0.0;
}

template <int Dim>
double ChannelEnd<Dim>::critical_depth(double time) const {
  if (gravity == 0.0 || !flow.feeds()) return 0.0;
  const bool is_rectangle = area_below(height) > (1.0 - 1e-9) * width * height;
  if (!is_rectangle) {
    const auto is_subcritical = [&](double depth) {
      const double area = area_below(depth);
      return area > 0.0 && std::pow(discharge(time, depth), 2) * breadth_at(depth) <= gravity * std::pow(area, 3);
    };
    return discharge(time, height) == 0.0 ? 0.0 : lowest_where(is_subcritical, height);
  }
  if (flow.velocity) return std::pow(flow.velocity->at(time), 2) / gravity;
  return std::cbrt(std::pow(flow.discharge->at(time) / width, 2) / gravity);
}

template <int Dim>
double ChannelEnd<Dim>::largest_speed(double time, double spacing) const {
  const int rows = std::max(1, static_cast<int>(std::lround(height / spacing)));
  if (flow.velocity) return std::abs(flow.velocity->at(time)) * flow.largest_in_profile(rows);
  const double depth = flow.level      ? depth_at_level(flow.level->at(time))
                       : gravity > 0.0 ? critical_depth(time)
                                       : height;
  if (!flow.discharge) return std::sqrt(gravity * depth);
  const double area = area_below(depth);
  return area > 0.0 ? std::abs(flow.discharge->at(time)) / area * flow.largest_in_profile(rows) : 0.0;
}

template <int Dim>
double ChannelEnd<Dim>::largest_depth(double end_time) const {
  constexpr int samples = 100;
  double largest = 0.0;
  for (int k = 0; is_driven() && k <= samples; ++k) {
    const double time = end_time * k / samples;
    const double depth = flow.level ? depth_at_level(flow.level->at(time)) : critical_depth(time);
    largest = std::max(largest, std::min(depth, height));
  }
  return largest;
}

template <int Dim>
std::vector<ChannelEnd<Dim>> make_channel_ends(const CaseSpec& spec, std::span<const Duct<Dim>> ducts,
                                               const SpacingField<Dim>& field) {
  const NamedNumbers numbers = named_numbers(spec);
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  std::vector<ChannelEnd<Dim>> ends;
  std::size_t outlet = 0;
  std::size_t inlet = 0;
  for (const Opening<Dim>& opening : make_open_ends<Dim>(spec)) {
    EndFlow flow;
    if (opening.kind == OpeningKind::inlet) {
      const InletTable& table = spec.inlets[inlet++];
      flow = {time_function(table.discharge, table.series, 0, numbers),
              time_function(table.velocity, table.series, 1, numbers),
              time_function(table.level, table.series, 2, numbers, names_of_level(numbers)), table.absorbing,
              tabulated_profile(table.profile, spec, opening.label())};
    } else {
      const OutletTable& table = spec.outlets[outlet++];
      flow.level = time_function(table.level, table.series, 0, numbers, names_of_level(numbers));
      flow.absorbing = table.absorbing;
    }
    double duct = opening.meets_air ? 0.0 : duct_length(spec);
    if (!ducts.empty() && !opening.meets_air) {
      duct = ducts.front().length;
      ducts = ducts.subspan(1);
    }
    const double relative = field.is_uniform() ? 1.0 : field.at(box_around(opening.as_faces()).center());
    ends.emplace_back(opening, std::move(flow), gravity, relative * spec.particles.spacing, duct);
    if (opening.meets_air) ends.back().far_out = lead_over_spacing * spec.particles.spacing;
  }
  for (std::size_t k = 0; k < spec.inlets.size(); ++k) {
    const InletTable& table = spec.inlets[k];
    if (table.water_from.empty()) continue;
    const auto source = std::ranges::find(spec.outlets, table.water_from, &OutletTable::name);  // checked by the reader
    const std::size_t index = spec.inlets.size() + static_cast<std::size_t>(source - spec.outlets.begin());
    ends[k].circuit = ends[index].circuit = static_cast<int>(index);
    ends[k].reserve = table.reserve;
  }
  return ends;
}

template struct ChannelEnd<2>;
template struct ChannelEnd<3>;
TAILWATER_IN_2D_AND_3D(make_channel_ends);

}  // namespace tailwater
