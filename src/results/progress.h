// One line about the progress of the run. On a terminal it is rewritten in place; elsewhere, and in the log, plain
// lines are written now and then.
#pragma once

#include <chrono>
#include <string>

#include "flow/measure.h"
#include "flow/step.h"
#include "io/messages.h"

namespace tailwater {

/// Decides when a line is due, and writes the line.
class ProgressLine {
 public:
  /// Shows `make_line()` if a new line is due, with the fraction `share` of the work done.
  template <class MakeLine>
  void show(double share, const MakeLine& make_line) {
    if (is_due(share)) put(share, make_line());
  }

 private:
  using Clock = std::chrono::steady_clock;

  bool is_due(double share);
  void put(double share, const std::string& line);

  bool is_on_terminal_ = is_on_terminal();
  bool plain_is_due_ = false;
  bool live_is_due_ = false;
  Clock::time_point last_live_;
  Clock::time_point last_plain_;
  double last_plain_share_ = -1.0;
};

class Progress {
 public:
  /// `elapsed` [s]: time of the earlier runs that this one continues.
  explicit Progress(double end_time, double elapsed = 0.0);

  /// Shows the state after a step if a new line is due.
  void show(double time, std::int64_t step, const StepReport& report, const FlowMeasures& measures);

 private:
  using Clock = std::chrono::steady_clock;

  double end_time_;
  Clock::time_point start_;
  ProgressLine line_;
};

/// The line after `elapsed` seconds of computing. The most important number comes first, because a narrow terminal cuts
/// off the end.
std::string progress_line(double time, double end_time, double elapsed, std::int64_t step, const StepReport& report,
                          const FlowMeasures& measures);

/// "4.17 days", "1 h 02 min", "3 min 20 s", "12 s", "under 1 s"; `seconds` is not negative.
std::string readable_duration(double seconds);

}  // namespace tailwater
