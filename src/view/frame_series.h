// The frames that a run writes for viewers, FOLDER/00000.frame, ... (docs/reference/view.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "base/box.h"
#include "base/vec.h"
#include "motion/affine_map.h"
#include "parallel/communicator.h"
#include "view/frame.h"

namespace tailwater {

/// The water of one rank at one instant. Borrows its values.
template <int Dim>
struct WaterNow {
  double time = 0.0;  ///< s
  std::span<const std::int64_t> id;
  std::span<const Vec<Dim>> position;            ///< m; finite
  std::vector<std::span<const double>> scalars;  ///< finite
  /// Poses of all moving objects, from where they are drawn; the same on all ranks.
  std::span<const AffineMap<Dim>> poses;
};

template <int Dim>
class FrameSeries {
 public:
  /// `spacing` [m] is that of the particles, `walls` the box around the solid geometry [m].
  FrameSeries(std::filesystem::path folder, double spacing, const Box<Dim>& walls);

  /// Writes a file NAME beside the frames. Makes the folder, as `write` does, where it is missing. Collective; throws
  /// IoError, on all ranks, as all functions here.
  void write_beside(std::string_view name, const std::string& text, const Communicator& ranks = {}) const;

  /// Adds a frame. Collective.
  void write(const WaterNow<Dim>& water, const Communicator& ranks = {});

  /// Continues after the first `count` frames, exactly as the run that wrote them would have, and removes later ones.
  /// Without these frames, or with damaged ones, continues with a key frame. Collective.
  void go_on(std::size_t count, const Communicator& ranks = {});

  /// Number of frames so far.
  std::size_t size() const { return count_; }

 private:
  std::filesystem::path file_of(std::size_t index) const;
  /// Writes a file of the stream. A user may remove the folder at any time to discard the stream: it is made again.
  void write_into_folder(const std::filesystem::path& path, const std::string& text) const;
  FrameScale scale_for(std::span<const double> extremes, std::size_t scalars) const;
  FrameParticles gather(const WaterNow<Dim>& water, const Communicator& ranks) const;
  std::optional<Frame> read_back(std::size_t count);

  std::filesystem::path folder_;
  double spacing_;
  Box<Dim> walls_;
  std::size_t count_ = 0;
  FrameScale scale_;     ///< scale of the last frame; the same on all ranks
  int since_key_ = -1;   ///< frames since the last key frame; -1: the next frame must be one
  FramesBefore before_;  ///< on the root
};

}  // namespace tailwater
