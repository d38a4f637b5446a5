// One line about how the run stands, on standard error: rewritten in place on a terminal, plain lines now and then
// elsewhere.
#pragma once

#include <chrono>
#include <string>

#include "flow/measure.h"
#include "flow/step.h"

namespace tailwater {

class Progress {
 public:
  Progress(double end_time, bool quiet);

  /// Shows the state after a step, if it is time for a new line.
  void show(double time, std::int64_t step, const StepReport& report, const FlowMeasures& measures);

  /// Ends the line in place, so that what follows starts on a line of its own.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  double end_time_;
  bool quiet_;
  bool is_terminal_;
  bool line_is_open_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_shown_;
  double last_share_ = -1.0;
};

/// What the line says after `elapsed` seconds of work; the most wanted first, since a narrow terminal cuts its end off.
std::string progress_line(double time, double end_time, double elapsed, std::int64_t step, const StepReport& report,
                          const FlowMeasures& measures);

/// "4.17 days", "1 h 02 min", "3 min 20 s", "12 s", "under 1 s"; `seconds` is not negative.
std::string readable_duration(double seconds);

}  // namespace tailwater
