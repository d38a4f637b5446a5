// All output of a run, during the run and at its end: fields, probes, tables, progress, summary. Functions are
// collective.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "case/spec.h"
#include "flow/flow.h"
#include "io/pvd_series.h"
#include "io/run_folder.h"
#include "probes/probe_set.h"
#include "run/progress.h"
#include "run/rank_log.h"
#include "run/result_limits.h"
#include "run/run_options.h"
#include "run/statistics.h"
#include "run/step_log.h"
#include "run/water_books.h"

namespace tailwater {

template <int Dim>
class RunOutput {
 public:
  /// The last check of a case: throws InputError for a probe in the wrong place, an end time out of reach or an
  /// unusable folder, and then leaves nothing behind. Otherwise creates the folder. Borrows `spec` and `options`.
  RunOutput(const CaseSpec& spec, const RunOptions& options, const Flow<Dim>& flow);

  const RunFolder& folder() const { return folder_; }

  /// Writes fields if they are due.
  void write_due_fields(const Flow<Dim>& flow);
  /// Records the probes that are due.
  void record_probes(const Flow<Dim>& flow, const FlowMeasures& measures);
  void record_sharing(const Flow<Dim>& flow, const Sharing& sharing);
  /// Writes and shows everything that follows a step. Throws SolverError, with fields for a look, beyond a limit of the
  /// case.
  void record_step(const Flow<Dim>& flow, const StepReport& report);

  /// Writes the last fields and the summary.
  void finish(const Flow<Dim>& flow, ExitCode code);
  /// Writes the summary of a failed run.
  void finish_failed(const Flow<Dim>& flow, const std::string& message);

 private:
  RunFolder make_folder(const Flow<Dim>& flow) const;
  void write_fields(const Flow<Dim>& flow);
  void warn_if_outside(const Flow<Dim>& flow, std::size_t outside);
  void write_summary(const Flow<Dim>& flow, const std::string& status, ExitCode code, const std::string& message);
  void tell_water(const Flow<Dim>& flow) const;

  const CaseSpec& spec_;
  const RunOptions& options_;
  Communicator ranks_;
  std::vector<Probe<Dim>> probe_list_;  // made before the folder: a probe in the wrong place leaves nothing behind
  RunFolder folder_;
  PvdSeries series_;
  PvdSeries wall_series_;            ///< only when a wall moves
  std::optional<StepLog> step_log_;  ///< on the root
  RankLog rank_log_;
  ProbeSet<Dim> probes_;
  Progress progress_;
  RunStatistics statistics_;
  ResultLimits limits_;
  Water water_at_start_;
  double next_fields_ = 0.0;  ///< s
  double last_fields_time_ = -1.0;
  bool warned_outside_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double cpu_start_;
};

}  // namespace tailwater
