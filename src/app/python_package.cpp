#include "app/python_package.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "app/processes.h"
#include "base/error.h"

namespace tailwater {
namespace {

constexpr const char* python = TAILWATER_PYTHON_PROGRAM;

// Folders below the prefix of an installation, or in the build tree.
constexpr const char* validation = "share/tailwater/validation";
constexpr const char* package = "lib/python3/dist-packages";

/// The nearest folder above this program that contains the module, in one of the two folders.
std::filesystem::path prefix_with(const std::string& module) {
  std::string file = module + ".py";
  std::ranges::replace(file.begin(), file.end() - 3, '.', '/');
  std::filesystem::path above = std::filesystem::path(this_program()).parent_path();
  while (!std::filesystem::exists(above / validation / file) && !std::filesystem::exists(above / package / file)) {
    if (above == above.root_path()) {
      throw IoError(
          "the Python module {} is neither in {} nor in {} above '{}'; remedy: install the program whole (cmake "
          "--install), or build it again",
          module, validation, package, this_program());
    }
    above = above.parent_path();
  }
  return above;
}

/// Makes Python search these folders first.
void put_first(const std::string& folders) {
  const char* path = std::getenv("PYTHONPATH");
  if (path == nullptr) {
    setenv("PYTHONPATH", folders.c_str(), 1);
  } else if (!std::string_view(path).starts_with(folders)) {
    setenv("PYTHONPATH", fmt::format("{}:{}", folders, path).c_str(), 1);
  }
}

/// The command line of a module that is a program. It starts through a launcher that reports missing dependencies.
std::vector<std::string> python_command(const std::string& module, const std::vector<std::string>& options) {
  const std::filesystem::path prefix = prefix_with(module);
  put_first((prefix / validation).string() + ":" + (prefix / package).string());
  std::vector<std::string> words{python, "-m", "tailwater_validation.launch", module, "--program", this_program()};
  words.insert(words.end(), options.begin(), options.end());
  return words;
}

[[noreturn]] void throw_cannot_start(int error) {
  throw IoError("cannot start {}: {}; remedy: install python3 with numpy, matplotlib and VTK (scripts/install.sh)",
                python, std::generic_category().message(error));
}

}  // namespace

void become_python(const std::string& module, const std::vector<std::string>& options) {
  std::vector<std::string> words = python_command(module, options);
  execv(python, arguments_of(words).data());
  throw_cannot_start(errno);
}

void run_python(const std::string& module, const std::vector<std::string>& options) {
  std::vector<std::string> words = python_command(module, options);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw_cannot_start(errno);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  pid_t child = 0;
  const int error = posix_spawn(&child, python, &actions, nullptr, arguments_of(words).data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  std::string told;
  if (error == 0) {
    char buffer[4096];
    for (ssize_t count = 0; (count = read(ends[0], buffer, sizeof buffer)) != 0;) {
      if (count > 0) told.append(buffer, static_cast<std::size_t>(count));
      if (count < 0 && errno != EINTR) break;
    }
  }
  close(ends[0]);
  if (error != 0) throw_cannot_start(error);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (status == 0) return;
  // The last line has the error, also in a traceback.
  const std::size_t last = told.find_last_not_of(" \n");
  if (last == std::string::npos) throw IoError("{} ended with status {}", module, status);
  const std::size_t begin = told.rfind('\n', last) + 1;
  const std::string line = told.substr(begin, last + 1 - begin);
  throw IoError(line.starts_with("error: ") ? line.substr(7) : line);
}

}  // namespace tailwater
