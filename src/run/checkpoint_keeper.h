// Keeps the last state from which a run can resume, and writes it as a checkpoint when that is due or requested. A
// requested checkpoint is therefore written at once, and a run that resumes from it repeats the last few steps.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "io/run_folder.h"
#include "run/checkpoint.h"
#include "run/run_output.h"

namespace tailwater {

template <int Dim>
class CheckpointKeeper {
 public:
  /// Borrows the folder.
  CheckpointKeeper(const CaseSpec& spec, const RunFolder& folder, const Communicator& ranks);

  /// Prepares the folder for a run that resumes from the checkpoint of this step: removes every later one, which is of
  /// no use. Collective; throws IoError, on all ranks.
  void go_on_from(std::int64_t step);

  /// Call right after particles were repartitioned and sorted.
  void remember(const Flow<Dim>& flow, const RunOutput<Dim>& output, double reference_step);

  /// Whether the interval of the case has passed since the last checkpoint was written. The root's clock counts.
  bool is_due() const;

  /// Writes the state of the last call of `remember`, unless it is written already. Keeps the last two files. Returns
  /// false if there is no such state yet. Collective; throws IoError, on all ranks.
  bool write(const Flow<Dim>& flow, const RunOutput<Dim>& output);

 private:
  using Clock = std::chrono::steady_clock;

  const RunFolder& folder_;
  Communicator ranks_;
  std::string case_text_;
  std::chrono::duration<double> interval_;
  std::optional<Checkpoint<Dim>> last_;
  std::optional<std::int64_t> written_step_;
  Clock::time_point written_at_ = Clock::now();
};

}  // namespace tailwater
