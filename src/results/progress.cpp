#include "results/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tailwater {
namespace {

constexpr auto live_interval = std::chrono::milliseconds(200);
constexpr auto plain_interval = std::chrono::seconds(60);
constexpr double plain_share = 0.05;

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
      "{:.2f} % rms, {:.2f} % mean",
      100.0 * share, time, share > 0.0 ? readable_duration(elapsed * (1.0 - share) / share) : "?", step, report.dt,
      report.passes, report.iterations, report.residual, 100.0 * measures.density_error_rms,
      100.0 * measures.density_error_mean);
}

Progress::Progress(double end_time, double elapsed)
    : end_time_(end_time),
      start_(Clock::now() - std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(elapsed))) {}

void Progress::show(double time, std::int64_t step, const StepReport& report, const FlowMeasures& measures) {
  line_.show(std::min(time / end_time_, 1.0), [&] {
    const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
    return progress_line(time, end_time_, elapsed, step, report, measures);
  });
}

bool ProgressLine::is_due(double share) {
  const auto now = Clock::now();
  const bool is_end = last_plain_share_ < 0.0 || share >= 1.0;  // the first line or the last
  plain_is_due_ = is_end || now - last_plain_ > plain_interval || share - last_plain_share_ >= plain_share;
  live_is_due_ = is_on_terminal_ && (is_end || now - last_live_ > live_interval);
  return plain_is_due_ || live_is_due_;
}

void ProgressLine::put(double share, const std::string& line) {
  const auto now = Clock::now();
  if (live_is_due_) {
    last_live_ = now;
    show_live(line);
  }
  if (!plain_is_due_) return;
  last_plain_ = now;
  last_plain_share_ = share;
  if (is_on_terminal_) {
    log_line(line);
  } else {
    tell(line);
  }
}

}  // namespace tailwater
