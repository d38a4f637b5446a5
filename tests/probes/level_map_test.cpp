#include "probes/level_map.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "base/error.h"
#include "io/temporary_folder.h"
#include "probes/tank.h"
#include "support/dimensions.h"

namespace tailwater {
namespace {

template <class Dimension>
class LevelMapTest : public testing::Test {
 public:
  static constexpr int dimension = Dimension::value;
  using TankOf = Tank<dimension>;
  /// A depth on a flat surface is right to 0.05 dx (water_column_test.cpp).
  static constexpr double bound = 0.05 * TankOf::dx;

  static ProbeTable over_the_tank() {
    ProbeTable probe =
        probe_along(ProbeType::level_map, Coordinates(dimension, 0.0), Coordinates(dimension, TankOf::width));
    probe.step = 0.26;  // makes four pieces of 0.25 m
    return probe;
  }
};
TYPED_TEST_SUITE(LevelMapTest, Dimensions);

TYPED_TEST(LevelMapTest, KeepsTheLargestTheMeanAndTheLastLevel) {
  constexpr int Dim = TestFixture::dimension;
  using T = typename TestFixture::TankOf;
  const T first = T::filled(0.6);
  const Reading<Dim> reading = level_map_reading<Dim>(TestFixture::over_the_tank(), first.spec, first.boundary);
  ASSERT_EQ(reading.columns.size(), 2u);
  EXPECT_EQ(reading.columns[0].heading, "highest_m");
  reading.take(first.context(0.0));
  const Row high = reading.take(T::filled(0.8).context(1.0)).at(0);
  EXPECT_NEAR(high[0], 0.8, TestFixture::bound);
  EXPECT_NEAR(high[1], 0.8, TestFixture::bound);
  reading.take(T::filled(0.4).context(3.0));

  const std::vector<double> totals = reading.totals();
  ASSERT_EQ(totals.size(), totals_of(ProbeType::level_map, Dim).size());
  EXPECT_NEAR(totals[0], 0.8, TestFixture::bound);
  EXPECT_EQ(totals[1], 1.0);
  EXPECT_NEAR(totals[2], 0.125, 1e-12);  // x of the first of equally high places
  EXPECT_NEAR(totals[Dim + 1], (0.8 * 1.0 + 0.4 * 2.0) / 3.0, TestFixture::bound);
  EXPECT_NEAR(totals[Dim + 2], 0.4, TestFixture::bound);

  // A restart has the same memory.
  const Reading<Dim> again = level_map_reading<Dim>(TestFixture::over_the_tank(), first.spec, first.boundary);
  ASSERT_EQ(again.memory->size(), reading.memory->size());
  *again.memory = *reading.memory;
  EXPECT_EQ(again.totals(), totals);

  const TemporaryFolder folder;
  reading.write_map(folder.path() / "map.vtp", 3.0);
  if (Dim == 3) {
    EXPECT_GT(std::filesystem::file_size(folder.path() / "map.vtp"), 1000u);
    return;
  }
  std::ifstream csv(folder.path() / "map.map.csv");
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "x_m,bed_m,largest_m,time_of_largest_s,mean_m,last_m");
  int rows = 0;
  while (std::getline(csv, line)) ++rows;
  EXPECT_EQ(rows, 4);
}

TYPED_TEST(LevelMapTest, OfADryTankIsItsBed) {
  constexpr int Dim = TestFixture::dimension;
  using T = typename TestFixture::TankOf;
  const T dry = T::filled(0.0);
  const Reading<Dim> reading = level_map_reading<Dim>(TestFixture::over_the_tank(), dry.spec, dry.boundary);
  EXPECT_EQ(reading.take(dry.context()).at(0), (Row{0.0, 0.0}));
}

TYPED_TEST(LevelMapTest, NeedsAnExtentAndPlacesThatParticlesCanTell) {
  constexpr int Dim = TestFixture::dimension;
  using T = typename TestFixture::TankOf;
  const T tank = T::filled(0.4);
  const auto message = [&](const ProbeTable& probe) -> std::string {
    try {
      level_map_reading<Dim>(probe, tank.spec, tank.boundary);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  ProbeTable upright = TestFixture::over_the_tank();
  upright.to[Dim - 2] = 0.0;
  EXPECT_NE(message(upright).find(Dim == 2 ? "the same x" : "the same y"), std::string::npos) << message(upright);
  ProbeTable fine = TestFixture::over_the_tank();
  fine.step = 1e-4;
  EXPECT_NE(message(fine).find("0.1 dx"), std::string::npos) << message(fine);
  ProbeTable large = TestFixture::over_the_tank();
  large.to[0] = 1e12;
  EXPECT_NE(message(large).find("larger step"), std::string::npos) << message(large);
}

}  // namespace
}  // namespace tailwater
