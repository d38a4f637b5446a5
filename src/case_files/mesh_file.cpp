// This module has its own readers: Debian's library for these formats hangs on truncated files, and rounds coordinates
// to seven digits.
#include "case_files/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string_view>

#include "base/error.h"
#include "base/input_file.h"

namespace tailwater {
namespace {

static_assert(std::endian::native == std::endian::little, "binary files are read as they are");

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// The bytes of a file, taken from the front.
class Source {
 public:
  Source(std::string bytes, std::string start) : bytes_(std::move(bytes)), start_(std::move(start)) {}

  std::size_t size() const { return bytes_.size(); }
  std::string_view rest() const { return std::string_view(bytes_).substr(at_); }
  bool is_at_end() const { return at_ == bytes_.size(); }

  template <class... Arguments>
  [[noreturn]] void refuse(fmt::format_string<Arguments...> text, Arguments&&... arguments) const {
    throw InputError(start_ + fmt::format(text, std::forward<Arguments>(arguments)...));
  }
  [[noreturn]] void refuse_line(std::string_view what) const {
    refuse("line {}: {}: it is damaged or cut off; export the mesh again", line_, what);
  }

  /// The words of the next line that has any; none at the end.
  std::vector<std::string_view> words() {
    std::vector<std::string_view> found;
    while (found.empty() && !is_at_end()) {
      ++line_;
      const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
      std::string_view line = std::string_view(bytes_).substr(at_, end - at_);
      at_ = std::min(end + 1, bytes_.size());
      constexpr std::string_view blanks = " \t\r";
      for (std::size_t begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
        const std::size_t stop = std::min(line.find_first_of(blanks, begin), line.size());
        found.push_back(line.substr(begin, stop - begin));
        begin = line.find_first_not_of(blanks, stop);
      }
    }
    return found;
  }

  template <class Number>
  Number binary() {
    if (rest().size() < sizeof(Number)) refuse("ends before its last triangle: it is cut off; export the mesh again");
    Number value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(Number));
    at_ += sizeof(Number);
    return value;
  }

  double number(std::string_view word) const {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) {
      refuse_line(fmt::format("\"{}\" is not a number", word.substr(0, 40)));
    }
    return value;
  }
  std::int64_t whole(std::string_view word) const {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) {
      refuse_line(fmt::format("\"{}\" is not a whole number", word.substr(0, 40)));
    }
    return value;
  }
  Vec<3> point(const std::vector<std::string_view>& words, std::size_t first) const {
    if (words.size() < first + 3) refuse_line("a point needs three numbers");
    return {number(words[first]), number(words[first + 1]), number(words[first + 2])};
  }

 private:
  std::string bytes_;
  std::string start_;  ///< begin of messages
  std::size_t at_ = 0;
  std::size_t line_ = 0;
};

/// Adds a polygon as triangles with its first corner in common; `corner(k)` counts points from 0.
template <class Corner>
void add_polygon(const Source& source, std::size_t corners, Corner&& corner, MeshTriangles& mesh) {
  std::vector<int> points;
  for (std::size_t k = 0; k < corners; ++k) {
    const std::int64_t point = corner(k);
    if (point < 0 || point >= static_cast<std::int64_t>(mesh.points.size())) {
      source.refuse(
          "triangle {} has a corner that the file does not have: it is damaged or cut off; export the mesh again",
          mesh.triangles.size() + 1);
    }
    points.push_back(static_cast<int>(point));
  }
  for (std::size_t k = 2; k < points.size(); ++k) mesh.triangles.push_back({points[0], points[k - 1], points[k]});
}

MeshTriangles read_stl(Source& source) {
  MeshTriangles mesh;
  const auto close_triangle = [&] {
    const int end = static_cast<int>(mesh.points.size());
    mesh.triangles.push_back({end - 3, end - 2, end - 1});
  };
  constexpr std::size_t header = 80, per_triangle = 50;
  std::uint32_t count = 0;
  if (source.size() >= header + 4) std::memcpy(&count, source.rest().data() + header, 4);
  const std::size_t binary_size = header + 4 + per_triangle * count;
  const bool looks_like_text = source.rest().starts_with("solid") && source.size() != binary_size;
  if (!looks_like_text) {
    if (source.size() < header + 4 || source.size() < binary_size) {
      source.refuse(
          "has {} bytes, and an STL file of {} triangles has {}: it is cut off or of another kind; export the mesh "
          "again",
          source.size(), count, binary_size);
    }
    if (source.size() >= binary_size + per_triangle) {
      source.refuse("holds {} triangles, but its header says {}: it is damaged; export the mesh again",
                    (source.size() - header - 4) / per_triangle, count);
    }
    for (std::size_t k = 0; k < header + 4; k += 4) source.binary<std::uint32_t>();
    for (std::uint32_t t = 0; t < count; ++t) {
      for (int k = 0; k < 3; ++k) source.binary<float>();  // the normal follows from the corners
      for (int c = 0; c < 3; ++c) {
        Vec<3> x;
        for (double& coordinate : x) coordinate = source.binary<float>();
        mesh.points.push_back(x);
      }
      source.binary<std::uint16_t>();
      close_triangle();
    }
    return mesh;
  }
  bool is_ended = false;
  for (std::vector<std::string_view> words = source.words(); !words.empty(); words = source.words()) {
    const std::string first = lower_case(std::string(words[0]));
    if (first == "vertex") mesh.points.push_back(source.point(words, 1));
    if (first == "endfacet") {
      if (mesh.points.size() != 3 * (mesh.triangles.size() + 1)) source.refuse_line("a triangle needs three corners");
      close_triangle();
    }
    is_ended = first == "endsolid";
  }
  if (!is_ended) source.refuse("does not end with endsolid: it is cut off; export the mesh again");
  return mesh;
}

MeshTriangles read_obj(Source& source) {
  MeshTriangles mesh;
  for (std::vector<std::string_view> words = source.words(); !words.empty(); words = source.words()) {
    if (words[0] == "v") mesh.points.push_back(source.point(words, 1));
    if (words[0] != "f") continue;
    if (words.size() < 4) source.refuse_line("a face needs three corners");
    add_polygon(
        source, words.size() - 1,
        [&](std::size_t k) {
          const std::int64_t index = source.whole(words[k + 1].substr(0, words[k + 1].find('/')));
          return index < 0 ? static_cast<std::int64_t>(mesh.points.size()) + index : index - 1;
        },
        mesh);
  }
  return mesh;
}

/// A property of a PLY element: a number, or a list of them with its length before it.
struct PlyProperty {
  std::string type, length_type, name;
};
struct PlyElement {
  std::string name;
  std::int64_t count;
  std::vector<PlyProperty> properties;
};

double ply_number(Source& source, const std::string& type) {
  if (type == "float" || type == "float32") return source.binary<float>();
  if (type == "double" || type == "float64") return source.binary<double>();
  if (type == "char" || type == "int8") return source.binary<std::int8_t>();
  if (type == "uchar" || type == "uint8") return source.binary<std::uint8_t>();
  if (type == "short" || type == "int16") return source.binary<std::int16_t>();
  if (type == "ushort" || type == "uint16") return source.binary<std::uint16_t>();
  if (type == "int" || type == "int32") return source.binary<std::int32_t>();
  if (type == "uint" || type == "uint32") return source.binary<std::uint32_t>();
  source.refuse("has the unknown type \"{}\" in its header: export the mesh again", type);
}

/// A number as an index; -1, which no point has, if it cannot be one.
std::int64_t index_of(double number) {
  return std::isfinite(number) && std::abs(number) < 1e9 ? static_cast<std::int64_t>(number) : -1;
}

/// Throws InputError unless points have each of their three coordinates once.
void require_coordinates(const Source& source, const PlyElement& points) {
  for (const std::string axis : {"x", "y", "z"}) {
    const auto count = std::ranges::count(points.properties, axis, &PlyProperty::name);
    if (count == 1) continue;
    std::vector<std::string> names;
    for (const PlyProperty& property : points.properties) names.push_back(property.name);
    source.refuse("has {} property \"{}\" of its points, which have {}: name their coordinates x, y and z",
                  count == 0 ? "no" : "more than one", axis, fmt::join(names, ", "));
  }
}

MeshTriangles read_ply(Source& source) {
  std::vector<PlyElement> elements;
  bool is_text = false;
  if (source.words() != std::vector<std::string_view>{"ply"}) source.refuse_line("does not begin with \"ply\"");
  for (;;) {
    const std::vector<std::string_view> words = source.words();
    if (words.empty()) source.refuse_line("the header does not end");
    if (words[0] == "end_header") break;
    if (words[0] == "format" && words.size() > 1) {
      is_text = words[1] == "ascii";
      if (!is_text && words[1] != "binary_little_endian") {
        source.refuse("has the format {}: export it as ascii or binary_little_endian", words[1]);
      }
    } else if (words[0] == "element" && words.size() == 3) {
      elements.push_back({std::string(words[1]), source.whole(words[2]), {}});
    } else if (words[0] == "property" && words.size() >= 3 && !elements.empty()) {
      const bool is_list = words[1] == "list" && words.size() == 5;
      elements.back().properties.push_back({std::string(is_list ? words[3] : words[1]),
                                            std::string(is_list ? words[2] : ""), std::string(words.back())});
    }
  }
  MeshTriangles mesh;
  for (const PlyElement& element : elements) {
    if (element.count > static_cast<std::int64_t>(source.rest().size())) {
      source.refuse("has {} of element \"{}\" in its header and {} bytes left: it is cut off; export the mesh again",
                    element.count, element.name, source.rest().size());
    }
    if (element.name == "vertex") require_coordinates(source, element);
    for (std::int64_t k = 0; k < element.count; ++k) {
      std::vector<std::string_view> words;
      if (is_text && (words = source.words()).empty()) source.refuse_line("the file ends too early");
      std::size_t used = 0;
      const auto next = [&](const std::string& type) {
        if (!is_text) return ply_number(source, type);
        if (used == words.size()) source.refuse_line("has too few numbers");
        return source.number(words[used++]);
      };
      Vec<3> x = Vec<3>::Zero();
      for (const PlyProperty& property : element.properties) {
        if (property.length_type.empty()) {
          const double value = next(property.type);
          if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z')
            x[property.name[0] - 'x'] = value;
          continue;
        }
        const std::int64_t length = index_of(next(property.length_type));
        std::vector<double> list;
        for (std::int64_t n = 0; n < length; ++n) list.push_back(next(property.type));
        if (element.name != "face" || !property.name.starts_with("vertex_ind")) continue;
        add_polygon(
            source, list.size(), [&](std::size_t c) { return index_of(list[c]); }, mesh);
      }
      if (element.name == "vertex") mesh.points.push_back(x);
    }
  }
  return mesh;
}

}  // namespace

MeshTriangles read_mesh(const std::filesystem::path& path) {
  const std::string start = fmt::format("file {}: ", path.string());
  const std::string kind = lower_case(path.extension().string());
  if (kind != ".stl" && kind != ".obj" && kind != ".ply") {
    throw InputError(start +
                     fmt::format("\"{}\" is no kind of mesh that is read here: export it as .stl, .obj or .ply", kind));
  }
  std::ifstream file = open_input_file(path, {.name = "a mesh file", .largest = largest_mesh_file});
  if (!file) throw InputError(start + "cannot be read: check its name, which is relative to the case file");
  Source source(read_bytes(file, largest_mesh_file), start);
  if (source.size() == 0) source.refuse("is empty: export the mesh again");
  MeshTriangles mesh = kind == ".stl" ? read_stl(source) : kind == ".obj" ? read_obj(source) : read_ply(source);
  if (mesh.triangles.empty()) source.refuse("has no triangles: export the mesh again, as triangles");
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int corner : mesh.triangles[t]) {
      if (mesh.points[corner].allFinite()) continue;
      source.refuse("triangle {} has a corner that is not a number: correct it, or export the mesh again", t + 1);
    }
  }
  return mesh;
}

}  // namespace tailwater
