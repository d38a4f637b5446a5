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

std::vector<std::pair<std::string, double>> WaveRecord::summary() const {
  if (at(readings) == 0.0) return {};
  std::vector<std::pair<std::string, double>> lines{
      {"mean_m", mean()}, {"least_m", at(least)}, {"largest_m", at(largest)}};
  std::vector<double> heights(memory_->begin() + slots, memory_->end());
  if (heights.empty()) return lines;
  std::ranges::sort(heights, std::greater<>());
  const auto mean_of_highest = [&](std::size_t count) {
    return std::accumulate(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(count), 0.0) /
           static_cast<double>(count);
  };
  const auto count = static_cast<double>(heights.size());
  lines.emplace_back("waves", count);
  lines.emplace_back("height_mean_m", mean_of_highest(heights.size()));
  lines.emplace_back("height_third_m", mean_of_highest(std::max<std::size_t>(1, heights.size() / 3)));
  lines.emplace_back("height_largest_m", heights.front());
  lines.emplace_back("period_mean_s", (at(last) - at(first)) / count);
  return lines;
}

}  // namespace tailwater
