#include "io/csv_writer.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <limits>

#include "base/error.h"
#include "io/file_size_limit.h"
#include "io/temporary_folder.h"

namespace tailwater {
namespace {

TEST(CsvWriter, WritesHeaderAndLinesAtOnce) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "probe.csv";
  CsvWriter csv(path, {"time_s", "depth_m"});
  EXPECT_EQ(text_of(path), "time_s,depth_m\n");
  csv.write(std::array{0.0, 0.5});
  EXPECT_EQ(text_of(path), "time_s,depth_m\n0,0.5\n");  // while it is still open
  csv.write(std::array{0.1, -2e-20});
  EXPECT_EQ(text_of(path), "time_s,depth_m\n0,0.5\n0.1,-2e-20\n");
}

TEST(CsvWriter, NumbersReadBackExactly) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "probe.csv";
  const std::array values{1.0 / 3.0, 0.1 + 0.2, 1e300 / 7.0, std::numeric_limits<double>::denorm_min(),
                          std::numeric_limits<double>::max()};
  CsvWriter csv(path, {"a", "b", "c", "d", "e"});
  csv.write(values);
  const std::string text = text_of(path);
  const char* cursor = text.c_str() + text.find('\n') + 1;
  for (const double value : values) {
    char* end = nullptr;
    EXPECT_EQ(std::strtod(cursor, &end), value);
    cursor = end + 1;
  }
}

TEST(CsvWriter, WritesWhatWasNotMeasured) {  // with floating-point traps on, as in a run
  const TemporaryFolder folder;
  const auto path = folder.path() / "steps.csv";
  CsvWriter csv(path, {"a", "b", "c"});
  csv.write(std::array{1.0, std::numeric_limits<double>::quiet_NaN(), 2.0});
  EXPECT_EQ(text_of(path), "a,b,c\n1,nan,2\n");
}

TEST(CsvWriter, EmptiesAnOlderFile) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "probe.csv";
  { CsvWriter(path, {"time_s"}).write(std::array{1.0}); }
  { const CsvWriter csv(path, {"time_s"}); }
  EXPECT_EQ(text_of(path), "time_s\n");
}

TEST(CsvWriter, GoesOnWhereAnEarlierOneWas) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "probe.csv";
  std::int64_t size = 0;
  {
    CsvWriter csv(path, {"time_s"});
    csv.write(std::array{1.0});
    size = csv.size();
    csv.write(std::array{2.5});
  }
  CsvWriter csv(path, {"time_s"}, size);
  EXPECT_EQ(text_of(path), "time_s\n1\n");
  csv.write(std::array{2.0});
  EXPECT_EQ(text_of(path), "time_s\n1\n2\n");
  EXPECT_EQ(csv.size(), static_cast<std::int64_t>(text_of(path).size()));
}

TEST(CsvWriter, DoesNotGoOnWithAnotherFile) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "probe.csv";
  EXPECT_THROW(CsvWriter(path, {"time_s"}, 7), IoError);
  { const CsvWriter csv(path, {"time_s"}); }
  EXPECT_THROW(CsvWriter(path, {"depth_m"}, 7), IoError);
  const std::string message = message_of<IoError>([&] { CsvWriter(path, {"time_s"}, 8); });
  EXPECT_NE(message.find(path.string()), std::string::npos) << message;
  EXPECT_EQ(text_of(path), "time_s\n");
}

TEST(CsvWriter, MissesItsFile) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "probe.csv";
  const CsvWriter csv(path, {"time_s"});
  csv.require_in_place();
  std::filesystem::remove(path);
  EXPECT_THROW(csv.require_in_place(), IoError);
  const CsvWriter other(path, {"time_s"});
  EXPECT_THROW(csv.require_in_place(), IoError);
}

TEST(CsvWriter, ReportsAFolderThatDoesNotExist) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "missing" / "probe.csv";
  const std::string message = message_of<IoError>([&] { CsvWriter(path, {"time_s"}); });
  EXPECT_NE(message.find(path.string()), std::string::npos) << message;
}

TEST(CsvWriter, ReportsAFullDisk) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "table.csv";
  const FileSizeLimit limit(3);
  const std::string message = message_of<IoError>([&] { CsvWriter(path, {"time_s"}); });
  EXPECT_NE(message.find(path.string()), std::string::npos) << message;
  EXPECT_NE(message.find("File too large"), std::string::npos) << message;
}

TEST(CsvWriter, WritesNeitherThroughALinkNorIntoADevice) {
  const TemporaryFolder folder;
  const auto precious = folder.path() / "precious";
  const auto path = folder.path() / "table.csv";
  std::ofstream(precious) << "precious";
  std::filesystem::create_symlink(precious, path);
  EXPECT_THROW(CsvWriter(path, {"a"}), IoError);
  EXPECT_THROW(cut_file(path, 2), IoError);
  EXPECT_EQ(text_of(precious), "precious");
  EXPECT_NE(message_of<IoError>([] { CsvWriter("/dev/full", {"time_s"}); }).find("a device"), std::string::npos);
}

}  // namespace
}  // namespace tailwater
