// One frame of the stream that a run writes for viewers (docs/reference/view.md): places and scalars of its particles
// as small whole numbers. A frame holds only the differences from a prediction by the previous frames.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tailwater {

inline constexpr int frame_format = 1;

/// The whole numbers at the high side of the box, and at the high end of a scalar's range.
inline constexpr double largest_place = 65535.0;
inline constexpr double largest_scalar = 255.0;

/// The scale of the whole numbers; constant from a key frame to the next.
struct FrameScale {
  std::vector<double> low;                   ///< m; corner of the box whose places are stored, one per dimension
  std::vector<double> high;                  ///< m
  std::vector<std::array<float, 2>> ranges;  ///< least and largest value of each scalar

  bool operator==(const FrameScale&) const = default;
};

/// The particles of a frame as they are stored, by ascending id.
struct FrameParticles {
  std::vector<std::int64_t> id;
  /// for each dimension: 0 at the box's low side, 65535 at its high one
  std::vector<std::vector<std::uint16_t>> place;
  std::vector<std::vector<std::uint8_t>>
      scalar;  ///< for each scalar: 0 at the low end of its range, 255 at the high one

  std::size_t size() const { return id.size(); }
  bool operator==(const FrameParticles&) const = default;
};

struct FrameHead {
  int order = 0;  ///< 0: a key frame; 1: predicted from the previous frame; 2: from the two previous frames
  std::uint32_t index = 0;
  double time = 0.0;  ///< s
  FrameScale scale;
  std::vector<std::vector<double>> poses;  ///< of each moving object: x, y, angle; or x, y, z, qw, qx, qy, qz

  std::size_t dimension() const { return scale.low.size(); }
  bool operator==(const FrameHead&) const = default;
};

struct Frame {
  FrameHead head;
  FrameParticles particles;

  bool operator==(const Frame&) const = default;
};

/// The particles of the previous frames, of the same scale.
struct FramesBefore {
  FrameParticles last;          ///< for orders 1 and 2
  FrameParticles last_but_one;  ///< for order 2
};

enum class Deflation {
  quick,  ///< while a run waits for it
  small,  ///< 6 % smaller, in ten times the time
};

/// The bytes of a frame; equal frames give equal bytes.
std::string encode_frame(const Frame& frame, const FramesBefore& before, Deflation deflation = Deflation::quick);

struct FrameSummary {
  FrameHead head;
  std::uint32_t count = 0;
  std::size_t payload_begin = 0;  ///< bytes
  std::size_t payload_size = 0;   ///< bytes; as deflated
  std::size_t raw_size = 0;       ///< bytes
};
/// Reads the summary from a frame's first bytes; the others may be missing. Throws IoError.
FrameSummary read_frame_head(std::string_view bytes);

/// The inverse of encode_frame. Throws IoError if the bytes are not a whole frame that follows the previous ones.
Frame decode_frame(std::string_view bytes, const FramesBefore& before);

}  // namespace tailwater
