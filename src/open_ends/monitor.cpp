// Warnings of open ends that miss their prescribed level or discharge.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "flow/flow.h"
#include "io/messages.h"
#include "open_ends/open_ends.h"

namespace tailwater {
namespace {

/// An inlet is reported when its volume is off by more than this fraction of the prescribed one and this many columns
/// of particles: some always wait for free space.
constexpr double max_missing = 0.02;
constexpr double columns_that_wait = 3.0;

/// The warning of an inlet through which the net volume that came in is less than prescribed by `missing` [m^3], which
/// may be below 0. `circulates` is whether its water comes from an outlet.
std::string discharge_warning(const std::string& label, double time, double missing, double asked, bool circulates) {
  std::string_view problem = "draws less water than";
  std::string_view remedy = "let it draw less, or make the opening or the water in front of it deeper";
  if (missing * asked < 0.0) {
    problem = "passes more water than";
    remedy = "let it pass less, or use a smaller spacing";
  } else if (missing > 0.0) {
    problem = "brings less water than";
    remedy = circulates ? "give a larger reserve, or let it bring less"
                        : "make the opening larger, or use a smaller spacing";
  }
  return fmt::format(
      "{} {} prescribed: at t = {:.4g} s the volume is off by {:.3g} of {:.3g} m^3 (water_balance in summary.json has "
      "what passed); remedy: {}",
      label, problem, time, std::abs(missing), std::abs(asked), remedy);
}

}  // namespace

template <int Dim>
bool OpenEnds<Dim>::is_first(const std::string& warning) {
  if (std::ranges::find(warnings_, warning) != warnings_.end()) return false;
  warnings_.push_back(warning);
  return true;
}

template <int Dim>
void OpenEnds<Dim>::warn(const Flow<Dim>& flow) {
  for (std::size_t e = 0; e < ends_.size(); ++e) {
    const OpenEnd<Dim>& end = ends_[e];
    const OpenEndState& state = states_[e];
    const std::string label = end.opening.label().text();
    if (state.miss.since >= 0.0 && is_first(label + ": level")) {
      tailwater::warn(
          "level-not-held",
          "{} does not hold its level: since t = {:.4g} s the water before it stands {:.3g} m too {}, more than the "
          "spacing of {:.3g} m; remedy: make the opening wider or deeper, move it away from jumps and jets, or change "
          "levels and discharges more slowly",
          label, state.miss.since, std::abs(state.miss.mean), state.miss.mean < 0.0 ? "low" : "high", end.spacing);
    }
    const double missing = state.missing();
    const double columns = columns_that_wait * end.spacing * end.area_below(state.depth);
    const bool falls_short = std::abs(missing) > max_missing * state.asked_total + columns;
    if (end.flow.feeds() && falls_short && is_first(label + ": discharge")) {
      tailwater::warn("discharge-not-met", "{}",
                      discharge_warning(label, flow.state.time, missing, state.asked, end.circuit >= 0));
    }
  }
}

template <int Dim>
void OpenEnds<Dim>::warn_at_end(const Flow<Dim>& flow) const {
  for (std::size_t e = 0; e < ends_.size(); ++e) {
    const LevelError& miss = states_[e].miss;
    if (miss.since < 0.0) continue;
    const std::string now =
        miss.lasts > 0.0 ? fmt::format("still {:.3g} m too {}", std::abs(miss.mean), miss.mean < 0.0 ? "low" : "high")
                         : "within a spacing again";
    tailwater::warn("level-off-at-end",
                    "at t = {:.4g} s the level at {} is {}; it was off for {:.3g} s, by up to {:.3g} m",
                    flow.state.time, ends_[e].opening.label(), now, miss.total, std::abs(miss.most));
  }
}

#define TAILWATER_INSTANTIATE(Dim)                           \
  template bool OpenEnds<Dim>::is_first(const std::string&); \
  template void OpenEnds<Dim>::warn(const Flow<Dim>&);       \
  template void OpenEnds<Dim>::warn_at_end(const Flow<Dim>&) const;
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
