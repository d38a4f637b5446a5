#include "open_ends/fibres.h"

#include <algorithm>
#include <cmath>

#include "base/for_each.h"
#include "flow/flow.h"
#include "flow/pores.h"

namespace tailwater {
namespace {

/// [dx] before the buffer, of the water whose velocity is continued into it.
constexpr double length_of_fit = 3.0;
/// [dx] across, at which the weight of water in the fit of a fibre has fallen to 1/e; at twice that it is cut off.
constexpr double width_of_fit = 1.5;
/// Variance of the distances from the buffer over their mean square, from which on the slope of a fit counts in full;
/// rows of particles have 0.12 at least, and a few drops of spray much less. Water at one distance, to which no line
/// can be fitted, has 0, and its fibre has the mean velocity.
constexpr double full_spread = 0.1;

/// Weighted sums over the water near a fibre; x is the distance beyond the border of the buffer, u the speed out.
struct Fit {
  double w = 0.0, wx = 0.0, wxx = 0.0, wu = 0.0, wxu = 0.0;

  /// m/s; at the border.
  double speed() const {
    const double determinant = w * wxx - wx * wx;
    const double spread = determinant / (w * wxx);
    if (!(spread > 1e-6)) return wu / w;
    const double at_border = (wu * wxx - wxu * wx) / determinant;
    return spread >= full_spread ? at_border : std::lerp(wu / w, at_border, spread / full_spread);
  }
};
constexpr std::size_t sums_of_fit = 5;

/// Adds water at a place to the fits of the fibres near it.
template <int Dim>
void add_to_fits(const OpenEnd<Dim>& end, const Vec<Dim>& at, double x, double u, double volume, double* sums) {
  const double width = width_of_fit * end.spacing;
  const double reach = 2.0 * width;
  const double place = end.aside.dot(at - end.low);
  for (std::size_t c = 0; c < end.columns.size(); ++c) {
    const double across = end.columns[c].aside - place;
    if (Dim == 3 && across < -reach) continue;
    if (Dim == 3 && across > reach) break;
    const double cell = end.fibre_height(c);
    const double height = end.height_in(c, at);
    const double lateral = Dim == 3 ? across * across : 0.0;
    const auto count = static_cast<double>(end.first_fibre[c + 1] - end.first_fibre[c]);
    const auto first = static_cast<std::size_t>(std::clamp((height - reach) / cell, 0.0, count));
    const auto last = static_cast<std::size_t>(std::clamp((height + reach) / cell, 0.0, count));
    for (std::size_t k = first; k < last; ++k) {
      const double off = (static_cast<double>(k) + 0.5) * cell - height;
      const double ratio = (off * off + lateral) / (width * width);
      if (ratio > 4.0) continue;
      const double w = volume * std::exp(-ratio);
      double* sum = sums + sums_of_fit * (end.first_fibre[c] + k);
      sum[0] += w;
      sum[1] += w * x;
      sum[2] += w * x * x;
      sum[3] += w * u;
      sum[4] += w * u * x;
    }
  }
}

/// The fits of all fibres, over all ranks, and behind them the moments sum V z w, sum V z^2 of the velocity w upwards
/// over the height z above the bottom.
template <int Dim>
std::vector<double> sum_water_before(const OpenEnd<Dim>& end, const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  const double length = length_of_fit * end.spacing;
  const std::size_t fibres = end.first_fibre.back();
  std::vector<double> sums(sums_of_fit * fibres + 2, 0.0);
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: adds to sums of several fibres
    if (flow.role[i] != Role::water) continue;
    const Vec<Dim>& at = particles.position[i];
    const double before = -(end.opening.beyond(at) + end.stretch);
    if (before < 0.0 || before >= length || !end.opening.spans(at)) continue;
    const Vec<Dim> velocity = filled_fraction(flow.pores, at) * particles.velocity[i];
    const double volume = particles.volume[i] * (1.0 - before / length);
    add_to_fits(end, at, -before, end.opening.normal.dot(velocity), volume, sums.data());
    const double height = end.height_in(end.column_at(at), at);
    sums[sums_of_fit * fibres] += volume * height * end.rise.dot(velocity);
    sums[sums_of_fit * fibres + 1] += volume * height * height;
  }
  flow.setup.ranks.sum_of_each(sums);
  return sums;
}

/// m/s, out; of a cell of the section where there is no water inside: the pressure beyond drives water into air.
template <int Dim>
double speed_into_air(const OpenEnd<Dim>& end, const OpenEndState& state, std::size_t column, std::size_t row) {
  const SectionColumn& of = end.columns[column];
  const double z = of.bottom + (static_cast<double>(row) + 0.5) * end.fibre_height(column);
  const Vec<Dim> at = end.low + z * end.rise + of.aside * end.aside;
  const Vec<Dim> none = Vec<Dim>::Zero();
  return -std::sqrt(2.0 * end.pressure_at(state, at, none, none, 1.0));
}

/// Where there is no water inside, water comes in as the level drives it, with one speed where it has a free surface,
/// and what has left goes on as it was.
template <int Dim>
void set_speeds_into_air(const OpenEnd<Dim>& end, const Inflow& inflow, OpenEndState& state) {
  for (std::size_t c = 0; c < end.columns.size(); ++c) {
    for (std::size_t f = end.first_fibre[c]; f < end.first_fibre[c + 1]; ++f) {
      if (state.is_full) state.fibre_speeds[f] = speed_into_air(end, state, c, f - end.first_fibre[c]);
      if (inflow.speed > 0.0) state.fibre_speeds[f] = -inflow.speed;
    }
  }
}

/// Fibres above the water have the speed of the highest one below them that has water, fibres below all water that of
/// the lowest one; a column without water has the mean of all.
template <int Dim>
void fit_speeds(const OpenEnd<Dim>& end, const std::vector<double>& sums, OpenEndState& state) {
  const auto fit_of = [&](std::size_t fibre) {
    const double* sum = sums.data() + sums_of_fit * fibre;
    return Fit{sum[0], sum[1], sum[2], sum[3], sum[4]};
  };
  double weight = 0.0, flux = 0.0;
  for (std::size_t f = 0; f < end.first_fibre.back(); ++f) {
    weight += fit_of(f).w;
    flux += fit_of(f).wu;
  }
  for (std::size_t c = 0; c < end.columns.size(); ++c) {
    const std::size_t begin = end.first_fibre[c], stop = end.first_fibre[c + 1];
    std::size_t lowest = begin;
    while (lowest < stop && fit_of(lowest).w == 0.0) ++lowest;
    double speed = lowest < stop ? fit_of(lowest).speed() : flux / weight;
    for (std::size_t f = begin; f < stop; ++f) {
      if (fit_of(f).w > 0.0) speed = fit_of(f).speed();
      state.fibre_speeds[f] = speed;
    }
  }
}

/// m/s, out; mean over the section below the water's surface.
template <int Dim>
double mean_below_surface(const OpenEnd<Dim>& end, const OpenEndState& state) {
  double area = 0.0, flux = 0.0;
  for (std::size_t c = 0; c < end.columns.size(); ++c) {
    const double cell = end.fibre_height(c);
    const double depth = end.depth_in(c, state);
    for (std::size_t f = end.first_fibre[c]; f < end.first_fibre[c + 1]; ++f) {
      const double wet = std::clamp(depth - static_cast<double>(f - end.first_fibre[c]) * cell, 0.0, cell);
      area += end.columns[c].width * wet;
      flux += end.columns[c].width * wet * state.fibre_speeds[f];
    }
  }
  return area > 0.0 ? flux / area : 0.0;
}

}  // namespace

Inflow inflow_of_head(double gravity, double head, double invariant) {
  if (head <= 0.0) return {};
  const double still = std::sqrt(gravity * head);
  const double critical = std::sqrt(2.0 / 3.0) * still;
  double c = critical;
  if (invariant <= -2.0 * still) {
    c = still;
  } else if (invariant < -critical) {
    c = (-invariant + std::sqrt(3.0 * still * still - 0.5 * invariant * invariant)) / 3.0;
  }
  const double speed = std::min(c, invariant + 2.0 * c);
  return {c * c / gravity, speed, std::max(0.0, speed / c)};
}

template <int Dim>
void find_fibres(const OpenEnd<Dim>& end, const Flow<Dim>& flow, const Inflow& inflow, OpenEndState& state) {
  const std::vector<double> sums = sum_water_before(end, flow);
  const double height_squared = sums.back();
  state.fibre_speeds.resize(end.first_fibre.back());
  state.stretching = 0.0;
  if (height_squared == 0.0) return set_speeds_into_air(end, inflow, state);
  fit_speeds(end, sums, state);
  const double share = inflow.froude * inflow.froude;
  // Only water with a surface across the fibres can become deeper. It has none in a floor, where jets arrive at any
  // angle, and none in a full section, even if a jet rises to the lid before the buffer.
  const bool has_surface = end.gravity > 0.0 && !state.is_full && state.depth < end.height;
  if (has_surface) state.stretching = (1.0 - share) * sums[sums.size() - 2] / height_squared;
  if (share == 0.0) return;
  const double change = share * (-inflow.speed - mean_below_surface(end, state));
  for (double& speed : state.fibre_speeds) speed += change;
}

template void find_fibres<2>(const OpenEnd<2>&, const Flow<2>&, const Inflow&, OpenEndState&);
template void find_fibres<3>(const OpenEnd<3>&, const Flow<3>&, const Inflow&, OpenEndState&);

}  // namespace tailwater
