#include "app/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>
#include <system_error>
#include <utility>

#include "app/processes.h"
#include "base/error.h"

namespace tailwater {
namespace {

using std::chrono::milliseconds;

[[noreturn]] void throw_no_start(const std::string& program) {
  throw IoError("cannot start {}: {}", program, std::generic_category().message(errno));
}

/// A pipe whose ends are closed by its destructor.
class Pipe {
 public:
  explicit Pipe(const std::string& program) {
    if (pipe2(ends_.data(), O_CLOEXEC) != 0) throw_no_start(program);
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int reader() const { return ends_[0]; }
  int writer() const { return ends_[1]; }
  void close_end(int end) {
    if (ends_[end] >= 0) close(std::exchange(ends_[end], -1));
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

struct Streams {
  int input, output, errors;
};

/// Replaces a new process, where only the simplest calls are allowed, by the program.
[[noreturn]] void turn_into(char* const* words, const char* folder, const Streams& streams) {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  signal(SIGCHLD, SIG_DFL);
  dup2(streams.input, STDIN_FILENO);
  dup2(streams.output, STDOUT_FILENO);
  dup2(streams.errors, STDERR_FILENO);
  if (chdir(folder) == 0) execvp(words[0], words);
  constexpr std::string_view failure = "the program cannot be started\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, failure.data(), failure.size());
  _exit(127);
}

milliseconds until(std::chrono::steady_clock::time_point deadline) {
  return std::max(milliseconds(0), std::chrono::ceil<milliseconds>(deadline - std::chrono::steady_clock::now()));
}

/// Appends the bytes that can be read now; closes the pipe at its end.
void take(Pipe& pipe, std::string& text) {
  std::array<char, 65536> buffer;
  const ssize_t count = read(pipe.reader(), buffer.data(), buffer.size());
  if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
  if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) pipe.close_end(0);
}

}  // namespace

ChildEnd run_child(const std::vector<std::string>& command, const std::filesystem::path& folder,
                   const std::string& input, milliseconds patience) {
  std::vector<std::string> owned = command;
  const std::vector<char*> words = arguments_of(owned);
  Pipe in(owned[0]), out(owned[0]), errors(owned[0]);
  const pid_t child = fork();
  if (child < 0) throw_no_start(owned[0]);
  if (child == 0) turn_into(words.data(), folder.c_str(), {in.reader(), out.writer(), errors.writer()});
  in.close_end(0);
  out.close_end(1);
  errors.close_end(1);
  fcntl(in.writer(), F_SETFL, O_NONBLOCK);
  const auto deadline = std::chrono::steady_clock::now() + patience;
  ChildEnd end;
  std::size_t written = 0;
  while (out.reader() >= 0 || errors.reader() >= 0) {
    if (written == input.size()) in.close_end(1);
    // poll ignores descriptors below 0.
    std::array<pollfd, 3> waiting{{{in.writer(), POLLOUT, 0}, {out.reader(), POLLIN, 0}, {errors.reader(), POLLIN, 0}}};
    const int count = poll(waiting.data(), waiting.size(), static_cast<int>(until(deadline).count()));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    if (waiting[0].revents != 0) {
      const ssize_t taken = write(in.writer(), input.data() + written, input.size() - written);
      if (taken > 0) written += static_cast<std::size_t>(taken);
      if (taken < 0 && errno != EAGAIN && errno != EINTR) in.close_end(1);
    }
    if (waiting[1].revents != 0) take(out, end.output);
    if (waiting[2].revents != 0) take(errors, end.errors);
  }
  if (out.reader() >= 0 || errors.reader() >= 0) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  end.code = exit_code_of(status);
  return end;
}

void start_apart(const std::vector<std::string>& command, const std::filesystem::path& folder,
                 const std::function<bool()>& is_ready, milliseconds patience) {
  std::vector<std::string> owned = command;
  const std::vector<char*> words = arguments_of(owned);
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  Pipe errors(owned[0]);
  // The child ends at once; its own child then has no parent that must wait for it.
  const pid_t child = fork();
  if (child < 0) throw_no_start(owned[0]);
  if (child == 0) {
    setsid();
    if (fork() == 0) turn_into(words.data(), folder.c_str(), {nothing, nothing, errors.writer()});
    _exit(0);
  }
  close(nothing);
  errors.close_end(1);
  while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) continue;
  const auto deadline = std::chrono::steady_clock::now() + patience;
  std::string said;
  while (std::chrono::steady_clock::now() < deadline && !is_ready()) {
    pollfd waiting{errors.reader(), POLLIN, 0};
    if (poll(&waiting, 1, 50) > 0) take(errors, said);
    if (errors.reader() < 0) {  // it has ended
      if (is_ready()) return;
      throw InputError(said.empty() ? fmt::format("{} has ended and said nothing", owned[0]) : said);
    }
  }
}

}  // namespace tailwater
