// A checkpoint: all that a run needs to go on bit for bit, and the file that holds it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/json.h"
#include "case/spec.h"
#include "flow/flow.h"
#include "io/sealed_file.h"

namespace tailwater {

/// The version of the contents of a checkpoint. It grows when they change.
inline constexpr int checkpoint_format = 19;

/// A moment at which particles have just been repartitioned and sorted, so that lists are forgotten and the
/// state is complete.
template <int Dim>
struct Checkpoint {
  SavedFlow<Dim> flow;               ///< of this rank
  Json output;                       ///< how far the run's output has come (RunOutput::saved); on all ranks
  std::vector<double> probe_memory;  ///< of the probes (ProbeSet::memory); on all ranks
  std::vector<double> rank_log;      ///< of this rank (RankLog::saved)
  double reference_step = 0.0;       ///< s (StepGuard); the same on all ranks
  std::string cuts;                  ///< of this rank (SpaceCuts::bytes); empty if space must be cut anew
  bool is_repartitioned = true;      ///< false where it was written by another number of ranks
};

/// Writes the checkpoint of all ranks as one file, which is on the disk when this returns. `case_text` is the effective
/// case. Collective; throws IoError, on all ranks.
template <int Dim>
void write_checkpoint(const std::filesystem::path& path, const Checkpoint<Dim>& checkpoint,
                      const std::string& case_text, const Communicator& ranks);

/// The checkpoint in a file that the root has read; `file` counts there only. Another number of ranks than wrote it
/// gets equal shares of the particles. Collective; throws IoError, on all ranks.
template <int Dim>
Checkpoint<Dim> read_checkpoint(const SealedFile& file, const Communicator& ranks);

/// The case of a checkpoint. Throws IoError.
CaseSpec case_of_checkpoint(const SealedFile& file);

}  // namespace tailwater
