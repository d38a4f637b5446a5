#include "io/vtp_reader.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cstring>

#include "base/error.h"

namespace tailwater {
namespace {

[[noreturn]] void refuse(const char* why) { throw IoError(why); }

/// The text between `key="` and the next quote of an element.
std::string_view attribute(std::string_view element, std::string_view key) {
  const std::string start = fmt::format(" {}=\"", key);
  const std::size_t begin = element.find(start);
  if (begin == element.npos) refuse("an attribute is missing");
  const std::string_view rest = element.substr(begin + start.size());
  return rest.substr(0, rest.find('"'));
}

template <class Number>
Number number_in(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) refuse("a number is not one");
  return number;
}

/// The data of an array, from its headers on.
class Appended {
 public:
  Appended(std::string_view bytes, bool is_compressed) : bytes_(bytes), is_compressed_(is_compressed) {}

  std::string at(std::size_t offset, std::size_t size) const {
    if (offset > bytes_.size()) refuse("it is not whole");
    std::string_view rest = bytes_.substr(offset);
    if (!is_compressed_) {
      if (take_word(rest) != size || rest.size() < size) refuse("an array has another size");
      return std::string(rest.substr(0, size));
    }
    const std::uint64_t blocks = take_word(rest);
    const std::uint64_t block_size = take_word(rest);
    const std::uint64_t partial = take_word(rest);
    if (blocks > rest.size() / sizeof(std::uint64_t)) refuse("it is not whole");
    std::vector<std::uint64_t> sizes(blocks);
    for (std::uint64_t& compressed : sizes) compressed = take_word(rest);
    std::string data(size, '\0');
    std::size_t filled = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::size_t whole = b + 1 == blocks && partial > 0 ? partial : block_size;
      if (whole > size - filled || sizes[b] > rest.size()) refuse("an array has another size");
      uLongf inflated = whole;
      if (uncompress(reinterpret_cast<Bytef*>(data.data() + filled), &inflated,
                     reinterpret_cast<const Bytef*>(rest.data()), sizes[b]) != Z_OK ||
          inflated != whole) {
        refuse("an array is damaged");
      }
      rest.remove_prefix(sizes[b]);
      filled += whole;
    }
    if (filled != size) refuse("an array has another size");
    return data;
  }

 private:
  static std::uint64_t take_word(std::string_view& bytes) {
    std::uint64_t word = 0;
    if (bytes.size() < sizeof(word)) refuse("it is not whole");
    std::memcpy(&word, bytes.data(), sizeof(word));
    bytes.remove_prefix(sizeof(word));
    return word;
  }

  std::string_view bytes_;
  bool is_compressed_;
};

template <class Stored>
void add_values(const std::string& data, std::vector<double>& values) {
  for (std::size_t k = 0; k < data.size(); k += sizeof(Stored)) {
    Stored value;
    std::memcpy(&value, data.data() + k, sizeof(Stored));
    values.push_back(static_cast<double>(value));
  }
}

void add_array(std::string_view element, std::size_t count, const Appended& appended, VtpFile::Array& array) {
  const std::string_view type = attribute(element, "type");
  array.components = number_in<std::size_t>(attribute(element, "NumberOfComponents"));
  const auto offset = number_in<std::size_t>(attribute(element, "offset"));
  const std::size_t size_of_value = type == "Float32" ? 4 : 8;
  if (array.components < 1 || array.components > 16) refuse("an array has no or too many components");
  const std::string data = appended.at(offset, count * array.components * size_of_value);
  if (type == "Float32") return add_values<float>(data, array.values);
  if (type == "Float64") return add_values<double>(data, array.values);
  if (type == "Int64") return add_values<std::int64_t>(data, array.values);
  refuse("an array has another type");
}

/// Calls body with each element of this name; the text contains the element and everything up to the next.
template <class Body>
void for_each_element(std::string_view xml, std::string_view name, const Body& body) {
  const std::string start = fmt::format("<{} ", name);
  for (std::size_t begin = xml.find(start); begin != xml.npos;) {
    const std::size_t next = xml.find(start, begin + 1);
    body(xml.substr(begin, next == xml.npos ? xml.npos : next - begin));
    begin = next;
  }
}

VtpFile parsed(std::string_view bytes) {
  const std::size_t end = bytes.find("<AppendedData");
  constexpr std::string_view mark = ">\n_";
  const std::size_t begin = bytes.find(mark, end);
  if (end == bytes.npos || begin == bytes.npos) refuse("it is not a file of this program, or not whole");
  const std::string_view xml = bytes.substr(0, end);
  const Appended appended(bytes.substr(begin + mark.size()), xml.find(" compressor=") != xml.npos);
  VtpFile file;
  for_each_element(xml.substr(0, xml.find("<Piece ")), "DataArray", [&](std::string_view element) {
    const std::string_view rest = element.substr(element.find('>') + 1);
    file.time = number_in<double>(rest.substr(0, rest.find('<')));
  });
  for_each_element(xml, "Piece", [&](std::string_view piece) {
    const auto count = number_in<std::size_t>(attribute(piece, "NumberOfPoints"));
    if (count > bytes.size()) refuse("it is not whole");
    file.count += count;
    const std::size_t points = piece.find("<Points>");
    const std::size_t end_of_points = piece.find("</Points>");
    if (points == piece.npos || end_of_points == piece.npos) refuse("it has no points");
    for_each_element(piece.substr(0, points), "DataArray", [&](std::string_view element) {
      add_array(element, count, appended, file.fields[std::string(attribute(element, "Name"))]);
    });
    for_each_element(piece.substr(points, end_of_points - points), "DataArray",
                     [&](std::string_view element) { add_array(element, count, appended, file.points); });
  });
  if (file.points.components != 3) refuse("its points are no points");
  const auto is_whole = [&](const VtpFile::Array& array) {
    return array.values.size() == file.count * array.components;
  };
  const bool are_whole = std::ranges::all_of(file.fields, [&](const auto& field) { return is_whole(field.second); });
  if (!is_whole(file.points) || !are_whole) refuse("an array does not hold all points");
  return file;
}

}  // namespace

VtpFile read_vtp_bytes(std::string_view bytes, const std::string& name) {
  try {
    return parsed(bytes);
  } catch (const IoError& error) {
    throw IoError("cannot read '{}': {}", name, error.what());
  }
}

std::vector<PvdEntry> read_pvd(std::string_view bytes) {
  std::vector<PvdEntry> entries;
  for_each_element(bytes, "DataSet", [&](std::string_view element) {
    entries.push_back({number_in<double>(attribute(element, "timestep")), std::string(attribute(element, "file"))});
  });
  return entries;
}

}  // namespace tailwater
