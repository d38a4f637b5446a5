// Particles as VTK XML PolyData (.vtp): points, one vertex per particle (or lines or triangles between points, for
// walls), point fields, the time as field data "TimeValue". Appended raw binary, little endian, UInt64 headers,
// optionally zlib blocks (VTK file formats, "XML file formats"). Points are Float64, fields Float32, integers Int64; in
// 2D the third coordinate is 0.
//
// VTP files listed by a PVD are used instead of VTKHDF, because the VTKHDF reader of Debian 12's ParaView (5.11) does
// not support time steps. PVD and VTP work there and in the newest ParaView.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/vec.h"
#include "parallel/communicator.h"

namespace tailwater {

/// One named quantity with a value per particle. Borrows its values.
template <int Dim>
struct ParticleField {
  std::string name;
  std::variant<std::span<const double>, std::span<const Vec<Dim>>, std::span<const std::int64_t>> values;
};

/// The content of one field file: a set of particles with fields. Borrows its values.
template <int Dim>
struct ParticleFields {
  std::span<const Vec<Dim>> position;  ///< m
  std::vector<ParticleField<Dim>> fields;
  int corners = 1;  ///< consecutive points per cell: a vertex (1), a line (2) or a triangle (3)
};

/// A <Piece> ready to be written: its arrays' descriptions and their encoded bytes. Offsets count from the first byte
/// of this piece, because its place in the file is known only when the pieces of all ranks are made.
struct EncodedPiece {
  struct Array {
    std::string name;
    std::string type;
    int components;
    std::size_t offset;
  };
  std::size_t count = 0;  ///< points
  int corners = 1;        ///< points per cell
  std::vector<Array> fields;
  Array points;
  Array connectivity;
  Array offsets;
  std::string bytes;
};

/// zlib level of the files of a run: the quickest.
inline constexpr int usual_compression = 1;

/// Encodes particles with zlib level `compression` (0: none, up to 9).
template <int Dim>
EncodedPiece encode_piece(const ParticleFields<Dim>& particles, int compression = usual_compression);

/// Writes one file at time `time` [s]. Collective: a piece per rank, all with the same fields and encoded with the same
/// `compression`. Every rank writes its own piece into the file. Empty pieces are left out, unless all are empty.
/// Throws IoError, on all ranks; never leaves an incomplete file.
void write_vtp(const std::filesystem::path& path, double time, const EncodedPiece& piece,
               int compression = usual_compression, const Communicator& ranks = {});

}  // namespace tailwater
