#include "view/coarse_frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tailwater {
namespace {

constexpr double quantum_over_spacing = 1.0 / 32.0;

/// Scalars are even: 128 values, which need half as many bytes.
constexpr int step_of_scalars = 2;
constexpr double largest_even_scalar = 254.0;

/// The box and the ranges that contain those of all frames.
FrameScale common_scale(const std::vector<Frame>& frames, double spacing) {
  FrameScale scale = frames.front().head.scale;
  for (const Frame& frame : frames) {
    const FrameScale& other = frame.head.scale;
    for (std::size_t d = 0; d < scale.low.size(); ++d) {
      scale.low[d] = std::min(scale.low[d], other.low[d]);
      scale.high[d] = std::max(scale.high[d], other.high[d]);
    }
    for (std::size_t s = 0; s < scale.ranges.size(); ++s) {
      scale.ranges[s][0] = std::min(scale.ranges[s][0], other.ranges[s][0]);
      scale.ranges[s][1] = std::max(scale.ranges[s][1], other.ranges[s][1]);
    }
  }
  for (std::size_t d = 0; d < scale.low.size(); ++d) {
    scale.high[d] = std::max(scale.high[d], scale.low[d] + largest_place * quantum_over_spacing * spacing);
  }
  return scale;
}

/// Converts whole numbers from one scale to another: number k of the old one means low + k * step.
template <class Number>
void rescale(std::vector<Number>& numbers, double low, double step, double new_low, double new_step, double largest,
             int multiple) {
  for (Number& number : numbers) {
    const double exact = (low - new_low + step * number) / new_step;
    const double rounded = multiple * std::round(exact / multiple);
    number = static_cast<Number>(std::clamp(rounded, 0.0, largest));
  }
}

FrameParticles in_scale(FrameParticles particles, const FrameScale& old, const FrameScale& scale) {
  for (std::size_t d = 0; d < particles.place.size(); ++d) {
    rescale(particles.place[d], old.low[d], (old.high[d] - old.low[d]) / largest_place, scale.low[d],
            (scale.high[d] - scale.low[d]) / largest_place, largest_place, 1);
  }
  for (std::size_t s = 0; s < particles.scalar.size(); ++s) {
    const auto [old_low, old_high] = old.ranges[s];
    const auto [low, high] = scale.ranges[s];
    rescale(particles.scalar[s], old_low, (old_high - old_low) / largest_scalar, low, (high - low) / largest_scalar,
            largest_even_scalar, step_of_scalars);
  }
  return particles;
}

}  // namespace

std::size_t stride_of_sent(std::size_t frames) {
  return std::max<std::size_t>(1, (frames + frames_sent / 2) / frames_sent);
}

std::vector<std::string> encode_coarsely(const std::vector<Frame>& frames, std::uint32_t first, double spacing) {
  std::vector<std::string> encoded;
  if (frames.empty()) return encoded;
  const FrameScale scale = common_scale(frames, spacing);
  FramesBefore before;
  for (const Frame& frame : frames) {
    Frame coarse{frame.head, in_scale(frame.particles, frame.head.scale, scale)};
    coarse.head.order = static_cast<int>(std::min<std::size_t>(2, encoded.size()));
    coarse.head.index = first + static_cast<std::uint32_t>(encoded.size());
    coarse.head.scale = scale;
    encoded.push_back(encode_frame(coarse, before, Deflation::small));
    before.last_but_one = std::exchange(before.last, std::move(coarse.particles));
  }
  return encoded;
}

}  // namespace tailwater
