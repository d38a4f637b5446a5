// Files that all ranks write together; read_back.py checks their contents.
#include <gtest/gtest.h>

#include "base/error.h"
#include "io/file_size_limit.h"
#include "io/run_folder.h"
#include "io/shared_folder.h"
#include "io/write_file.h"

namespace tailwater {
namespace {

namespace fs = std::filesystem;

/// 100 kB, different on each rank.
std::string bytes_of(int rank) {
  std::string bytes;
  for (int k = 0; k < 100'000; ++k) bytes += static_cast<char>(k * (rank + 3) >> 4);
  return bytes;
}

std::size_t count_entries(const fs::path& folder) { return std::distance(fs::directory_iterator(folder), {}); }

/// Expects that all ranks get the same error when they write together; collective.
void expect_same_error(const SharedFolder& folder, const fs::path& path) {
  const std::string bytes = bytes_of(folder.ranks().rank());
  const std::string_view part = bytes;
  const std::string message = message_of<IoError>([&] { write_file(path, {&part, 1}, folder.ranks()); });
  EXPECT_NE(message.find(path.string()), std::string::npos) << message;
  EXPECT_EQ(message, folder.ranks().broadcast(message));
}

TEST(WriteTogether, PartsStandInTheOrderOfRanks) {
  const SharedFolder folder;
  const fs::path path = folder.path() / "file";
  const int rank = folder.ranks().rank();
  // A longer earlier file, and a longer one of a killed run.
  if (folder.ranks().is_root()) {
    write_text_file(path, std::string(1'000'000, 'o'));
    write_text_file(folder.path() / "file.part", std::string(1'000'000, 'p'));
  }
  // Rank r gives r + 1 parts; those of rank 1 are empty.
  const std::string bytes = rank == 1 ? "" : bytes_of(rank);
  const std::vector<std::string_view> parts(rank + 1, bytes);
  write_file(path, parts, folder.ranks());
  folder.ranks().meet();
  std::string expected;
  for (int q = 0; q < folder.ranks().size(); ++q) {
    for (int k = 0; k <= q && q != 1; ++k) expected += bytes_of(q);
  }
  EXPECT_TRUE(text_of(path) == expected);
  EXPECT_EQ(count_entries(folder.path()), 1u);
}

TEST(WriteTogether, AFolderThatDoesNotExistIsTheErrorOfAll) {
  const SharedFolder folder;
  expect_same_error(folder, folder.path() / "missing" / "file");
}

TEST(WriteTogether, AFullDiskIsTheErrorOfAllAndTheOldFileStays) {
  const SharedFolder folder;
  const fs::path path = folder.path() / "file";
  if (folder.ranks().is_root()) write_text_file(path, "old");
  folder.ranks().meet();
  {
    // Only the last rank's part exceeds the limit.
    const FileSizeLimit limit(static_cast<rlim_t>(100'000 * folder.ranks().size() - 1));
    expect_same_error(folder, path);
  }
  folder.ranks().meet();
  EXPECT_EQ(text_of(path), "old");
  EXPECT_EQ(count_entries(folder.path()), 1u);
}

TEST(WriteTogether, TheRunFolderIsMadeOnceAndRefusedByAll) {
  const SharedFolder folder;
  const fs::path path = folder.path() / "run";
  EXPECT_EQ(RunFolder::create(path, false, folder.ranks()).path(), path);
  EXPECT_TRUE(fs::is_directory(path / "fields"));
  const std::string message = message_of<InputError>([&] { RunFolder::create(path, false, folder.ranks()); });
  EXPECT_NE(message.find("--force"), std::string::npos) << message;
  EXPECT_NO_THROW(RunFolder::create(path, true, folder.ranks()));
  EXPECT_THROW(RunFolder::create("/proc/tailwater", false, folder.ranks()), IoError);
}

}  // namespace
}  // namespace tailwater
