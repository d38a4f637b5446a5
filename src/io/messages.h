// What a command tells its user while it works: on standard error, and in the log of a run once there is one. Standard
// error is one per process, and so is this. Losing the terminal is no error: what cannot be shown is dropped, and the
// work goes on.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace tailwater {

/// Call before any file is opened. Standard streams that are closed become /dev/null, since a file of results would
/// otherwise take their place and receive the messages. Writing to a pipe that nobody reads is an error from now on,
/// not a signal, and so is a file that grows beyond the limit of a batch system, as one on a full disk.
void survive_lost_terminal();

enum class Voice {
  aloud,   ///< everything is shown
  quiet,   ///< only errors are shown; the log has everything
  silent,  ///< only errors are shown and logged: a rank that is not the root
};
void set_voice(Voice voice);
/// The same for another run in the same process: what was told and warned of before is forgotten, and its log closed.
void begin_messages(Voice voice);

/// Lines are shown as `printable` (base/text.h) makes them, and with their middle left out if they are very long.

/// A line for the user, as it is or as fmt::format makes it.
void tell(std::string_view line);
template <class First, class... Rest>
void tell(fmt::format_string<First, Rest...> text, First&& first, Rest&&... rest) {
  tell(fmt::format(text, std::forward<First>(first), std::forward<Rest>(rest)...));
}
/// "warning: LINE"; kept for `warnings`.
void warn(const std::string& line);
template <class First, class... Rest>
void warn(fmt::format_string<First, Rest...> text, First&& first, Rest&&... rest) {
  warn(fmt::format(text, std::forward<First>(first), std::forward<Rest>(rest)...));
}
/// "error: PREFIX LINE" for each line of the message: a case may have several problems. A line that is there twice is
/// told once.
void tell_error(std::string_view message, std::string_view prefix = "");
/// A line for the log alone.
void log_line(std::string_view line);

bool is_on_terminal();
/// Shows a line in place of the last such line, cut off where the terminal ends; for terminals. The log does not get
/// it.
void show_live(std::string line);

/// What was told so far, and everything from now on, is appended to the file `path`. A log that cannot be written is no
/// error: the files of results tell of a full disk.
void open_log(const std::filesystem::path& path);

/// All warnings so far, without the word "warning".
const std::vector<std::string>& warnings();
/// Puts the warnings of an earlier run, which this one goes on with, before those so far; what both have counts once.
/// Nothing is told again.
void recall_warnings(std::vector<std::string> earlier);

}  // namespace tailwater
