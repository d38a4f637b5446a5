#include "io/messages.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <limits.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <set>
#include <utility>

#include "base/text.h"

namespace tailwater {
namespace {

/// How long a message waits for a blocked terminal or pipe; after one wait in vain, later messages do not wait.
constexpr int longest_wait = 1000;  // ms

/// bytes; far more than a message with a place, a value and a remedy needs
constexpr std::size_t longest_line = 2000;

std::string shown_as(std::string_view line) { return shortened(printable(line), longest_line); }

struct Messages {
  Voice voice = Voice::aloud;
  bool live_line_is_open = false;
  bool is_stuck = false;
  int log = -1;
  std::string told;  ///< before there is a log
  std::vector<std::string> warnings;
};

Messages& messages() {
  static Messages all;
  return all;
}

/// Writes as much as possible within `milliseconds`; returns whether that was all.
bool write_what_is_taken(int file, std::string_view text, int milliseconds) {
  while (!text.empty()) {
    pollfd ready{.fd = file, .events = POLLOUT, .revents = 0};
    const int count = poll(&ready, 1, milliseconds);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    // A pipe that is ready takes this many bytes without blocking.
    const ssize_t written = write(file, text.data(), std::min<std::size_t>(text.size(), PIPE_BUF));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

void show(std::string_view text) {
  Messages& all = messages();
  const std::string_view new_line = all.live_line_is_open ? "\n" : "";
  all.live_line_is_open = false;
  all.is_stuck =
      !write_what_is_taken(STDERR_FILENO, fmt::format("{}{}", new_line, text), all.is_stuck ? 0 : longest_wait);
}

void keep(std::string_view text) {
  Messages& all = messages();
  if (all.log < 0) {
    all.told += text;
  } else {
    write_what_is_taken(all.log, text, longest_wait);
  }
}

void warn_line(const std::string& line) {
  messages().warnings.push_back(line);
  tell("warning: {}", line);
}

std::size_t terminal_columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col : 80;
}

}  // namespace

void survive_lost_terminal() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    [[maybe_unused]] const int lowest_free = open("/dev/null", O_RDWR);
  }
}

void set_voice(Voice voice) { messages().voice = voice; }

void begin_messages(Voice voice) {
  if (messages().log >= 0) close(messages().log);
  messages() = {};
  messages().voice = voice;
}

void tell(std::string_view line) {
  const Voice voice = messages().voice;
  const std::string text = shown_as(line) + "\n";
  if (voice == Voice::aloud) show(text);
  if (voice != Voice::silent) keep(text);
}

void warn(MessageId id, std::string_view line) { warn_line(fmt::format("{} [{}]", line, id.text())); }

void warn(const Finding& finding) { warn_line(finding.line()); }

void tell_error(std::string_view message, std::string_view prefix) {
  std::string text;
  std::set<std::string_view> told;
  for (const std::string_view line : lines_of(message)) {
    if (told.insert(line).second) text += shown_as(fmt::format("error: {}{}", prefix, line)) + "\n";
  }
  if (text.empty()) return;
  show(text);
  keep(text);
}

void log_line(std::string_view line) {
  if (messages().voice != Voice::silent) keep(shown_as(line) + "\n");
}

bool is_on_terminal() { return isatty(STDERR_FILENO) == 1; }

void show_live(std::string line) {
  Messages& all = messages();
  if (all.voice != Voice::aloud) return;
  // A line that wraps cannot be rewritten in place.
  line = printable(line);
  line.resize(std::min(line.size(), terminal_columns() - 1));
  all.live_line_is_open = write_what_is_taken(STDERR_FILENO, fmt::format("\r\033[K{}", line), 0);
}

void open_log(const std::filesystem::path& path) {
  Messages& all = messages();
  if (all.log >= 0) close(all.log);
  all.log = open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
  if (all.log >= 0) write_what_is_taken(all.log, all.told, longest_wait);
  all.told.clear();
}

const std::vector<std::string>& warnings() { return messages().warnings; }

void recall_warnings(std::vector<std::string> earlier) {
  std::vector<std::string>& all = messages().warnings;
  for (const std::string& warning : all) {
    if (std::find(earlier.begin(), earlier.end(), warning) == earlier.end()) earlier.push_back(warning);
  }
  all = std::move(earlier);
}

}  // namespace tailwater
