#include "case/case_toml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

#include "base/finding.h"
#include "case/toml_text.h"

namespace tailwater {

std::string read_case_file(const std::filesystem::path& path, std::uintmax_t largest) {
  std::error_code error;  // what does not exist is told below
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) {
    throw IoError("{}: is a folder; give the case file in it", path.string());
  }
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw IoError("{}: is a device or a pipe; give a case file", path.string());
  }
  if (const std::uintmax_t size = std::filesystem::file_size(path, error); !error && size > largest) {
    throw InputError("{}: has {} bytes; a case file has at most {}", path.string(), size, largest);
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw IoError("{}: cannot read the case file ({}); check the path, or start one with `tailwater new`",
                  path.string(), std::generic_category().message(errno));
  }
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

toml::table parse_case(std::string_view text, const std::string& file) {
  if (const auto line = line_of_deep_key(text)) {
    throw CaseError({"a key has too many dots"}, {"write keys as in fluid[0].max: a table and a name in it"},
                    {file, static_cast<int>(*line)});
  }
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const toml::source_position where = error.source().begin;
    std::string description(error.description());  // it quotes letters as they are, ends of lines too
    std::ranges::replace_if(
        description, [](unsigned char letter) { return std::iscntrl(letter) != 0; }, ' ');
    throw CaseError({"not valid TOML: {}", description},
                    {"correct the line (texts are written in quotes, lists in [ ])"},
                    {file, static_cast<int>(where.line), static_cast<int>(where.column)});
  }
}

}  // namespace tailwater
