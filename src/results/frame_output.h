// The stream of a run for viewers: view/scene.json, and view/00000.frame, ... when they are due.
#pragma once

#include "base/json.h"
#include "case/spec.h"
#include "flow/flow.h"
#include "io/run_folder.h"
#include "results/schedule.h"
#include "view/frame_series.h"

namespace tailwater {

template <int Dim>
class FrameOutput {
 public:
  FrameOutput(const CaseSpec& spec, const RunFolder& folder, const Flow<Dim>& flow);

  /// Writes the scene. Collective; throws IoError, on all ranks, as all functions that write.
  void begin(const CaseSpec& spec, const Flow<Dim>& flow);
  /// Writes a frame if it is due.
  void write_due(const Flow<Dim>& flow);
  /// Writes a frame of the present time unless one is written already.
  void write(const Flow<Dim>& flow);

  /// The progress of the stream, for a checkpoint, and its continuation from one.
  Json saved() const;
  void restore(const Json& saved, const Communicator& ranks);

 private:
  FrameSeries<Dim> series_;
  Schedule schedule_;
  std::int64_t min_steps_;  ///< minimum from one due frame to the next
  std::int64_t next_step_ = 0;
};

}  // namespace tailwater
