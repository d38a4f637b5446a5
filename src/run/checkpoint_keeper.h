// Keeps the last moment from which a run can go on, and writes it as a checkpoint when that is due or asked for. So a
// checkpoint is written at once, whenever it is wanted, and a run that goes on from it repeats the last few steps.
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

  /// The run goes on from the checkpoint of this step, and every later one in the folder is of no use: it is removed.
  /// Collective; throws IoError, on all ranks.
  void go_on_from(std::int64_t step);

  /// Call right after particles were repartitioned and sorted.
  void remember(const Flow<Dim>& flow, const RunOutput<Dim>& output, double reference_step);

  /// Whether the interval of the case has passed since the last checkpoint was written. The root's clock counts.
  bool is_due() const;

  /// Writes what `remember` was given last, unless it is written. Keeps the last two files. Returns false if nothing
  /// was remembered yet. Collective; throws IoError, on all ranks.
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
