// One frame: reading returns the written particles, for any particles that came or left since the previous frames.
#include "view/frame.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "base/error.h"
#include "io/temporary_folder.h"

namespace tailwater {
namespace {

/// Particles with these ids, at random places.
FrameParticles random_particles(std::vector<std::int64_t> ids, std::size_t dimension, std::mt19937& random) {
  FrameParticles particles;
  const std::size_t count = ids.size();
  particles.id = std::move(ids);
  std::uniform_int_distribution<int> place(0, 65535);
  particles.place.assign(dimension, std::vector<std::uint16_t>(count));
  particles.scalar.assign(2, std::vector<std::uint8_t>(count));
  for (auto& axis : particles.place) {
    for (auto& x : axis) x = static_cast<std::uint16_t>(place(random));
  }
  for (auto& scalar : particles.scalar) {
    for (auto& value : scalar) value = static_cast<std::uint8_t>(place(random) % 256);
  }
  return particles;
}

Frame frame_of(FrameParticles particles, int order, std::size_t dimension) {
  Frame frame;
  frame.head.order = order;
  frame.head.index = 7;
  frame.head.time = 0.125;
  frame.head.scale = {.low = std::vector<double>(dimension, -1.5),
                      .high = std::vector<double>(dimension, 2.25),
                      .ranges = {{-3.0F, 1e5F}, {0.0F, 2.5F}}};
  frame.head.poses = {std::vector<double>(dimension == 2 ? 3 : 7, 0.25)};
  frame.particles = std::move(particles);
  return frame;
}

std::vector<std::int64_t> counted(std::int64_t count) {
  std::vector<std::int64_t> ids(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<std::int64_t>(i);
  return ids;
}

class EachOrder : public testing::TestWithParam<int> {};

TEST_P(EachOrder, IsReadBackBitForBit) {
  std::mt19937 random(1);
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  for (const std::size_t dimension : {2U, 3U}) {
    // Removed since the last frame: the first particle, one inside and the last. Added: one before, one inside and one
    // behind all.
    const FramesBefore before{random_particles({5, 6, 7, 9, 12, 40}, dimension, random),
                              random_particles({5, 7, 9, 11, 40}, dimension, random)};
    for (const std::vector<std::int64_t>& ids :
         {std::vector<std::int64_t>{2, 6, 8, 9, 12, 1000000000000}, {5, 6, 7, 9, 12, 40}, {}, {41}, {-most, 7, most}}) {
      const Frame frame = frame_of(random_particles(ids, dimension, random), GetParam(), dimension);
      EXPECT_EQ(decode_frame(encode_frame(frame, before), before), frame);
    }
  }
}

TEST_P(EachOrder, OfTheSameParticlesIsReadBackBitForBit) {
  std::mt19937 random(4);
  const FramesBefore before{random_particles(counted(300), 3, random), random_particles(counted(300), 3, random)};
  const Frame frame = frame_of(random_particles(counted(300), 3, random), GetParam(), 3);
  EXPECT_EQ(decode_frame(encode_frame(frame, before), before), frame);
}

TEST_P(EachOrder, AnEmptyFrameCanComeBefore) {
  std::mt19937 random(2);
  const FramesBefore before{random_particles({}, 2, random), random_particles({1, 2}, 2, random)};
  const Frame frame = frame_of(random_particles({1, 2, 3}, 2, random), GetParam(), 2);
  EXPECT_EQ(decode_frame(encode_frame(frame, before), before), frame);
}

INSTANTIATE_TEST_SUITE_P(Frame, EachOrder, testing::Values(0, 1, 2));

/// Particles on parabolas, at constant acceleration: `step` frames later. Places wrap around, as in periodic water.
FrameParticles flying(std::int64_t count, int step) {
  FrameParticles particles;
  particles.id = counted(count);
  particles.place.assign(2, {});
  particles.scalar.assign(1, std::vector<std::uint8_t>(static_cast<std::size_t>(count), 100));
  for (std::int64_t i = 0; i < count; ++i) {
    particles.place[0].push_back(static_cast<std::uint16_t>(17 * i + (i % 50) * step));
    particles.place[1].push_back(static_cast<std::uint16_t>(31 * i - step * step));
  }
  return particles;
}

TEST(Frame, OrderTwoPredictsConstantVelocityAcrossAPeriodicEnd) {
  constexpr std::int64_t count = 20000;  // ids and places wrap around at 65536
  const FramesBefore before{flying(count, 1), flying(count, 0)};
  Frame frame = frame_of(flying(count, 2), 2, 2);
  frame.head.scale.ranges.resize(1);
  const std::string bytes = encode_frame(frame, before);
  EXPECT_EQ(decode_frame(bytes, before), frame);
  // All residuals are 0 along x and -2 along y: repeated bytes, for which deflate needs half a bit per particle at
  // most. Uncompressed they take 40.
  EXPECT_LT(bytes.size(), count / 16);
}

TEST(Frame, ADamagedOneIsTold) {
  std::mt19937 random(3);
  const FramesBefore before{random_particles(counted(50), 3, random), random_particles(counted(50), 3, random)};
  const std::string bytes = encode_frame(frame_of(random_particles(counted(60), 3, random), 2, 3), before);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW(decode_frame(bytes.substr(0, size), before), IoError) << size << " bytes";
  }
  EXPECT_THROW(decode_frame(bytes + "x", before), IoError);
  EXPECT_THROW(decode_frame(bytes, {}), IoError);  // follows other frames
  // For any wrong byte, the result is an error or a frame, without a large memory request.
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    std::string wrong = bytes;
    wrong[k] = static_cast<char>(wrong[k] ^ 0x55);
    try {
      decode_frame(wrong, before);
    } catch (const IoError&) {
      // reported
    }
  }
}

TEST(Frame, TheHeadAloneTellsWhatItIs) {
  std::mt19937 random(4);
  const Frame frame = frame_of(random_particles(counted(10), 3, random), 0, 3);
  const std::string bytes = encode_frame(frame, {});
  const FrameSummary summary = read_frame_head(std::string_view(bytes).substr(0, bytes.size() - 10));
  EXPECT_EQ(summary.head, frame.head);
  EXPECT_EQ(summary.count, 10U);
  EXPECT_EQ(summary.payload_begin + summary.payload_size, bytes.size());
}

TEST(Frame, AnotherFormatIsTold) {
  std::string bytes = encode_frame(frame_of({.id = {}, .place = {{}, {}}, .scalar = {{}, {}}}, 0, 2), {});
  bytes[4] = 99;
  EXPECT_NE(message_of<IoError>([&] { read_frame_head(bytes); }).find("format 99"), std::string::npos);
}

}  // namespace
}  // namespace tailwater
