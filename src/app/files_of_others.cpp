#include "app/files_of_others.h"

#include <fmt/format.h>

#include <fstream>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/input_file.h"
#include "io/write_file.h"

namespace tailwater {

void require_own_regular_file(const std::filesystem::path& path) {
  const std::string_view obstacle = obstacle_at(path);
  if (obstacle.empty()) return;
  throw InputError("'{}' is {}, and is not replaced; remedy: choose another name", path.string(), obstacle);
}

bool is_preview(const std::filesystem::path& path) {
  std::string begin(1024, '\0');
  open_input_file(path).read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin.find("tailwater preview") != std::string::npos;
}

}  // namespace tailwater
