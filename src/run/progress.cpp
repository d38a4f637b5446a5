#include "run/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tailwater {
namespace {

constexpr auto terminal_interval = std::chrono::milliseconds(200);
constexpr auto plain_interval = std::chrono::seconds(60);
constexpr double plain_share = 0.05;

std::size_t terminal_columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col : 80;
}

}  // namespace

std::string readable_duration(double seconds) {
  if (seconds < 0.5) return "under 1 s";
  if (seconds >= 48 * 3600) return fmt::format("{:.3g} days", seconds / 86400);
  const auto whole = std::llround(seconds);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string progress_line(double time, double end_time, double elapsed, std::int64_t step, const StepReport& report,
                          const FlowMeasures& measures) {
  const double share = std::min(time / end_time, 1.0);
  return fmt::format(
      "{:5.1f} %  t = {:.4f} s  ETA {}  step {}  dt {:.2e} s  passes {}  iterations {}  residual {:.1e}  density error "
      "{:.2f} %",
      100.0 * share, time, share > 0.0 ? readable_duration(elapsed * (1.0 - share) / share) : "?", step, report.dt,
      report.passes, report.iterations, report.residual, 100.0 * measures.density_error_largest);
}

Progress::Progress(double end_time, bool quiet, double elapsed)
    : end_time_(end_time),
      quiet_(quiet),
      is_terminal_(isatty(STDERR_FILENO) == 1),
      start_(Clock::now() - std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(elapsed))) {}

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
  std::string line = progress_line(time, end_time_, elapsed, step, report, measures);
  if (is_terminal_) {
    // A line that wraps cannot be rewritten in place.
    line.resize(std::min(line.size(), terminal_columns() - 1));
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
