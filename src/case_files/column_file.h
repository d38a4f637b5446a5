// A text file of columns, read line by line: separators, headings with units, numbers, and the places of errors.
// Messages quote its content only if it looks like a number or a heading, because a case may name any file that its
// user can read.
#pragma once

#include <array>
#include <filesystem>
#include <istream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace tailwater {

struct Unit {
  std::string_view name;
  double factor;  ///< in SI units
};
inline constexpr std::array<Unit, 5> length_units{
    {{"m", 1.0}, {"mm", 1e-3}, {"cm", 1e-2}, {"km", 1e3}, {"ft", 0.3048}}};

/// The fields of a line, without blanks and quotes around them; with a blank as separator any number of blanks is one.
/// Empty fields at the end, which spreadsheets leave, do not count.
std::vector<std::string_view> fields_of(std::string_view line, char separator);

/// The first of ; tab , in the line; else a blank.
char separator_of(std::string_view line);

/// The number in a field, if it is one.
std::optional<double> number_in_field(std::string_view field);

/// The name and unit of a column from the header: "Station [mm]" is "station" in "mm".
struct Heading {
  std::string name;
  std::string unit;
  bool has_brackets = false;  ///< otherwise the text after an underscore may be part of the name

  explicit Heading(std::string_view field);
};

std::string lower_case_of(std::string_view text);

class ColumnFile {
 public:
  explicit ColumnFile(const std::filesystem::path& path) : path_(path.string()) {}

 protected:
  /// Calls take(line) for each line that is neither empty nor a comment.
  template <class Take>
  void for_each_line(std::istream& file, Take&& take) {
    std::string text;
    while (std::getline(file, text)) {
      if (const std::string_view line = next_line(text); !line.empty()) take(line);
    }
  }

  /// Throws InputError with file and line before the message.
  [[noreturn]] void wrong(const std::string& message) const;
  template <class First, class... Rest>
  [[noreturn]] void wrong(fmt::format_string<First, Rest...> text, First&& first, Rest&&... rest) const {
    wrong(fmt::format(text, std::forward<First>(first), std::forward<Rest>(rest)...));
  }

  /// The fields of a line of numbers; it must not have more than columns, since a decimal comma would make two of one.
  std::vector<std::string_view> numbers_of(std::string_view line) const;

  double number_at(const std::vector<std::string_view>& fields, std::size_t column, std::string_view quantity) const;

  /// The unit of a heading in SI units; empty if it names none.
  std::optional<double> unit_of(const Heading& heading, std::string_view field, std::span<const Unit> units) const;

  std::string path_;
  std::size_t line_ = 0;
  char separator_ = '\0';  ///< unknown before the first line
  std::size_t width_ = 0;  ///< columns of the first line that counts

 private:
  /// The next line without blanks around it; empty if it does not count.
  std::string_view next_line(std::string_view text);
};

}  // namespace tailwater
