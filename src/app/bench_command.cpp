#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "app/commands.h"

namespace tailwater {
namespace {

constexpr const char* python = "/usr/bin/python3";

/// The folder of the Python package that defines and scores the benches, beside the sources this program was built
/// from.
std::filesystem::path validation_folder() {
  const std::filesystem::path folder = std::filesystem::path(TAILWATER_SOURCE_DIR) / "validation";
  if (!std::filesystem::exists(folder / "tailwater_validation" / "robustness.py")) {
    throw IoError(
        fmt::format("the benches are not in '{}', where this program was built from; remedy: keep the sources "
                    "there, or build again",
                    folder.string()));
  }
  return folder;
}

/// Becomes the Python program that runs the bench, so that signals and the exit code are its own.
[[noreturn]] void become_bench(const std::vector<std::string>& options) {
  const std::string folder = validation_folder().string();
  const char* path = std::getenv("PYTHONPATH");
  setenv("PYTHONPATH", path == nullptr ? folder.c_str() : fmt::format("{}:{}", folder, path).c_str(), 1);
  std::vector<std::string> words{python, "-m", "tailwater_validation.robustness", "--program",
                                 std::filesystem::read_symlink("/proc/self/exe").string()};
  words.insert(words.end(), options.begin(), options.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(python, arguments.data());
  throw IoError(fmt::format("cannot start {}: {}; remedy: install python3 with numpy and VTK (scripts/install.sh)",
                            python, std::generic_category().message(errno)));
}

}  // namespace

void add_bench_command(CLI::App& app, ExitCode&) {
  CLI::App* command = app.add_subcommand("bench", "Run and score a set of cases whose outcome is known");
  command->require_subcommand(1);
  command->footer(
      "Examples: tailwater bench robustness --list\n"
      "          tailwater bench robustness --out my_bench --gate tank --gate noise");
  CLI::App* robustness = command->add_subcommand("robustness", "The gates of the robust core");
  robustness->set_help_flag();  // the bench explains its own options
  robustness->prefix_command();
  robustness->callback([robustness] { become_bench(robustness->remaining()); });
}

}  // namespace tailwater
