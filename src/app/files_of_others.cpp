#include "app/files_of_others.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "base/error.h"

namespace tailwater {

void require_own_regular_file(const std::filesystem::path& path) {
  struct stat found {};
  const bool is_there = lstat(path.c_str(), &found) == 0;
  const auto refuse = [&](const char* what) {
    throw InputError("'{}' is {}, and is not replaced; remedy: another name", path.string(), what);
  };
  if (is_there && S_ISLNK(found.st_mode)) refuse("a link");
  if (is_there && S_ISDIR(found.st_mode)) refuse("a folder");
  if (is_there && !S_ISREG(found.st_mode)) refuse("a device or a pipe");
  if (is_there && found.st_uid != geteuid()) refuse("another user's file");
}

bool is_preview(const std::filesystem::path& path) {
  std::string begin(1024, '\0');
  std::ifstream(path, std::ios::binary).read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin.find("tailwater preview") != std::string::npos;
}

}  // namespace tailwater
