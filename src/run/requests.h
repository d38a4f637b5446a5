// Requests to a run in progress: to stop, or to write a checkpoint, by a signal or by a file in its folder. A signal
// may reach all ranks, some or none (not every mpirun forwards signals); the files work wherever the run was started.
#pragma once

#include <chrono>
#include <csignal>
#include <filesystem>
#include <optional>

#include "io/run_folder.h"
#include "parallel/communicator.h"

namespace tailwater {

/// The requests to a run.
struct Asked {
  bool stop = false;
  bool checkpoint = false;
};

/// The time limit of a run in elapsed time, as set by batch systems.
struct WallTime {
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  std::optional<std::chrono::duration<double>> limit;
};

/// During the lifetime of this object the first SIGINT, SIGTERM or SIGUSR1 (batch systems) requests a stop of the run.
/// A second one of the same kind ends the program at once. SIGHUP, sent when the terminal closes, requests a
/// checkpoint. The files STOP and CHECKPOINT in the run's folder make the same requests. The wall time requests a stop
/// in time.
class Requests {
 public:
  Requests(const RunFolder& folder, const Communicator& ranks, const WallTime& wall_time = {});
  ~Requests();
  Requests(const Requests&) = delete;
  Requests& operator=(const Requests&) = delete;

  /// The requests to any rank since the start; the same on all ranks. `checkpoint_is_due` on any rank counts as a
  /// request. Removes the file STOP if it exists. Collective.
  Asked look(bool checkpoint_is_due = false);

  /// Call when the requested checkpoint is written: removes the file CHECKPOINT, which confirms the request. Throws
  /// IoError, on all ranks.
  void fulfil_checkpoint();

 private:
  using Clock = std::chrono::steady_clock;

  void look_for_files(Clock::time_point now);
  bool time_is_up(Clock::time_point now);

  std::filesystem::path stop_file_;
  std::filesystem::path checkpoint_file_;
  Communicator ranks_;
  WallTime wall_time_;
  std::optional<Clock::time_point> last_look_;
  Clock::duration longest_between_looks_{};
  Clock::time_point last_look_for_files_;
  bool stop_was_found_ = false;
  bool checkpoint_was_found_ = false;
  struct sigaction old_interrupt_ {};
  struct sigaction old_terminate_ {};
  struct sigaction old_user_ {};
  struct sigaction old_hang_up_ {};
};

/// Sends requests to a run; used in the process that started it.
class RequestSender {
 public:
  /// Call before starting the run that writes into `folder`, which need not exist yet.
  explicit RequestSender(const std::filesystem::path& folder);
  /// Removes the files again if the run has ended without reading them.
  ~RequestSender();
  RequestSender(const RequestSender&) = delete;
  RequestSender& operator=(const RequestSender&) = delete;

  /// Makes the file STOP or CHECKPOINT. Returns false, without making it, if the run has not begun to write or the file
  /// cannot be made.
  bool ask_for_stop() { return make(stop_file_, stop_is_sent_); }
  bool ask_for_checkpoint() { return make(checkpoint_file_, checkpoint_is_sent_); }

 private:
  bool make(const std::filesystem::path& file, bool& is_sent) const;
  std::filesystem::file_time_type last_start() const;

  std::filesystem::path stop_file_;
  std::filesystem::path checkpoint_file_;
  std::filesystem::path summary_;  ///< a run writes it when it is ready
  std::filesystem::file_time_type start_before_;
  bool stop_is_sent_ = false;
  bool checkpoint_is_sent_ = false;
};

}  // namespace tailwater
