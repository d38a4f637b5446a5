#include "run/requests.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>

#include "io/write_file.h"
#include "parallel/together.h"

namespace tailwater {
namespace {

/// Long enough for a file system that serves a whole cluster.
constexpr auto time_between_looks_for_files = std::chrono::milliseconds(100);

/// Time kept for the end of a run, in units of the longest step so far with all its output: for the present step, the
/// checkpoint and the last fields.
constexpr double steps_kept_for_the_end = 3.0;
/// Minimum fraction of the wall time that is kept for the end.
constexpr double share_kept_for_the_end = 0.01;

volatile std::sig_atomic_t stop_signal_has_come = 0;
volatile std::sig_atomic_t hang_up_has_come = 0;

void note_stop(int) { stop_signal_has_come = 1; }
void note_hang_up(int) { hang_up_has_come = 1; }

}  // namespace

Requests::Requests(const RunFolder& folder, const Communicator& ranks, const WallTime& wall_time)
    : stop_file_(folder.stop()), checkpoint_file_(folder.checkpoint_request()), ranks_(ranks), wall_time_(wall_time) {
  stop_signal_has_come = 0;
  hang_up_has_come = 0;
  struct sigaction action {};
  action.sa_handler = note_stop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &old_interrupt_);
  sigaction(SIGTERM, &action, &old_terminate_);
  sigaction(SIGUSR1, &action, &old_user_);
  action.sa_handler = note_hang_up;
  action.sa_flags = SA_RESTART;
  sigaction(SIGHUP, &action, &old_hang_up_);
}

Requests::~Requests() {
  sigaction(SIGINT, &old_interrupt_, nullptr);
  sigaction(SIGTERM, &old_terminate_, nullptr);
  sigaction(SIGUSR1, &old_user_, nullptr);
  sigaction(SIGHUP, &old_hang_up_, nullptr);
}

Asked Requests::look(bool checkpoint_is_due) {
  const auto now = Clock::now();
  bool time_has_come = false;
  if (ranks_.is_root()) {
    look_for_files(now);
    time_has_come = time_is_up(now);
  }
  double stop = stop_signal_has_come != 0 || stop_was_found_ || time_has_come;
  double checkpoint = hang_up_has_come != 0 || checkpoint_was_found_ || checkpoint_is_due;
  ranks_.largest_each(stop, checkpoint);
  return {stop != 0.0, checkpoint != 0.0};
}

void Requests::look_for_files(Clock::time_point now) {
  if (now - last_look_for_files_ < time_between_looks_for_files) return;
  last_look_for_files_ = now;
  std::error_code error;
  // If the file cannot be removed, the next run removes it.
  if (std::filesystem::exists(stop_file_, error)) stop_was_found_ = true;
  if (stop_was_found_) std::filesystem::remove(stop_file_, error);
  if (std::filesystem::exists(checkpoint_file_, error)) checkpoint_was_found_ = true;
}

bool Requests::time_is_up(Clock::time_point now) {
  if (last_look_) longest_between_looks_ = std::max(longest_between_looks_, now - *last_look_);
  last_look_ = now;
  if (!wall_time_.limit) return false;
  const auto kept = std::max<std::chrono::duration<double>>(steps_kept_for_the_end * longest_between_looks_,
                                                            share_kept_for_the_end * *wall_time_.limit);
  return now - wall_time_.start + kept >= *wall_time_.limit;
}

void Requests::fulfil_checkpoint() {
  hang_up_has_come = 0;
  do_on_root(ranks_, [this] {
    if (!checkpoint_was_found_) return;
    checkpoint_was_found_ = false;
    remove_file(checkpoint_file_);  // if it stayed, a checkpoint would be written ten times a second
  });
}

RequestSender::RequestSender(const std::filesystem::path& folder)
    : stop_file_(folder / stop_file_name),
      checkpoint_file_(folder / checkpoint_file_name),
      summary_(folder / summary_name),
      start_before_(last_start()) {}

RequestSender::~RequestSender() {
  std::error_code error;
  if (stop_is_sent_) std::filesystem::remove(stop_file_, error);
  if (checkpoint_is_sent_) std::filesystem::remove(checkpoint_file_, error);
}

bool RequestSender::make(const std::filesystem::path& file, bool& is_sent) const {
  if (last_start() == start_before_) return false;
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor < 0) return false;
  close(descriptor);
  is_sent = true;
  return true;
}

/// The time when the last run in the folder became ready; the earliest possible time if there was none.
std::filesystem::file_time_type RequestSender::last_start() const {
  std::error_code error;
  return std::filesystem::last_write_time(summary_, error);
}

}  // namespace tailwater
