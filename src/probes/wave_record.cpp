#include "probes/wave_record.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>

namespace tailwater {

WaveRecord::WaveRecord(double band) : band_(band) {
  memory_->assign(slots, 0.0);
  at(crest) = at(largest) = -std::numeric_limits<double>::max();
  at(trough) = at(least) = std::numeric_limits<double>::max();
}

double WaveRecord::mean() const {
  const double duration = at(time) - at(first_time);
  return duration > 0.0 ? at(integral) / duration : at(level);
}

void WaveRecord::add(double now, double reading) {
  const double before = at(level) - mean();
  if (at(readings) == 0.0) {
    at(first_time) = now;
  } else {
    at(integral) += 0.5 * (reading + at(level)) * (now - at(time));
  }
  const double step = now - at(time);
  at(time) = now;
  at(level) = reading;
  at(readings) += 1.0;
  at(least) = std::min(at(least), reading);
  at(largest) = std::max(at(largest), reading);
  at(crest) = std::max(at(crest), reading);
  at(trough) = std::min(at(trough), reading);
  const double after = reading - mean();
  if (before < 0.0 && after >= 0.0) at(rise) = now - step * after / (after - before);
  if (after < -band_) at(side) = -1.0;
  if (after > band_) {
    if (at(side) < 0.0) close_wave();
    at(side) = 1.0;
  }
}

void WaveRecord::close_wave() {
  if (at(first) == 0.0) {
    at(first) = at(rise);
  } else {
    memory_->push_back(at(crest) - at(trough));
  }
  at(last) = at(rise);
  at(crest) = at(trough) = at(level);
}

std::vector<double> WaveRecord::totals() const {
  if (at(readings) == 0.0) return {};
  std::vector<double> totals{mean(), at(least), at(largest)};
  std::vector<double> heights(memory_->begin() + slots, memory_->end());
  if (heights.empty()) return totals;
  std::ranges::sort(heights, std::greater<>());
  const auto mean_of_highest = [&](std::size_t count) {
    return std::accumulate(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(count), 0.0) /
           static_cast<double>(count);
  };
  const auto waves = static_cast<double>(heights.size());
  const std::size_t third = std::max<std::size_t>(1, heights.size() / 3);
  totals.insert(totals.end(), {waves, mean_of_highest(heights.size()), mean_of_highest(third), heights.front(),
                               (at(last) - at(first)) / waves});
  return totals;
}

}  // namespace tailwater
