// Other processes that this program starts and waits for: mpirun with its ranks, members of a sweep.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <csignal>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"

namespace tailwater {

/// During its lifetime SIGINT, SIGTERM, SIGUSR1, SIGHUP and SIGCHLD are blocked until `next` takes them one by one, so
/// that no signal handler is needed. Processes that `start` makes handle signals as this one did before.
class AwaitedSignals {
 public:
  AwaitedSignals();
  ~AwaitedSignals();
  AwaitedSignals(const AwaitedSignals&) = delete;
  AwaitedSignals& operator=(const AwaitedSignals&) = delete;

  /// Waits for a signal; returns 0 if none arrives within `patience`.
  int next(std::optional<std::chrono::milliseconds> patience = std::nullopt) const;

  /// Starts a program with its arguments, without standard input, with `standard_error` as its own. It has its own
  /// process group: Ctrl-C goes to this process alone. It gets SIGTERM when this process ends, however that ends.
  /// Throws std::system_error if it cannot be started.
  pid_t start(std::vector<std::string> command, int standard_error) const;

 private:
  sigset_t awaited_;
  sigset_t before_;
};

/// Exit code of a process that has ended, or 128 plus the number of the signal that ended it; empty while it is
/// running.
std::optional<int> ending_of(pid_t process);

/// A command as execv takes it; the pointers point into the words.
std::vector<char*> arguments_of(std::vector<std::string>& words);

/// Exit code of a process, or 128 plus the number of the signal that ended it, from the status of waitpid.
int exit_code_of(int status);

/// Whether a command of this program ends with this exit code in order, other than by a request.
bool is_own_exit_code(int code);

/// This program's file.
std::string this_program();

}  // namespace tailwater
