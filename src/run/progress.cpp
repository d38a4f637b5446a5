#include "run/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tailwater {
namespace {

constexpr auto terminal_interval = std::chrono::milliseconds(200);
constexpr auto plain_interval = std::chrono::seconds(60);
constexpr double plain_share = 0.05;

}  // namespace

std::string readable_duration(double seconds) {
  const auto whole = static_cast<long long>(std::llround(std::max(seconds, 0.0)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

Progress::Progress(double end_time, bool quiet)
    : end_time_(end_time), quiet_(quiet), is_terminal_(isatty(STDERR_FILENO) == 1) {}

void Progress::show(double time, std::int64_t step, const StepReport& report, const FlowMeasures& measures) {
  if (quiet_) return;
  const auto now = Clock::now();
  const double share = std::min(time / end_time_, 1.0);
  const bool is_first = last_share_ < 0.0;
  const bool is_due = is_terminal_ ? now - last_shown_ > terminal_interval
                                   : now - last_shown_ > plain_interval || share - last_share_ >= plain_share;
  if (!is_first && !is_due && share < 1.0) return;
  last_shown_ = now;
  last_share_ = share;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const std::string line = fmt::format(
      "t = {:.4f} s  {:5.1f} %  step {}  dt {:.2e} s  passes {}  iterations {}  residual {:.1e}  density error {:.2f} "
      "%  "
      "ETA {}",
      time, 100.0 * share, step, report.dt, report.passes, report.iterations, report.residual,
      100.0 * measures.density_error_largest, share > 0.0 ? readable_duration(elapsed * (1.0 - share) / share) : "?");
  if (is_terminal_) {
    fmt::print(stderr, "\r\033[K{}", line);
    line_is_open_ = true;
  } else {
    fmt::print(stderr, "{}\n", line);
  }
  std::fflush(stderr);
}

void Progress::finish() {
  if (line_is_open_) fmt::print(stderr, "\n");
  line_is_open_ = false;
}

}  // namespace tailwater
