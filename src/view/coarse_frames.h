// Frames for an exported file: fewer and coarser than those of the stream, and smaller by two thirds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "view/frame.h"

namespace tailwater {

/// Number of frames that are exported of a run, about every second one of a stream. A viewer interpolates between them.
inline constexpr std::size_t frames_sent = 200;

/// A key frame and its successors up to the next key frame.
inline constexpr std::size_t frames_per_key_sent = 20;

/// Stride between the exported frames, for a number of frames.
std::size_t stride_of_sent(std::size_t frames);

/// Encodes frames again, the first as a key frame, the others as predicted from the previous ones, with the indices
/// `first`, `first` + 1, ... Places are rounded to a 32nd of `spacing` [m], scalars to 128 values between the least and
/// the largest of the ranges of these frames. The frames have one dimension and the same scalars; there may be none.
std::vector<std::string> encode_coarsely(const std::vector<Frame>& frames, std::uint32_t first, double spacing);

}  // namespace tailwater
