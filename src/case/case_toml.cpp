#include "case/case_toml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "base/finding.h"
#include "base/input_file.h"
#include "case/toml_text.h"

namespace tailwater {
namespace {

InputFileKind kind_of_case(std::uintmax_t largest) {
  return {.name = "a case file",
          .largest = largest,
          .remedy_for_size = "put long chains of points and time series into files of their own"};
}

}  // namespace

std::string read_case_file(const std::filesystem::path& path, std::uintmax_t largest) {
  std::ifstream file = open_input_file(path, kind_of_case(largest));
  if (!file) {
    throw IoError("{}: cannot read the case file ({}); check the path, or start one with `tailwater new`",
                  path.string(), std::generic_category().message(errno));
  }
  return read_bytes(file, largest);
}

std::string read_case_from(std::istream& stream) {
  std::string text = read_bytes(stream, largest_case_file);
  if (text.size() <= largest_case_file) return text;
  throw InputError("standard input has more than {} bytes, and a case file has at most as many; {}", largest_case_file,
                   kind_of_case(largest_case_file).remedy_for_size);
}

toml::table parse_case(std::string_view text, const std::string& file) {
  if (const auto line = line_of_deep_key(text)) {
    throw CaseError("key-too-deep", {"a key has too many dots"},
                    {"write keys as in fluid[0].max: a table and a name in it"}, {file, static_cast<int>(*line)});
  }
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const toml::source_position where = error.source().begin;
    std::string description(error.description());  // it quotes letters unchanged, ends of lines too
    std::ranges::replace_if(
        description, [](unsigned char letter) { return std::iscntrl(letter) != 0; }, ' ');
    throw CaseError("toml-invalid", {"not valid TOML: {}", description},
                    {"correct the line (texts are written in quotes, lists in [ ])"},
                    {file, static_cast<int>(where.line), static_cast<int>(where.column)});
  }
}

}  // namespace tailwater
