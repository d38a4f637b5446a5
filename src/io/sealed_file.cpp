#include "io/sealed_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <limits>
#include <optional>

#include "base/error.h"
#include "base/input_file.h"
#include "io/write_file.h"

namespace tailwater {
namespace {

constexpr std::size_t head_size = 512;

/// The content of the head.
struct Head {
  SealedFile about;  ///< without a body
  std::uint64_t bytes = 0;
  std::uint32_t checksum = 0;  ///< of the lines of the head above it, and of the body
};

std::string lines_above_checksum(const Head& head) {
  return fmt::format("tailwater checkpoint, format {}\nwritten by {}\nranks {}\nbytes {}\n", head.about.format,
                     head.about.writer, head.about.ranks, head.bytes);
}

std::string text_of(const Head& head) {
  std::string text = lines_above_checksum(head) + fmt::format("crc32 {:08x}\n", head.checksum);
  text.resize(head_size, ' ');
  return text;
}

std::uint32_t checksum_of(const Head& head, std::string_view body) {
  std::uint32_t sum = 0;
  const std::string lines = lines_above_checksum(head);
  for (std::string_view rest : {std::string_view(lines), body}) {
    while (!rest.empty()) {
      const std::size_t count = std::min<std::size_t>(rest.size(), std::numeric_limits<uInt>::max());
      sum =
          static_cast<std::uint32_t>(crc32(sum, reinterpret_cast<const Bytef*>(rest.data()), static_cast<uInt>(count)));
      rest.remove_prefix(count);
    }
  }
  return sum;
}

/// Takes "NAME value\n" off the front of `text`.
std::optional<std::string_view> take_line(std::string_view& text, std::string_view name) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos || !text.starts_with(name)) return std::nullopt;
  const std::string_view value = text.substr(name.size(), end - name.size());
  text.remove_prefix(end + 1);
  return value;
}

template <class Number>
bool take_number(std::string_view& text, std::string_view name, Number& number, int base = 10) {
  const std::optional<std::string_view> digits = take_line(text, name);
  if (!digits) return false;
  const auto [end, error] = std::from_chars(digits->data(), digits->data() + digits->size(), number, base);
  return error == std::errc{} && end == digits->data() + digits->size();
}

/// Empty if `text` is not exactly a head, to the last byte.
std::optional<Head> parse_head(const std::string& text) {
  Head head;
  std::string_view rest = text;
  if (!take_number(rest, "tailwater checkpoint, format ", head.about.format)) return std::nullopt;
  const std::optional<std::string_view> writer = take_line(rest, "written by ");
  if (!writer) return std::nullopt;
  head.about.writer = *writer;
  if (!take_number(rest, "ranks ", head.about.ranks) || !take_number(rest, "bytes ", head.bytes) ||
      !take_number(rest, "crc32 ", head.checksum, 16) || text_of(head) != text) {
    return std::nullopt;
  }
  return head;
}

[[noreturn]] void refuse(const std::filesystem::path& path, std::string_view reason) {
  throw IoError("checkpoint '{}' is damaged: {}", path.string(), reason);
}

Head read_head(std::ifstream& file, const std::filesystem::path& path) {
  errno = 0;
  file = open_input_file(path);
  if (!file) throw_io_error("read", path, errno);
  std::string text(head_size, '\0');
  file.read(text.data(), head_size);
  const std::optional<Head> head = file ? parse_head(text) : std::nullopt;
  if (!head) refuse(path, "it does not begin as one");
  return *head;
}

}  // namespace

void write_sealed_file(const std::filesystem::path& path, const SealedFile& head, std::string_view body) {
  Head told{{head.format, head.writer, head.ranks, ""}, body.size(), 0};
  told.checksum = checksum_of(told, body);
  const std::string text = text_of(told);
  const std::array<std::string_view, 2> parts{text, body};
  write_file_to_disk(path, parts);
}

SealedFile read_sealed_file(const std::filesystem::path& path) {
  std::ifstream file;
  Head head = read_head(file, path);
  // The size is tested first, because a wrong number must not cause the allocation of all memory.
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size != head_size + head.bytes) {
    refuse(path, fmt::format("it has {} bytes instead of {}", error ? 0 : size, head_size + head.bytes));
  }
  head.about.body.resize(head.bytes);
  file.read(head.about.body.data(), static_cast<std::streamsize>(head.bytes));
  if (!file) throw_io_error("read", path, errno);
  if (checksum_of(head, head.about.body) != head.checksum) refuse(path, "its checksum is wrong");
  head.about.path = path;
  return std::move(head.about);
}

SealedFile read_head_of_sealed_file(const std::filesystem::path& path) {
  std::ifstream file;
  return read_head(file, path).about;
}

}  // namespace tailwater
