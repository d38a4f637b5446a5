#include "results/end_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/messages.h"

namespace tailwater {
namespace {

/// An inlet is short of water when more than this share of what is asked for is missing, and more than so many columns
/// of particles: some always wait for room.
constexpr double most_missing = 0.02;
constexpr double columns_that_wait = 3.0;

}  // namespace

bool OpenEndMonitor::is_first(const std::string& what) {
  if (std::ranges::find(told_, what) != told_.end()) return false;
  told_.push_back(what);
  return true;
}

template <int Dim>
void OpenEndMonitor::update(const Flow<Dim>& flow) {
  const double spacing = flow.setup.spacing;
  for (std::size_t e = 0; e < flow.setup.open_ends.size(); ++e) {
    const OpenEnd<Dim>& end = flow.setup.open_ends[e];
    const OpenEndState& state = flow.state.open_ends[e];
    const std::string label = end.opening.label();
    if (state.miss.since >= 0.0 && is_first(label + ": level")) {
      warn(
          "{} does not hold its level: since t = {:.4g} s the water before it stands {:.3g} m too {}, more than the "
          "spacing of {:.3g} m; the end of the run tells how long. Remedy: a wider or deeper opening, or levels and "
          "discharges that change more slowly",
          label, state.miss.since, std::abs(state.miss.mean), state.miss.mean < 0.0 ? "low" : "high", spacing);
    }
    if (!end.flow.feeds() || end.circuit >= 0) continue;
    const double missing = state.asked - (state.arrived.volume - state.departed.volume);
    const double columns = columns_that_wait * spacing * state.depth * end.width;
    if (missing > most_missing * std::abs(state.asked) + columns && is_first(label + ": discharge")) {
      warn(
          "{} does not bring what it should: at t = {:.4g} s {:.3g} of {:.3g} m^3 are missing, for want of room; "
          "water_balance in summary.json tells what came. Remedy: a higher opening, or a smaller spacing",
          label, flow.state.time, missing, state.asked);
    }
  }
}

template <int Dim>
void OpenEndMonitor::warn_of_end(const Flow<Dim>& flow) const {
  for (std::size_t e = 0; e < flow.setup.open_ends.size(); ++e) {
    const LevelError& miss = flow.state.open_ends[e].miss;
    if (miss.since < 0.0) continue;
    const std::string now =
        miss.lasts > 0.0 ? fmt::format("still {:.3g} m too {}", std::abs(miss.mean), miss.mean < 0.0 ? "low" : "high")
                         : "within a spacing again";
    warn("at t = {:.4g} s the level at {}, not held for {:.3g} s and off by {:.3g} m at the most, is {}",
         flow.state.time, flow.setup.open_ends[e].opening.label(), miss.total, std::abs(miss.most), now);
  }
}

Json OpenEndMonitor::saved() const { return told_; }

void OpenEndMonitor::restore(const Json& saved) { saved.get_to(told_); }

template void OpenEndMonitor::update(const Flow<2>&);
template void OpenEndMonitor::update(const Flow<3>&);
template void OpenEndMonitor::warn_of_end(const Flow<2>&) const;
template void OpenEndMonitor::warn_of_end(const Flow<3>&) const;

}  // namespace tailwater
