// Frames that are sent in a file: fewer and coarser than those of the stream, and smaller by two thirds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "view/frame.h"

namespace tailwater {

/// A run is sent in some so many frames: every second one of a stream. What is between them a viewer interpolates.
inline constexpr std::size_t frames_sent = 200;

/// A key frame, and those behind it until the next.
inline constexpr std::size_t frames_per_key_sent = 20;

/// Every which frame of so many is sent.
std::size_t stride_of_sent(std::size_t frames);

/// Encodes frames anew, the first as a key frame, the others as predicted from those before, with the indices `first`,
/// `first` + 1, ... Places are rounded to a 32nd of `spacing` [m], scalars to 128 values between the least and the
/// largest of the ranges that these frames have. Frames: of one dimension, with the same scalars; may be none.
std::vector<std::string> encode_coarsely(const std::vector<Frame>& frames, std::uint32_t first, double spacing);

}  // namespace tailwater
