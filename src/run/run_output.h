// All output of a run, during the run and at its end: fields, probes, tables, progress, summary. Functions are
// collective.
#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/json.h"
#include "case/spec.h"
#include "flow/flow.h"
#include "io/pvd_series.h"
#include "io/run_folder.h"
#include "neighbours/decomposition.h"
#include "probes/probe_set.h"
#include "results/crowding_watch.h"
#include "results/frame_output.h"
#include "results/measurements.h"
#include "results/probe_results.h"
#include "results/progress.h"
#include "results/rank_log.h"
#include "results/result_limits.h"
#include "results/schedule.h"
#include "results/statistics.h"
#include "results/step_log.h"
#include "results/water_balance.h"
#include "run/run_options.h"

namespace tailwater {

template <int Dim>
class RunOutput {
 public:
  /// The last check of a case. It throws InputError for a probe in the wrong place, an end time out of reach or an
  /// unusable folder, and then leaves no files. Otherwise it creates the folder. Borrows `spec` and `options`. `kept`
  /// is the result of `saved` of an earlier run: its files are continued, and their later parts are cut off.
  RunOutput(const CaseSpec& spec, const RunOptions& options, const Flow<Dim>& flow, const Json* kept = nullptr);

  const RunFolder& folder() const { return folder_; }
  RankLog& rank_log() { return rank_log_; }
  const RankLog& rank_log() const { return rank_log_; }

  /// The progress of the output, for a checkpoint: clocks, sums, and the sizes of all files. Not collective; the sizes
  /// are those of the root.
  Json saved() const;
  /// The state of the probes, and its restoration (probe_set.h).
  std::vector<double> probe_memory() const { return probes_.memory(); }
  void restore_probe_memory(std::span<const double> memory) { probes_.restore(memory, folder_.checkpoints()); }
  /// Adds the cost of the run so far to `saved`. Collective.
  void add_costs(Json& saved) const;

  /// Writes the summary of a running run, which remains if the program is killed.
  void begin(const Flow<Dim>& flow);

  /// Writes fields, and a frame for viewers, if they are due.
  void write_due_fields(const Flow<Dim>& flow);
  /// Records the probes that are due after a step of dt [s]; 0 at the start.
  void record_probes(const Flow<Dim>& flow, const FlowMeasures& measures, double dt = 0.0);
  void record_repartition(const Flow<Dim>& flow, const Repartition& repartition);
  /// Writes and shows all output that follows a step. Throws SolverError beyond a limit of the case, after writing
  /// fields for inspection.
  void record_step(const Flow<Dim>& flow, const StepReport& report);

  /// Writes the last fields and the summary.
  void finish(const Flow<Dim>& flow, ExitCode code);
  /// Writes the summary of a failed run, if possible.
  void finish_failed(const Flow<Dim>& flow, ExitCode code, const std::string& message);

 private:
  using Clock = std::chrono::steady_clock;

  RunFolder make_folder(const Flow<Dim>& flow, bool goes_on) const;
  void restore(const Json& kept);
  void require_folder_in_place();
  double wall_seconds() const;  ///< includes the earlier runs, as cpu_seconds does
  double cpu_seconds() const;   ///< of all ranks; collective
  void write_fields(const Flow<Dim>& flow);
  void warn_if_outside(const Flow<Dim>& flow, std::size_t outside);
  void write_summary(const Flow<Dim>& flow, const std::string& status, std::optional<ExitCode> code,
                     const std::string& message);
  void tell_water(const Flow<Dim>& flow) const;
  void tell_results() const;

  const CaseSpec& spec_;
  const RunOptions& options_;
  std::string case_file_;  ///< as named in the summary
  Communicator ranks_;
  std::vector<Probe<Dim>> probe_list_;  // made before the folder: a probe in the wrong place leaves no files
  RunFolder folder_;
  PvdSeries series_;
  PvdSeries wall_series_;  ///< only when a wall moves
  FrameOutput<Dim> frames_;
  std::optional<StepLog> step_log_;  ///< on the root
  RankLog rank_log_;
  ProbeSet<Dim> probes_;
  Progress progress_;
  RunStatistics statistics_;
  ResultLimits limits_;
  CrowdingWatch crowding_;
  std::vector<ProbeResult> results_;  ///< at the end, on the root
  std::vector<MeasurementScore> scores_;
  WaterAmount water_at_start_;
  Schedule fields_schedule_;
  bool warned_outside_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_look_at_folder_;
  double cpu_start_;
  // Totals of the earlier runs that this one continues.
  double wall_seconds_before_ = 0.0;
  double cpu_seconds_before_ = 0.0;
  int runs_before_ = 0;
};

}  // namespace tailwater
