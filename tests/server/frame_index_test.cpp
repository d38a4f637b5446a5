// Which frames a run has, as it writes, is resumed, or has none but field files; and nothing outside of its folder.
#include "server/frame_index.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/box.h"
#include "base/error.h"
#include "io/pvd_series.h"
#include "io/temporary_folder.h"
#include "io/write_file.h"
#include "server/run_watch.h"
#include "view/frame_series.h"

namespace tailwater {
namespace {

namespace fs = std::filesystem;

struct Water {
  std::vector<std::int64_t> id{3, 1};
  std::vector<Vec<2>> position{{0.25, 0.5}, {1.0, 0.0}};
  std::vector<Vec<2>> velocity{{3.0, 4.0}, {0.0, 0.0}};
  std::vector<double> pressure{100.0, 50.0};
  std::vector<double> speed{5.0, 0.0};

  WaterNow<2> at(double time) const {
    return {.time = time, .id = id, .position = position, .scalars = {pressure, speed}, .poses = {}};
  }
};

FrameSeries<2> series_in(const fs::path& folder) { return {folder / "view", 0.1, Box<2>(Vec<2>(0, 0), Vec<2>(2, 2))}; }

TEST(FrameIndex, FollowsARunThatWritesAndIsResumed) {
  const TemporaryFolder folder;
  FrameSeries<2> series = series_in(folder.path());
  FrameIndex index{FolderReader(folder.path())};
  EXPECT_TRUE(index.look().added.empty());
  const Water water;
  for (int k = 0; k < 4; ++k) series.write(water.at(0.25 * k));
  EXPECT_EQ(index.look().added, (std::vector<std::uint32_t>{0, 1, 2, 3}));
  EXPECT_TRUE(index.look().added.empty());
  EXPECT_EQ(index.frames().at(2).time, 0.5);
  EXPECT_EQ(index.bytes_of(2), text_of(folder.path() / "view" / "00002.frame"));
  FrameSeries<2> resumed = series_in(folder.path());
  resumed.go_on(2);
  const FrameIndex::News cut = index.look();
  EXPECT_TRUE(cut.is_cut);
  EXPECT_EQ(cut.cut_time, 0.25);
  resumed.write(water.at(0.625));
  EXPECT_EQ(index.look().added, std::vector<std::uint32_t>{2});
  EXPECT_EQ(index.frames().at(2).time, 0.625);
  // Cut and written again between two looks.
  FrameSeries<2> again = series_in(folder.path());
  again.go_on(1);
  again.write(water.at(0.125));
  again.write(water.at(0.375));
  const FrameIndex::News news = index.look();
  EXPECT_TRUE(news.is_cut);
  EXPECT_EQ(news.cut_time, 0.0);
  EXPECT_EQ(news.added, (std::vector<std::uint32_t>{1, 2}));
}

TEST(FrameIndex, AFrameThatIsNotWholeIsNotThere) {
  const TemporaryFolder folder;
  FrameSeries<2> series = series_in(folder.path());
  series.write(Water().at(0.0));
  series.write(Water().at(0.1));
  const fs::path last = folder.path() / "view" / "00001.frame";
  const std::string bytes = text_of(last);
  write_text_file(last, bytes.substr(0, bytes.size() - 1));
  write_text_file(folder.path() / "view" / "x.frame", bytes);
  FrameIndex index{FolderReader(folder.path())};
  EXPECT_EQ(index.look().added, std::vector<std::uint32_t>{0});
}

TEST(FrameIndex, MakesFramesOfFieldFiles) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "fields");
  const Water water;
  for (const int compression : {0, 6}) {
    PvdSeries series(folder.path() / "fields", "fields", compression);
    for (const double time : {0.0, 0.5}) {
      series.write<2>(time, {.position = water.position,
                             .fields = {{"pressure", std::span<const double>(water.pressure)},
                                        {"velocity", std::span<const Vec<2>>(water.velocity)},
                                        {"id", std::span<const std::int64_t>(water.id)}}});
    }
    FrameIndex index{FolderReader(folder.path())};
    EXPECT_EQ(index.look().added.size(), 2U);
    EXPECT_EQ(index.frames().at(1).time, 0.5);
    const Frame frame = decode_frame(index.bytes_of(1).value(), {});
    EXPECT_EQ(frame.head.time, 0.5);
    EXPECT_EQ(frame.head.index, 1U);
    EXPECT_EQ(frame.particles.id, (std::vector<std::int64_t>{1, 3}));
    EXPECT_EQ(frame.head.scale.low, (std::vector<double>{0.25, 0.0}));
    EXPECT_EQ(frame.head.scale.high, (std::vector<double>{1.0, 0.5}));
    EXPECT_EQ(frame.particles.place[0], (std::vector<std::uint16_t>{65535, 0}));
    EXPECT_EQ(frame.head.scale.ranges[1], (std::array<float, 2>{0.0F, 5.0F}));  // the speed
    EXPECT_EQ(frame.particles.scalar[0], (std::vector<std::uint8_t>{0, 255}));
  }
  // A damaged file is no frame, and no harm.
  const fs::path file = folder.path() / "fields" / "fields_00001.vtp";
  const std::string bytes = text_of(file);
  for (std::size_t k = 0; k < bytes.size(); k += 7) {
    std::string wrong = bytes;
    wrong[k] = static_cast<char>(wrong[k] ^ 0x41);
    write_text_file(file, wrong.substr(0, k % 2 == 0 ? wrong.size() : k));
    FrameIndex index{FolderReader(folder.path())};
    index.look();
    index.bytes_of(1);
  }
}

TEST(FrameIndex, AFieldFileThatLacksArraysIsNoFrame) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "fields");
  const Water water;
  PvdSeries(folder.path() / "fields", "fields", 0)
      .write<2>(0.0, {.position = water.position, .fields = {{"id", std::span<const std::int64_t>(water.id)}}});
  const std::string bytes = text_of(folder.path() / "fields" / "fields_00000.vtp");
  const std::size_t begin = bytes.find("<Piece ");
  const std::size_t end = bytes.find("</Piece>") + std::string_view("</Piece>").size();
  const std::string piece = bytes.substr(begin, end - begin);
  const auto with_second = [&](const std::string& second) {
    return frame_of_fields(bytes.substr(0, end) + second + bytes.substr(end), "name", 0, 2);
  };
  EXPECT_EQ(decode_frame(with_second(piece), {}).particles.size(), 4U);
  for (std::size_t at = piece.find("<DataArray "); at < piece.find("</Points>");
       at = piece.find("<DataArray ", at + 1)) {
    std::string second = piece;
    second.replace(at, 5, "<Date");
    EXPECT_THROW(with_second(second), IoError);
  }
}

TEST(FrameIndex, AnIdIsAWholeNumber) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "fields");
  const Water water;
  const std::vector<double> id(water.position.size(), std::nan(""));
  PvdSeries(folder.path() / "fields", "fields", 0)
      .write<2>(0.0, {.position = water.position, .fields = {{"id", std::span<const double>(id)}}});
  const std::string bytes = text_of(folder.path() / "fields" / "fields_00000.vtp");
  EXPECT_THROW(frame_of_fields(bytes, "name", 0, 2), IoError);
  std::string none = bytes;
  const std::size_t at = none.find("NumberOfComponents=", none.find("Name=\"id\""));
  none.replace(at, 22, "NumberOfComponents=\"0\"");
  EXPECT_THROW(frame_of_fields(none, "name", 0, 2), IoError);
}

TEST(FolderReader, OpensNothingOutsideAndFollowsNoLink) {
  const TemporaryFolder outer;
  const fs::path run = outer.path() / "run";
  fs::create_directories(run / "probes");
  write_text_file(outer.path() / "secret.csv", "secret");
  write_text_file(run / "steps.csv", "steps");
  write_text_file(run / "probes" / "a.csv", "a");
  fs::create_symlink(outer.path() / "secret.csv", run / "probes" / "link.csv");
  fs::create_directory_symlink(outer.path(), run / "out");
  const FolderReader folder(run);
  EXPECT_EQ(folder.text_of({"steps.csv"}), "steps");
  EXPECT_EQ(folder.text_of({"probes", "a.csv"}), "a");
  const std::vector<std::vector<std::string>> refused{{},
                                                      {""},
                                                      {".."},
                                                      {"..", "secret.csv"},
                                                      {"probes", "..", "..", "secret.csv"},
                                                      {"probes", "link.csv"},
                                                      {"out", "secret.csv"},
                                                      {"probes"},
                                                      {"probes/a.csv"},
                                                      {"/etc/passwd"},
                                                      {std::string("steps.csv\0", 10)}};
  for (const std::vector<std::string>& names : refused) EXPECT_FALSE(folder.open(names)) << names.size();
  EXPECT_TRUE(names_of_readable_file("../secret.csv").empty());
  EXPECT_TRUE(names_of_readable_file("checkpoints/step_1.h5").empty());
  EXPECT_FALSE(folder.open(names_of_readable_file("probes/../../secret.csv")));
  fs::remove_all(run);
  EXPECT_FALSE(folder.exists());
  EXPECT_FALSE(folder.touch("STOP"));
}

}  // namespace
}  // namespace tailwater
