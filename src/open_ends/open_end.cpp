#include "open_ends/open_end.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tailwater {
namespace {

constexpr double gauge_over_spacing = 2.0;

}  // namespace

double depth_at_speed(double invariant, double gravity, double u) {
  const double twice_celerity = std::max(0.0, u - invariant);
  return 0.25 * twice_celerity * twice_celerity / gravity;
}

template <int Dim>
OpenEnd<Dim>::OpenEnd(ChannelEnd<Dim> end, double spacing, double support)
    : ChannelEnd<Dim>(std::move(end)),
      stretch(support + spacing),
      gauge(gauge_over_spacing * spacing),
      columns(Dim == 2 ? 1 : std::max(1, static_cast<int>(std::lround(this->width / spacing)))) {}

template <int Dim>
double OpenEnd<Dim>::pressure_at(const OpenEndState& state, const Vec<Dim>& x, double density) const {
  if (this->gravity == 0.0 || !(state.is_wet || this->is_driven())) return 0.0;
  double level = this->floor + state.depth;
  if (!this->flow.feeds()) {
    const auto depth_at = [&](double speed) { return depth_at_speed(state.invariant, this->gravity, speed); };
    const double at_gauge = this->is_driven() ? state.depth_at_gauge : depth_at(state.speed);
    const double in_middle = this->is_driven() ? state.depth_in_middle : depth_at(state.speed_beyond);
    const double share = (this->opening.beyond(x) + stretch + gauge) / distance();
    level = this->floor + (1.0 - share) * at_gauge + share * in_middle;
  }
  return density * this->gravity * std::max(0.0, level - this->up.dot(x));
}

/// The water may become deeper or shallower. Then it is stretched along `rise`, and what it gains or loses along the
/// channel makes up for it: the field has no divergence, and the discharge at the opening is the prescribed one.
template <int Dim>
Vec<Dim> OpenEnd<Dim>::inflow_at(const OpenEndState& state, const Vec<Dim>& x) const {
  if (state.depth == 0.0) return Vec<Dim>::Zero();
  const double share = this->rise.dot(x - this->low) / state.depth;
  const double inside = -this->opening.beyond(x);
  const double row = state.rows > 0 ? 1.0 / static_cast<double>(state.rows) : 1.0;
  const double in = state.entry_speed * this->flow.profile_of_row(share, row) - inside * state.depth_rate / state.depth;
  return -in * this->opening.normal + share * state.depth_rate * this->rise;
}

template struct OpenEnd<2>;
template struct OpenEnd<3>;

}  // namespace tailwater
