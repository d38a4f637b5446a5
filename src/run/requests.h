// Requests to a run in progress: to stop, by a signal or by a file in its folder. A signal may reach all ranks, some or
// none (not every mpirun forwards signals); the file works wherever the run was started.
#pragma once

#include <chrono>
#include <csignal>
#include <filesystem>

#include "io/run_folder.h"
#include "parallel/communicator.h"

namespace tailwater {

/// While this object lives, the first SIGINT, SIGTERM or SIGUSR1 (batch systems) asks the run to stop; a second one of
/// the same kind ends the program at once. The file STOP in the run's folder also asks the run to stop.
class Requests {
 public:
  Requests(const RunFolder& folder, const Communicator& ranks);
  ~Requests();
  Requests(const Requests&) = delete;
  Requests& operator=(const Requests&) = delete;

  /// Whether any rank has been asked to stop; the same on all ranks. Removes the file when it finds it. Collective.
  bool stop_is_asked();

 private:
  using Clock = std::chrono::steady_clock;

  bool finds_stop_file();

  std::filesystem::path stop_file_;
  Communicator ranks_;
  Clock::time_point last_look_;
  struct sigaction old_interrupt_ {};
  struct sigaction old_terminate_ {};
  struct sigaction old_user_ {};
};

/// Asks a run to stop; used in the process that started it.
class StopSender {
 public:
  /// Call before starting the run that writes into `folder`, which need not exist yet.
  explicit StopSender(const std::filesystem::path& folder);
  /// Removes the file again if the run has ended without seeing it.
  ~StopSender();
  StopSender(const StopSender&) = delete;
  StopSender& operator=(const StopSender&) = delete;

  /// Makes the file STOP. Returns false, without making it, if the run has not begun to write or the file cannot be
  /// made.
  bool send();

 private:
  std::filesystem::file_time_type last_start() const;

  std::filesystem::path stop_file_;
  std::filesystem::path effective_case_;  ///< a run writes it when it is ready
  std::filesystem::file_time_type start_before_;
  bool is_sent_ = false;
};

}  // namespace tailwater
