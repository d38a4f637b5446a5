#include "io/write_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <vector>

#include "base/error.h"
#include "io/file_size_limit.h"
#include "io/temporary_folder.h"

namespace tailwater {
namespace {

std::size_t count_entries(const std::filesystem::path& folder) {
  return std::distance(std::filesystem::directory_iterator(folder), {});
}

TEST(WriteFile, WritesThePartsInOrderAndReplacesTheOldFile) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "note.txt";
  write_text_file(path, "the old text, which is longer");
  const std::vector<std::string_view> parts{"one ", "", "two"};
  write_file(path, parts);
  EXPECT_EQ(text_of(path), "one two");
  EXPECT_EQ(count_entries(folder.path()), 1u);
}

TEST(WriteFile, KeepsBytesAsTheyAre) {
  const TemporaryFolder folder;
  const std::string bytes("a\0b\r\n\xff", 6);
  write_text_file(folder.path() / "bytes", bytes);
  EXPECT_EQ(text_of(folder.path() / "bytes"), bytes);
}

TEST(WriteFile, NamesThePathAndTheReason) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "missing" / "note.txt";
  const std::string message = message_of<IoError>([&] { write_text_file(path, "text"); });
  EXPECT_NE(message.find(path.string()), std::string::npos) << message;
  EXPECT_NE(message.find("No such file or directory"), std::string::npos) << message;
}

TEST(WriteFile, AFailedWriteKeepsTheOldFileAndLeavesNothingElse) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "note.txt";
  write_text_file(path, "old");
  // Shorter than a buffer (fails when the file is closed) and longer (fails while writing).
  for (const std::size_t size : {2000u, 1000000u}) {
    const FileSizeLimit limit(1000);
    EXPECT_THROW(write_text_file(path, std::string(size, 'x')), IoError) << size;
  }
  EXPECT_EQ(text_of(path), "old");
  EXPECT_EQ(count_entries(folder.path()), 1u);
}

TEST(WriteFile, DoesNotReplaceAFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "note.txt");
  EXPECT_THROW(write_text_file(folder.path() / "note.txt", "text"), IoError);
  EXPECT_EQ(count_entries(folder.path()), 1u);
}

TEST(WriteFile, NeitherFollowsNorReplacesWhatIsNoFile) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "note.txt";
  const auto part = folder.path() / "note.txt.part";
  write_text_file(folder.path() / "precious", "precious");
  for (const auto& place : {path, part}) {
    std::filesystem::create_symlink(folder.path() / "precious", place);
    EXPECT_NE(message_of<IoError>([&] { write_text_file(path, "text"); }).find("a link is in its place"),
              std::string::npos);
    EXPECT_EQ(text_of(folder.path() / "precious"), "precious");
    EXPECT_TRUE(std::filesystem::is_symlink(place));
    std::filesystem::remove(place);
    ASSERT_EQ(mkfifo(place.c_str(), 0600), 0);
    EXPECT_NE(message_of<IoError>([&] { write_text_file(path, "text"); }).find("a device or a pipe is in its place"),
              std::string::npos);
    EXPECT_TRUE(std::filesystem::is_fifo(place));
    std::filesystem::remove(place);
  }
  write_text_file(part, "what a killed run has left");
  write_text_file(path, "text");
  EXPECT_EQ(count_entries(folder.path()), 2u);
}

TEST(WriteFile, NamesWhatIsNotReplaced) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "thing";
  EXPECT_EQ(obstacle_at(path), "");
  write_text_file(path, "own");
  EXPECT_EQ(obstacle_at(path), "");
  EXPECT_EQ(obstacle_at(folder.path()), "a folder");
  EXPECT_EQ(obstacle_at("/dev/null"), "a device or a pipe");
  if (geteuid() == 0) {
    ASSERT_EQ(chown(path.c_str(), 12345, 12345), 0);
    EXPECT_EQ(obstacle_at(path), "another user's file");
    write_text_file(path, "in a folder that is shared");  // of a run
  }
}

}  // namespace
}  // namespace tailwater
