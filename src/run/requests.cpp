#include "run/requests.h"

#include <fcntl.h>
#include <unistd.h>

#include <system_error>

namespace tailwater {
namespace {

/// Long enough for a file system that a whole cluster shares.
constexpr auto time_between_looks = std::chrono::milliseconds(100);

volatile std::sig_atomic_t signal_has_come = 0;

void note_signal(int) { signal_has_come = 1; }

}  // namespace

Requests::Requests(const RunFolder& folder, const Communicator& ranks) : stop_file_(folder.stop()), ranks_(ranks) {
  signal_has_come = 0;
  struct sigaction action {};
  action.sa_handler = note_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &old_interrupt_);
  sigaction(SIGTERM, &action, &old_terminate_);
  sigaction(SIGUSR1, &action, &old_user_);
}

Requests::~Requests() {
  sigaction(SIGINT, &old_interrupt_, nullptr);
  sigaction(SIGTERM, &old_terminate_, nullptr);
  sigaction(SIGUSR1, &old_user_, nullptr);
}

bool Requests::stop_is_asked() { return ranks_.any(signal_has_come != 0 || (ranks_.is_root() && finds_stop_file())); }

bool Requests::finds_stop_file() {
  const auto now = Clock::now();
  if (now - last_look_ < time_between_looks) return false;
  last_look_ = now;
  std::error_code error;
  if (!std::filesystem::exists(stop_file_, error)) return false;
  std::filesystem::remove(stop_file_, error);  // if it stays, the next run removes it
  return true;
}

StopSender::StopSender(const std::filesystem::path& folder)
    : stop_file_(folder / stop_file_name), effective_case_(folder / effective_case_name), start_before_(last_start()) {}

StopSender::~StopSender() {
  std::error_code error;
  if (is_sent_) std::filesystem::remove(stop_file_, error);
}

bool StopSender::send() {
  if (last_start() == start_before_) return false;
  const int file = open(stop_file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) return false;
  close(file);
  is_sent_ = true;
  return true;
}

/// When the last run in the folder became ready; the earliest possible time if there was none.
std::filesystem::file_time_type StopSender::last_start() const {
  std::error_code error;
  return std::filesystem::last_write_time(effective_case_, error);
}

}  // namespace tailwater
