#include "io/vtp_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <string_view>

#include "base/assert.h"
#include "base/for_each.h"
#include "base/fp_traps.h"
#include "io/deflate.h"
#include "io/write_file.h"

namespace tailwater {

namespace {

static_assert(std::endian::native == std::endian::little, "VTP files are written in the machine's byte order");

/// VTK's own default: bytes per zlib block before compression.
constexpr std::size_t block_size = 32768;

void append_header(std::string& bytes, std::span<const std::uint64_t> words) {
  bytes.append(reinterpret_cast<const char*>(words.data()), words.size_bytes());
}

/// [byte count] data
void append_plain(std::string& bytes, std::string_view data) {
  const std::uint64_t size = data.size();
  append_header(bytes, {&size, 1});
  bytes.append(data);
}

/// [block count][block size][size of a partial last block, or 0][compressed sizes...] compressed blocks
void append_compressed(std::string& bytes, std::string_view data, int level) {
  std::vector<std::uint64_t> header{(data.size() + block_size - 1) / block_size, block_size, data.size() % block_size};
  std::string blocks;
  for (std::size_t begin = 0; begin < data.size(); begin += block_size) {
    const std::string block = deflated(data.substr(begin, block_size), level);
    header.push_back(block.size());
    blocks += block;
  }
  append_header(bytes, header);
  bytes += blocks;
}

template <class Value>
constexpr std::string_view vtk_type() {
  if constexpr (std::is_same_v<Value, double>) {
    return "Float64";
  } else if constexpr (std::is_same_v<Value, float>) {
    return "Float32";
  } else {
    static_assert(std::is_same_v<Value, std::int64_t>);
    return "Int64";
  }
}

/// Appends the encoded `values` to `piece` and returns their description.
template <class Value>
EncodedPiece::Array append_array(EncodedPiece& piece, std::string name, int components,
                                 const std::vector<Value>& values, int compression) {
  EncodedPiece::Array array{std::move(name), std::string(vtk_type<Value>()), components, piece.bytes.size()};
  const std::string_view data(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
  if (compression == 0) {
    append_plain(piece.bytes, data);
  } else {
    append_compressed(piece.bytes, data, compression);
  }
  return array;
}

template <class Value, int Dim>
std::vector<Value> three_components(std::span<const Vec<Dim>> vectors) {
  std::vector<Value> values(3 * vectors.size(), Value(0));
  for_each(vectors.size(), [&](std::size_t i) {
    for (int d = 0; d < Dim; ++d) values[3 * i + d] = static_cast<Value>(vectors[i][d]);
  });
  return values;
}

/// The values as stored in the file, for each kind of field.
std::vector<float> stored(std::span<const double> values) {
  std::vector<float> result(values.size());
  std::transform(values.begin(), values.end(), result.begin(), [](double v) { return static_cast<float>(v); });
  return result;
}
template <int Dim>
std::vector<float> stored(std::span<const Vec<Dim>> values) {
  return three_components<float, Dim>(values);
}
std::vector<std::int64_t> stored(std::span<const std::int64_t> values) { return {values.begin(), values.end()}; }

/// first, first + step, ...
std::vector<std::int64_t> progression(std::size_t count, std::int64_t first, std::int64_t step) {
  std::vector<std::int64_t> values(count);
  for_each(count, [&](std::size_t i) { values[i] = first + step * static_cast<std::int64_t>(i); });
  return values;
}

void append_array_xml(std::string& xml, const EncodedPiece::Array& array, std::size_t piece_offset) {
  fmt::format_to(
      std::back_inserter(xml),
      "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
      array.type, array.name, array.components, piece_offset + array.offset);
}

/// The document's type declares the appended bytes as raw, and their tag, which has one blank only, does not. VTK gives
/// expat the tag, and then the end of a document of 14 bytes. An expat of 2024 or newer, which Debian 12 has too, reads
/// the tag again when twice as much text is available. With `encoding="raw"` in the tag VTK would then parse raw bytes
/// as XML.
void append_head_xml(std::string& xml, double time, int compression) {
  fmt::format_to(
      std::back_inserter(xml),
      "<?xml version=\"1.0\"?>\n"
      "<!DOCTYPE VTKFile [<!ATTLIST AppendedData encoding CDATA \"raw\">]>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"{}>\n"
      "  <PolyData>\n"
      "    <FieldData>\n"
      "      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>\n"
      "    </FieldData>\n",
      compression == 0 ? "" : " compressor=\"vtkZLibDataCompressor\"", time);
}

void append_piece_xml(std::string& xml, const EncodedPiece& piece, std::size_t piece_offset) {
  constexpr std::array<std::string_view, 3> cells{"Verts", "Lines", "Polys"};
  const std::string_view kind = cells[piece.corners - 1];
  fmt::format_to(std::back_inserter(xml), "    <Piece NumberOfPoints=\"{}\" NumberOf{}=\"{}\">\n", piece.count, kind,
                 piece.count / piece.corners);
  xml += "      <PointData>\n";
  for (const EncodedPiece::Array& field : piece.fields) append_array_xml(xml, field, piece_offset);
  xml += "      </PointData>\n      <Points>\n";
  append_array_xml(xml, piece.points, piece_offset);
  fmt::format_to(std::back_inserter(xml), "      </Points>\n      <{}>\n", kind);
  append_array_xml(xml, piece.connectivity, piece_offset);
  append_array_xml(xml, piece.offsets, piece_offset);
  fmt::format_to(std::back_inserter(xml), "      </{}>\n    </Piece>\n", kind);
}

}  // namespace

template <int Dim>
EncodedPiece encode_piece(const ParticleFields<Dim>& particles, int compression) {
  // The fields of a failed run may exceed Float32. They become infinities in the file.
  const SuspendFpTraps suspend;
  EncodedPiece piece;
  piece.count = particles.position.size();
  piece.corners = particles.corners;
  if (compression == 0) {
    // Space for points, their numbers and fields of up to three components, so that nothing is copied as it grows.
    piece.bytes.reserve(piece.count * sizeof(double) * (5 + 3 * particles.fields.size()));
  }
  for (const ParticleField<Dim>& field : particles.fields) {
    std::visit(
        [&]<class Value>(std::span<const Value> values) {
          TAILWATER_ASSERT(values.size() == piece.count, "a field has one value per particle");
          const int components = std::is_same_v<Value, Vec<Dim>> ? 3 : 1;
          piece.fields.push_back(append_array(piece, field.name, components, stored(values), compression));
        },
        field.values);
  }
  piece.points = append_array(piece, "Points", 3, three_components<double, Dim>(particles.position), compression);
  piece.connectivity = append_array(piece, "connectivity", 1, progression(piece.count, 0, 1), compression);
  piece.offsets = append_array(piece, "offsets", 1,
                               progression(piece.count / piece.corners, piece.corners, piece.corners), compression);
  return piece;
}

void write_vtp(const std::filesystem::path& path, double time, const EncodedPiece& piece, int compression,
               const Communicator& ranks) {
  // VTK cannot read a file without a piece.
  const bool all_are_empty = !ranks.any(piece.count > 0);
  const bool is_shown = piece.count > 0 || (all_are_empty && ranks.is_root());
  const std::string_view bytes = is_shown ? std::string_view(piece.bytes) : std::string_view();
  std::string xml;
  if (ranks.is_root()) append_head_xml(xml, time, compression);
  std::string piece_xml;
  const auto offset = static_cast<std::size_t>(ranks.sum_before(static_cast<std::int64_t>(bytes.size())));
  if (is_shown) append_piece_xml(piece_xml, piece, offset);
  for (const std::string& part : ranks.gather(piece_xml)) xml += part;
  if (ranks.is_root()) xml += "  </PolyData>\n  <AppendedData >\n_";
  const bool is_last = ranks.rank() == ranks.size() - 1;
  const std::array<std::string_view, 3> parts{xml, bytes, is_last ? "\n  </AppendedData>\n</VTKFile>\n" : ""};
  write_file(path, parts, ranks);
}

TAILWATER_IN_2D_AND_3D(encode_piece);

}  // namespace tailwater
