#include "io/sealed_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "base/error.h"
#include "io/temporary_folder.h"

namespace tailwater {
namespace {

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return (std::stringstream() << file.rdbuf()).str();
}

TEST(SealedFile, GivesBackItsContent) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "sealed";
  write_sealed_file(path, {3, "program 1.0 (commit abc)", 4, ""}, std::string("body\0body", 9));
  const SealedFile read = read_sealed_file(path);
  EXPECT_EQ(read.format, 3);
  EXPECT_EQ(read.writer, "program 1.0 (commit abc)");
  EXPECT_EQ(read.ranks, 4);
  EXPECT_EQ(read.body, std::string("body\0body", 9));
  EXPECT_EQ(read_head_of_sealed_file(path).ranks, 4);
}

TEST(SealedFile, ShowsEveryFlippedBit) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "sealed";
  write_sealed_file(path, {1, "program", 1, ""}, "body");
  const std::string whole = bytes_of(path);
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const auto put = [&](std::size_t place, int byte) {
    file.seekp(static_cast<std::streamoff>(place));
    file.put(static_cast<char>(byte));
    file.flush();
  };
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    put(bit / 8, whole[bit / 8] ^ (1 << bit % 8));
    EXPECT_THROW(read_sealed_file(path), IoError) << "bit " << bit;
    put(bit / 8, whole[bit / 8]);
  }
  EXPECT_EQ(read_sealed_file(path).body, "body");
}

TEST(SealedFile, ShowsThatItWasCutOrGrew) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "sealed";
  write_sealed_file(path, {1, "program", 1, ""}, "body");
  std::ofstream(path, std::ios::app | std::ios::binary) << "x";
  EXPECT_THROW(read_sealed_file(path), IoError);
  for (std::size_t size = 512 + 4; size-- > 0;) {
    std::filesystem::resize_file(path, size);
    EXPECT_THROW(read_sealed_file(path), IoError) << size << " bytes";
  }
  EXPECT_THROW(read_sealed_file(folder.path() / "missing"), IoError);
}

}  // namespace
}  // namespace tailwater
