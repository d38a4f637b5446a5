// Processes that the server behind `tailwater view` starts: a check whose result it needs, and runs that outlive it.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tailwater {

struct ChildEnd {
  int code = 0;  ///< exit code, or 128 and the number of the signal that ended it
  std::string output;
  std::string errors;
};

/// Runs a program in a folder with `input` on its standard input, and waits for it; after `patience` it is killed. A
/// program that cannot be started prints the reason and has code 127; IoError if there is no process for it. Several
/// threads may call it at once, as all functions here.
ChildEnd run_child(const std::vector<std::string>& command, const std::filesystem::path& folder,
                   const std::string& input, std::chrono::milliseconds patience);

/// Starts a program in a folder that outlives this one, in a session of its own. Waits until it `is_ready`, has ended,
/// or `patience` is over. Throws InputError with its output if it has ended before it was ready, or could not be
/// started; IoError if there is no process for it.
void start_apart(const std::vector<std::string>& command, const std::filesystem::path& folder,
                 const std::function<bool()>& is_ready, std::chrono::milliseconds patience);

}  // namespace tailwater
