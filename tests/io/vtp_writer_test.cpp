// The layout of the field files, byte by byte where VTK's reader would forgive; read_back.py compares the values.
#include "io/vtp_writer.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <limits>

#include "base/error.h"
#include "io/pvd_series.h"
#include "io/temporary_folder.h"

namespace tailwater {
namespace {

template <class Value>
Value value_at(const std::string& bytes, std::size_t offset) {
  Value value;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

/// The word `index` of the UInt64 header that starts at `offset`.
std::uint64_t header_word(const std::string& bytes, std::size_t offset, std::size_t index) {
  return value_at<std::uint64_t>(bytes, offset + 8 * index);
}

TEST(VtpWriter, PlainArraysAreAByteCountAndTheValues) {
  const std::vector<Vec<2>> position{{0.1, 0.2}, {0.3, 0.4}};
  const std::vector<double> pressure{5.0, 1.0 / 3.0};
  const EncodedPiece piece = encode_piece<2>({position, {{"pressure", std::span<const double>(pressure)}}}, 0);
  ASSERT_EQ(piece.fields.size(), 1u);
  EXPECT_EQ(piece.fields[0].type, "Float32");
  EXPECT_EQ(header_word(piece.bytes, piece.fields[0].offset, 0), 2 * sizeof(float));
  EXPECT_EQ(value_at<float>(piece.bytes, piece.fields[0].offset + 12), static_cast<float>(1.0 / 3.0));
  EXPECT_EQ(piece.points.type, "Float64");
  EXPECT_EQ(header_word(piece.bytes, piece.points.offset, 0), 6 * sizeof(double));
  EXPECT_EQ(value_at<double>(piece.bytes, piece.points.offset + 8 + 3 * 8), 0.3);
  EXPECT_EQ(value_at<double>(piece.bytes, piece.points.offset + 8 + 5 * 8), 0.0);
}

TEST(VtpWriter, CompressedArraysAreZlibBlocks) {
  // 10 000 ids are 80 000 bytes: two blocks of 32 KiB and one of 14 464 bytes.
  const std::vector<Vec<3>> position(10000, Vec<3>::Zero());
  std::vector<std::int64_t> id(position.size());
  for (std::size_t i = 0; i < id.size(); ++i) {
    id[i] = static_cast<std::int64_t>(i * i);
  }
  const EncodedPiece piece = encode_piece<3>({position, {{"id", std::span<const std::int64_t>(id)}}}, 6);
  const std::size_t offset = piece.fields[0].offset;
  ASSERT_EQ(header_word(piece.bytes, offset, 0), 3u);
  EXPECT_EQ(header_word(piece.bytes, offset, 1), 32768u);
  EXPECT_EQ(header_word(piece.bytes, offset, 2), 80000u - 2u * 32768u);
  std::string values;
  std::size_t cursor = offset + 6 * 8;
  for (int block = 0; block < 3; ++block) {
    std::vector<Bytef> buffer(32768);
    uLongf size = buffer.size();
    const std::uint64_t compressed = header_word(piece.bytes, offset, 3 + block);
    ASSERT_EQ(uncompress(buffer.data(), &size, reinterpret_cast<const Bytef*>(piece.bytes.data() + cursor), compressed),
              Z_OK);
    values.append(reinterpret_cast<const char*>(buffer.data()), size);
    cursor += compressed;
  }
  ASSERT_EQ(values.size(), 80000u);
  EXPECT_EQ(std::memcmp(values.data(), id.data(), values.size()), 0);
}

TEST(VtpWriter, ALastBlockThatIsFullCountsAsNoPartialOne) {
  const std::vector<Vec<2>> position(4096, Vec<2>::Zero());  // 4096 Int64 are exactly one block
  const EncodedPiece piece = encode_piece<2>({position, {}}, 1);
  EXPECT_EQ(header_word(piece.bytes, piece.connectivity.offset, 0), 1u);
  EXPECT_EQ(header_word(piece.bytes, piece.connectivity.offset, 2), 0u);
}

TEST(VtpWriter, ValuesBeyondFloat32BecomeInfinityWithoutATrap) {
  const std::vector<Vec<2>> position{{0.0, 0.0}, {1.0, 0.0}};
  const std::vector<double> pressure{1e300, std::numeric_limits<double>::quiet_NaN()};
  const EncodedPiece piece = encode_piece<2>({position, {{"pressure", std::span<const double>(pressure)}}}, 0);
  EXPECT_EQ(value_at<float>(piece.bytes, piece.fields[0].offset + 8), std::numeric_limits<float>::infinity());
}

TEST(VtpWriter, ReportsAFolderThatDoesNotExist) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "missing" / "fields.vtp";
  const EncodedPiece piece = encode_piece<2>({}, 0);
  const std::string message = message_of<IoError>([&] { write_vtp(path, 0.0, piece, 0); });
  EXPECT_NE(message.find(path.string()), std::string::npos) << message;
}

TEST(PvdSeries, ListsEveryFileOnceItIsThere) {
  const TemporaryFolder folder;
  const std::vector<Vec<2>> position{{0.0, 0.0}};
  PvdSeries series(folder.path(), "fields", 1);
  for (const double time : {0.0, 0.1, 0.25}) {
    series.write<2>(time, {position, {}});
    const std::string list = text_of(folder.path() / "fields.pvd");
    EXPECT_NE(list.find("file=\"fields_0000" + std::to_string(series.size() - 1) + ".vtp\""), std::string::npos);
    EXPECT_NE(list.find("</VTKFile>"), std::string::npos);
  }
  EXPECT_EQ(series.size(), 3u);
  EXPECT_NE(text_of(folder.path() / "fields.pvd").find("timestep=\"0.25\""), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "fields.pvd.part"));
}

TEST(PvdSeries, GoesOnWithoutTheLaterFilesOrSaysThatTheyCannotBeRemoved) {
  const TemporaryFolder folder;
  const std::vector<Vec<2>> position{{0.0, 0.0}};
  PvdSeries series(folder.path(), "fields", 1);
  for (const double time : {0.0, 0.1, 0.25}) series.write<2>(time, {position, {}});
  series.go_on({0.0, 0.1});
  const std::filesystem::path later = folder.path() / "fields_00002.vtp";
  EXPECT_FALSE(std::filesystem::exists(later));
  std::filesystem::create_directories(later / "foreign");  // no file, and no empty folder either
  const std::string message = message_of<IoError>([&] { series.go_on({0.0, 0.1}); });
  EXPECT_NE(message.find(later.string()), std::string::npos) << message;
}

}  // namespace
}  // namespace tailwater
