#include "open_ends/open_end.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tailwater {
namespace {

constexpr double gauge_over_spacing = 2.0;
constexpr double height_of_spray = 2.0;  // dx; water in a buffer that is so high above the surface falls

}  // namespace

template <int Dim>
OpenEnd<Dim>::OpenEnd(ChannelEnd<Dim> end, const Vec<Dim>& gravity_of_case, double particle_spacing, double support)
    : ChannelEnd<Dim>(std::move(end)),
      full_gravity(gravity_of_case),
      spacing(particle_spacing),
      stretch(support + particle_spacing),
      gauge(gauge_over_spacing * particle_spacing),
      first_fibre{0} {
  for (const SectionColumn& column : this->columns) {
    const auto fibres = std::max(1L, std::lround((column.top - column.bottom) / spacing));
    first_fibre.push_back(first_fibre.back() + static_cast<std::size_t>(fibres));
  }
}

template <int Dim>
std::size_t OpenEnd<Dim>::column_at(const Vec<Dim>& x) const {
  const double place = this->aside.dot(x - this->low);
  const auto beyond = std::ranges::partition_point(
      this->columns, [&](const SectionColumn& column) { return column.aside + 0.5 * column.width <= place; });
  return std::min(static_cast<std::size_t>(beyond - this->columns.begin()), this->columns.size() - 1);
}

template <int Dim>
double OpenEnd<Dim>::height_in(std::size_t column, const Vec<Dim>& x) const {
  return this->rise.dot(x - this->low) - this->columns[column].bottom;
}

template <int Dim>
double OpenEnd<Dim>::fibre_height(std::size_t column) const {
  const SectionColumn& of = this->columns[column];
  return (of.top - of.bottom) / static_cast<double>(first_fibre[column + 1] - first_fibre[column]);
}

template <int Dim>
double OpenEnd<Dim>::depth_in(std::size_t column, const OpenEndState& state) const {
  const SectionColumn& of = this->columns[column];
  return std::clamp(state.depth - of.bottom, 0.0, of.top - of.bottom);
}

/// Hydrostatic below the water's surface at the border, and farther on less by the acceleration of the buffer, which
/// has inertia as the water before it has, and by the resistance of a layer that continues there. The pressure of a
/// wave that leaves falls with the depth. Below a level that is above the opening, what comes in has the energy of the
/// water at rest beyond, each fibre for itself.
template <int Dim>
double OpenEnd<Dim>::pressure_at(const OpenEndState& state, const Vec<Dim>& x, const Vec<Dim>& velocity,
                                 const Vec<Dim>& deceleration, double density) const {
  const double drop = (state.acceleration + this->opening.normal.dot(deceleration)) * behind_border(x);
  if (!state.is_full) {
    const double z = std::clamp(this->up.dot(x) - this->floor, 0.0, state.depth);
    const double k = state.wave.number;
    const double below_wave = state.wave.height * (1.0 - std::cosh(k * z) / std::cosh(k * state.depth));
    const double hydrostatic = this->floor + state.depth - this->up.dot(x);
    return density * std::max(0.0, this->gravity * (hydrostatic - below_wave) - drop);
  }
  const Vec<Dim>& normal = this->opening.normal;
  const double at_rest = this->gravity > 0.0 ? this->gravity * (state.level - this->up.dot(x)) +
                                                   normal.dot(full_gravity) * this->opening.beyond(x)
                                             : full_gravity.norm() * state.level + full_gravity.dot(x);
  const double in = std::min(0.0, normal.dot(velocity));
  return density * std::max(0.0, at_rest - drop - 0.5 * in * in);
}

template <int Dim>
Vec<Dim> OpenEnd<Dim>::velocity_at(const OpenEndState& state, const Vec<Dim>& x) const {
  if (this->flow.feeds()) return inflow_at(state, x);
  const double above_bottom = height_in(column_at(x), x);
  return (fibre_speed_at(state, x) - state.stretching * behind_border(x)) * this->opening.normal +
         state.stretching * above_bottom * this->rise + fall_at(state, x);
}

/// Velocity [m/s] of water high above the surface relative to the rest: it falls. Otherwise the stretching would lift
/// it without end where it stands still, as beside the banks of a river that leaves in its middle. Where it lands on
/// the water below it spreads outwards: the field has no divergence, so falling water does not pile up.
template <int Dim>
Vec<Dim> OpenEnd<Dim>::fall_at(const OpenEndState& state, const Vec<Dim>& x) const {
  if (state.is_full || this->gravity <= 0.0) return Vec<Dim>::Zero();
  const double surface = std::max(state.surface, state.depth) + height_of_spray * spacing;
  const double above = (this->up.dot(x) - this->floor - surface) / spacing;
  if (above <= 0.0) return Vec<Dim>::Zero();
  const double speed = std::sqrt(this->gravity * spacing);
  if (above >= 1.0) return -speed * this->up;
  return speed * (behind_border(x) / spacing * this->opening.normal - above * this->up);
}

/// The water may become deeper or shallower. Then it is stretched along `rise` and compressed along the channel by
/// as much: the field has no divergence. The discharge at the border of the buffer is the prescribed one. At the
/// opening it is larger by the rate at which the volume of the buffer grows.
template <int Dim>
Vec<Dim> OpenEnd<Dim>::inflow_at(const OpenEndState& state, const Vec<Dim>& x) const {
  const std::size_t column = column_at(x);
  const double depth = depth_in(column, state);
  if (depth == 0.0) return Vec<Dim>::Zero();
  const double share = height_in(column, x) / depth;
  const auto rows = column < state.rows.size() ? state.rows[column] : 0;
  const double row = rows > 0 ? 1.0 / static_cast<double>(rows) : 1.0;
  const double in = state.entry_speed * this->flow.profile_of_row(share, row) +
                    behind_border(x) * state.depth_rate / std::max(depth, spacing);
  return -in * this->opening.normal + share * state.depth_rate * this->rise;
}

/// Linear between the middles of the cells.
template <int Dim>
double OpenEnd<Dim>::fibre_speed_at(const OpenEndState& state, const Vec<Dim>& x) const {
  if (state.fibre_speeds.empty()) return 0.0;
  const auto in_column = [&](std::size_t c) {
    const std::size_t first = first_fibre[c];
    const auto last = static_cast<double>(first_fibre[c + 1] - first - 1);
    const double place = std::clamp(height_in(c, x) / fibre_height(c) - 0.5, 0.0, last);
    const auto k = first + static_cast<std::size_t>(place);
    const std::size_t next = std::min(k + 1, first_fibre[c + 1] - 1);
    return std::lerp(state.fibre_speeds[k], state.fibre_speeds[next], place - std::floor(place));
  };
  const std::size_t c = column_at(x);
  const double off = (this->aside.dot(x - this->low) - this->columns[c].aside) / this->columns[c].width;
  const std::size_t beside = off < 0.0 ? c - std::min<std::size_t>(c, 1) : std::min(c + 1, this->columns.size() - 1);
  return std::lerp(in_column(c), in_column(beside), std::min(std::abs(off), 0.5));
}

template struct OpenEnd<2>;
template struct OpenEnd<3>;

}  // namespace tailwater
