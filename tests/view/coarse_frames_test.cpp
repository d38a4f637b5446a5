// Frames that are sent: the same particles, as near as the file says, in a third of the bytes.
#include "view/coarse_frames.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tailwater {
namespace {

constexpr double spacing = 0.02;

/// Water that sways, in a box with places of dx/128.
Frame swaying(int step) {
  Frame frame;
  frame.head.index = static_cast<std::uint32_t>(step);
  frame.head.time = 0.01 * step;
  // Another box and range each time, as after a key frame.
  const double low = -1.0 - 0.001 * step;
  const float most = 1.5F + 0.01F * static_cast<float>(step);
  frame.head.scale = {.low = {low, low}, .high = {low + 512 * spacing, low + 512 * spacing}, .ranges = {{-0.5F, most}}};
  frame.particles.place.resize(2);
  frame.particles.scalar.resize(1);
  for (int i = 0; i < 2000; ++i) {
    const double x = 0.02 * (i % 50) + 0.03 * std::sin(0.01 * step + 0.1 * i);
    const double y = 0.02 * (i / 50) + 0.03 * std::cos(0.013 * step + 0.2 * i);
    frame.particles.id.push_back(i + 5);
    int d = 0;
    for (const double c : {x, y}) {
      frame.particles.place[d++].push_back(static_cast<std::uint16_t>((c - low) / (512 * spacing) * 65535 + 0.5));
    }
    frame.particles.scalar[0].push_back(static_cast<std::uint8_t>((i + step) % 256));
  }
  return frame;
}

double place(const Frame& frame, std::size_t d, std::size_t i) {
  const FrameScale& scale = frame.head.scale;
  return scale.low[d] + (scale.high[d] - scale.low[d]) * frame.particles.place[d][i] / 65535.0;
}
double scalar(const Frame& frame, std::size_t i) {
  const auto [low, high] = frame.head.scale.ranges[0];
  return low + (high - low) * frame.particles.scalar[0][i] / 255.0;
}

TEST(CoarseFrames, HoldTheSameWaterInFewerBytes) {
  std::vector<Frame> frames;
  std::size_t bytes = 0;
  FramesBefore before;
  for (int step = 0; step < 7; ++step) {
    frames.push_back(swaying(2 * step));
    bytes += encode_frame(frames.back(), before).size();
  }
  const std::vector<std::string> sent = encode_coarsely(frames, 40, spacing);
  ASSERT_EQ(sent.size(), frames.size());
  std::size_t sent_bytes = 0;
  for (std::size_t k = 0; k < sent.size(); ++k) {
    const Frame read = decode_frame(sent[k], before);
    EXPECT_EQ(read.head.order, std::min<int>(2, static_cast<int>(k)));
    EXPECT_EQ(read.head.index, 40 + k);
    EXPECT_EQ(read.head.time, frames[k].head.time);
    ASSERT_EQ(read.particles.id, frames[k].particles.id);
    for (std::size_t i = 0; i < read.particles.size(); ++i) {
      for (std::size_t d = 0; d < 2; ++d) {
        EXPECT_LE(std::abs(place(read, d, i) - place(frames[k], d, i)), 0.5001 * spacing / 32);
      }
      EXPECT_LE(std::abs(scalar(read, i) - scalar(frames[k], i)), 1.5 * 2.2 / 127);
    }
    sent_bytes += sent[k].size();
    before.last_but_one = std::exchange(before.last, read.particles);
  }
  EXPECT_LT(sent_bytes, bytes / 2);
}

TEST(CoarseFrames, AreSomeTwoHundred) {
  EXPECT_EQ(stride_of_sent(0), 1);
  EXPECT_EQ(stride_of_sent(12), 1);
  EXPECT_EQ(stride_of_sent(401), 2);
  EXPECT_EQ(stride_of_sent(1000), 5);
  EXPECT_TRUE(encode_coarsely({}, 0, spacing).empty());
}

}  // namespace
}  // namespace tailwater
