#include "app/python_package.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "app/processes.h"
#include "base/error.h"

namespace tailwater {
namespace {

constexpr const char* python = "/usr/bin/python3";

std::filesystem::path validation_folder(const std::string& module) {
  const std::filesystem::path folder = std::filesystem::path(TAILWATER_SOURCE_DIR) / "validation";
  if (!std::filesystem::exists(folder / "tailwater_validation" / (module + ".py"))) {
    throw IoError(
        fmt::format("the Python package that runs and scores cases is not in '{}', where this program was built from; "
                    "remedy: keep the sources there, or build again",
                    folder.string()));
  }
  return folder;
}

}  // namespace

void become_python(const std::string& module, const std::vector<std::string>& options) {
  const std::string folder = validation_folder(module).string();
  const char* path = std::getenv("PYTHONPATH");
  setenv("PYTHONPATH", path == nullptr ? folder.c_str() : fmt::format("{}:{}", folder, path).c_str(), 1);
  std::vector<std::string> words{python, "-m", "tailwater_validation." + module, "--program", this_program()};
  words.insert(words.end(), options.begin(), options.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(python, arguments.data());
  throw IoError(
      fmt::format("cannot start {}: {}; remedy: install python3 with numpy, matplotlib and VTK (scripts/install.sh)",
                  python, std::generic_category().message(errno)));
}

}  // namespace tailwater
