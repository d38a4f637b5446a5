// A checkpoint: all data that a run needs to resume with bit-identical results, and their file.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/json.h"
#include "case/spec.h"
#include "flow/flow.h"
#include "flow/saved_flow.h"
#include "io/sealed_file.h"

namespace tailwater {

/// Version of the contents of a checkpoint. It increases when they change.
inline constexpr int checkpoint_format = 28;

/// The state of a run just after particles have been repartitioned and sorted. The lists are discarded then, so the
/// state is complete.
template <int Dim>
struct Checkpoint {
  SavedFlow<Dim> flow;               ///< flow of this rank
  Json output;                       ///< progress of the run's output (RunOutput::saved); on all ranks
  std::vector<double> probe_memory;  ///< state of the probes (ProbeSet::memory); on all ranks
  std::vector<double> rank_log;      ///< sums of this rank (RankLog::saved)
  double reference_step = 0.0;       ///< s (StepGuard); the same on all ranks
  std::string cuts;                  ///< of this rank (SpaceCuts::bytes); empty if space must be divided again
  bool is_repartitioned = true;      ///< false where it was written by another number of ranks
};

/// Writes the checkpoint of all ranks as one file, which is on the disk when this function returns. `case_text` is the
/// effective case. Collective; throws IoError, on all ranks.
template <int Dim>
void write_checkpoint(const std::filesystem::path& path, const Checkpoint<Dim>& checkpoint,
                      const std::string& case_text, const Communicator& ranks);

/// The checkpoint in a file that the root has read; `file` counts there only. If the number of ranks has changed, each
/// gets an equal part of the particles. Collective; throws IoError, on all ranks.
template <int Dim>
Checkpoint<Dim> read_checkpoint(const SealedFile& file, const Communicator& ranks);

/// The case of a checkpoint. Throws IoError.
CaseSpec case_of_checkpoint(const SealedFile& file);

/// [s] of the run. Throws IoError.
double time_of_checkpoint(const SealedFile& file);

}  // namespace tailwater
