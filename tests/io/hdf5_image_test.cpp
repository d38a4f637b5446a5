#include "io/hdf5_image.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "base/error.h"

namespace tailwater {
namespace {

TEST(Hdf5Image, GivesBackEveryBit) {
  const std::vector<double> numbers{0.1, -0.0, std::numeric_limits<double>::denorm_min(), 1e308, 3.0, 4.0};
  const std::vector<std::int64_t> wide{std::numeric_limits<std::int64_t>::min(), 7};
  const std::vector<std::int32_t> narrow{-1, 2};
  const std::vector<std::uint8_t> bytes{0, 255};
  Hdf5Writer writer;
  writer.put("numbers", std::span(numbers), 2);
  writer.put("wide", std::span(wide));
  writer.put("narrow", std::span(narrow));
  writer.put("bytes", std::span(bytes));
  writer.put("text", "a text\n");
  writer.put("nothing", std::span<const double>());
  const Hdf5Reader reader(writer.image());
  EXPECT_EQ(reader.get<double>("numbers"), numbers);
  EXPECT_TRUE(std::signbit(reader.get<double>("numbers")[1]));
  EXPECT_EQ(reader.get<std::int64_t>("wide"), wide);
  EXPECT_EQ(reader.get<std::int32_t>("narrow"), narrow);
  EXPECT_EQ(reader.get<std::uint8_t>("bytes"), bytes);
  EXPECT_EQ(reader.text("text"), "a text\n");
  EXPECT_TRUE(reader.get<double>("nothing").empty());
}

TEST(Hdf5Image, IsTheFileWhateverRoomItHad) {
  std::vector<double> numbers(3000);
  std::iota(numbers.begin(), numbers.end(), 0.0);
  std::vector<std::string> images;
  for (const std::size_t room : {std::size_t{1000}, std::size_t{1} << 20}) {
    Hdf5Writer writer(room);
    writer.put("numbers", std::span<const double>(numbers));
    writer.put("text", "a text\n");
    images.emplace_back(writer.image());
  }
  EXPECT_EQ(images[0], images[1]);
  EXPECT_LT(images[0].size(), 8 * numbers.size() + 8192);
  const std::string consistency_flags = images[0].substr(20, 4);  // of the head of an HDF5 file
  EXPECT_EQ(consistency_flags, std::string(4, '\0'));
}

TEST(Hdf5Image, RefusesWhatIsNotThere) {
  Hdf5Writer writer;
  writer.put("numbers", std::span<const double>());
  const Hdf5Reader reader(writer.image());
  EXPECT_THROW(reader.get<double>("others"), IoError);
  EXPECT_THROW(reader.get<std::int64_t>("numbers"), IoError);
  EXPECT_THROW(Hdf5Reader("not an HDF5 file"), IoError);
}

}  // namespace
}  // namespace tailwater
