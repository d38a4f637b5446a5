#include "app/processes.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace tailwater {
namespace {

/// Replaces the new process by the program, or reports the reason through `failure` if that fails.
[[noreturn]] void become(std::vector<std::string> command, const sigset_t& signals, int standard_error, int failure) {
  setpgid(0, 0);
  sigprocmask(SIG_SETMASK, &signals, nullptr);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  if (standard_error != STDERR_FILENO) dup2(standard_error, STDERR_FILENO);
  const std::vector<char*> words = arguments_of(command);
  execvp(words[0], words.data());
  const int error_number = errno;
  [[maybe_unused]] const ssize_t written = write(failure, &error_number, sizeof(error_number));
  _exit(127);
}

[[noreturn]] void throw_cannot(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

}  // namespace

AwaitedSignals::AwaitedSignals() {
  sigemptyset(&awaited_);
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1, SIGHUP, SIGCHLD}) sigaddset(&awaited_, signal);
  // A parent that ignores it passes that on, and this process would not be notified of the end of a child.
  std::signal(SIGCHLD, SIG_DFL);
  sigprocmask(SIG_BLOCK, &awaited_, &before_);
}

AwaitedSignals::~AwaitedSignals() {
  while (next(std::chrono::milliseconds(0)) != 0) continue;  // signals that came late are discarded
  sigprocmask(SIG_SETMASK, &before_, nullptr);
}

int AwaitedSignals::next(std::optional<std::chrono::milliseconds> patience) const {
  int signal = 0;
  if (!patience) {
    sigwait(&awaited_, &signal);
    return signal;
  }
  const auto milliseconds = patience->count();
  const timespec time{.tv_sec = milliseconds / 1000, .tv_nsec = milliseconds % 1000 * 1000000};
  return std::max(0, sigtimedwait(&awaited_, nullptr, &time));
}

pid_t AwaitedSignals::start(std::vector<std::string> command, int standard_error) const {
  int failure[2];
  if (pipe2(failure, O_CLOEXEC) != 0) throw_cannot("cannot make a pipe");
  const pid_t process = fork();
  if (process < 0) throw_cannot("cannot start a process");
  if (process == 0) become(std::move(command), before_, standard_error, failure[1]);
  close(failure[1]);
  int error_number = 0;
  const bool has_failed = read(failure[0], &error_number, sizeof(error_number)) == sizeof(error_number);
  close(failure[0]);
  if (!has_failed) return process;
  waitpid(process, nullptr, 0);
  errno = error_number;
  throw_cannot("cannot start a program");
}

std::optional<int> ending_of(pid_t process) {
  int status = 0;
  if (waitpid(process, &status, WNOHANG) == 0) return std::nullopt;
  return exit_code_of(status);
}

std::vector<char*> arguments_of(std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  return arguments;
}

int exit_code_of(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

bool is_own_exit_code(int code) { return code == 0 || code == 2 || code == 3 || code == 4; }

std::string this_program() { return std::filesystem::read_symlink("/proc/self/exe").string(); }

}  // namespace tailwater
