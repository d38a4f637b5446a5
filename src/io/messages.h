// The messages of a command to its user: on standard error, and in the log of a run once there is one. There is one
// standard error per process, so the state is global. A lost terminal is no error: messages that cannot be shown are
// dropped, and the command continues.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/finding.h"

namespace tailwater {

/// Call before any file is opened. Standard streams that are closed become /dev/null, since a file of results would
/// otherwise take their place and receive the messages. From now on, writing to a pipe without a reader is an error,
/// not a signal. So is a file that grows beyond the limit of a batch system, like one on a full disk.
void survive_lost_terminal();

enum class Voice {
  aloud,   ///< everything is shown
  quiet,   ///< only errors are shown; the log has everything
  silent,  ///< only errors are shown and logged: a rank that is not the root
};
void set_voice(Voice voice);
/// Starts the messages of another run in the same process: earlier lines and warnings are discarded, and the log is
/// closed.
void begin_messages(Voice voice);

/// Lines are shown as `printable` (base/text.h) makes them; very long ones lose their middle.

/// Shows a line to the user, as it is or as fmt::format makes it.
void tell(std::string_view line);
template <class First, class... Rest>
void tell(fmt::format_string<First, Rest...> text, First&& first, Rest&&... rest) {
  tell(fmt::format(text, std::forward<First>(first), std::forward<Rest>(rest)...));
}
/// Shows "warning: LINE [ID]", and keeps this for `warnings`, without the word "warning".
void warn(MessageId id, std::string_view line);
template <class First, class... Rest>
void warn(MessageId id, fmt::format_string<First, Rest...> text, First&& first, Rest&&... rest) {
  warn(id, fmt::format(text, std::forward<First>(first), std::forward<Rest>(rest)...));
}
/// Shows and keeps the line of a finding, with its position in the case file.
void warn(const Finding& finding);
/// Shows "error: PREFIX LINE" for each line of the message, because a case may have several problems. Repeated lines
/// are shown once.
void tell_error(std::string_view message, std::string_view prefix = "");
/// Writes a line to the log alone.
void log_line(std::string_view line);

bool is_on_terminal();
/// Shows a line in place of the last such line, cut off where the terminal ends; for terminals. The log does not
/// contain it.
void show_live(std::string line);

/// Appends all lines so far, and everything from now on, to the file `path`. A log that cannot be written is no error:
/// the files of results report a full disk.
void open_log(const std::filesystem::path& path);

/// All warnings so far, without the word "warning".
const std::vector<std::string>& warnings();
/// Inserts the warnings of an earlier run, which this one continues, before those so far; duplicates count once. Shows
/// nothing again.
void recall_warnings(std::vector<std::string> earlier);

}  // namespace tailwater
