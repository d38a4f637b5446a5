#include "probes/pressure_map.h"

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "io/temporary_folder.h"
#include "probes/tank.h"
#include "support/dimensions.h"

namespace tailwater {
namespace {

ProbeTable map_probe() {
  ProbeTable probe;
  probe.name = "map";
  probe.type = ProbeType::pressure_map;
  return probe;
}

template <class Dimension>
class PressureMapTest : public testing::Test {};
TYPED_TEST_SUITE(PressureMapTest, Dimensions);

/// On the left wall the pressure falls from the bed to the surface. Patches have edges of 0.75 to 1.5 dx, so the lowest
/// centre is 0.25 dx to 0.75 dx above the bed; in 2D the map's edges are halves of the wall's height 30 dx again and
/// again, 0.9375 dx.
TYPED_TEST(PressureMapTest, OfStillWaterIsHydrostatic) {
  constexpr int Dim = TypeParam::value;
  using T = Tank<Dim>;
  const double level = 0.8;
  T tank = T::filled(level);
  ProbeTable probe = map_probe();
  probe.region_min.assign(Dim, 0.0);
  probe.region_max.assign(Dim, 2.0);
  probe.region_max[0] = 0.0;
  const Reading<Dim> reading = pressure_map_reading<Dim>(probe, tank.spec, tank.boundary);
  const Row first = reading.take(tank.context(0.0)).at(0);
  const auto place = Vec<Dim>::Map(first.data() + 1);
  EXPECT_NEAR(place[0], 0.0, 1e-12);
  EXPECT_NEAR(first[0], T::rho * T::g * (level - place[Dim - 1]), 1e-9 * T::rho * T::g);
  EXPECT_LE(place[Dim - 1], 0.75 * T::dx);
  // Dry above the surface: 0.7 m of 1.5 m; the border lies on a patch of 1.5 dx at most.
  EXPECT_NEAR(first[2 + Dim], level / T::height, 1.5 * T::dx / T::height);
  // The mean over the height of the wall; patches are read at their centres, which is exact but for the border.
  const double mean = 0.5 * T::rho * T::g * level * level / T::height;
  EXPECT_NEAR(first[1 + Dim], mean, T::rho * T::g * std::pow(1.5 * T::dx, 2) / T::height);

  // Twice the pressure for a second: the largest is that, the mean as well (time before it has no duration).
  for (double& p : tank.particles.pressure) p *= 2.0;
  reading.take(tank.context(1.0));
  const std::vector<double> totals = reading.totals();
  ASSERT_EQ(totals.size(), totals_of(ProbeType::pressure_map, Dim).size());
  EXPECT_GT(totals[0], 1.5 * first[0]);
  EXPECT_EQ(totals[1], 1.0);
  EXPECT_GT(totals.back(), 1.5 * mean);

  const TemporaryFolder folder;
  reading.write_map(folder.path() / "map.vtp", 1.0);
  EXPECT_GT(std::filesystem::file_size(folder.path() / "map.vtp"), 1000u);

  // A restart has the same memory.
  const Reading<Dim> again = pressure_map_reading<Dim>(probe, tank.spec, tank.boundary);
  ASSERT_EQ(again.memory->size(), reading.memory->size());
  *again.memory = *reading.memory;
  EXPECT_EQ(again.totals(), totals);
}

/// The pressure of still water for two stretches, with a spike of a hundredth of a stretch.
TEST(PressureMap, LargestPressuresAreMeansOverTheTimeGiven) {
  Tank<2> tank = Tank<2>::filled(0.8);
  ProbeTable probe = map_probe();
  probe.averaging_time = 1.0;
  const Reading<2> reading = pressure_map_reading<2>(probe, tank.spec, tank.boundary);
  const double still = reading.take(tank.context(0.0)).at(0)[0];
  reading.take(tank.context(1.0));
  for (double& p : tank.particles.pressure) p *= 30.0;
  const double spike = reading.take(tank.context(1.01)).at(0)[0];
  EXPECT_GT(spike, 25.0 * still);
  for (double& p : tank.particles.pressure) p /= 30.0;
  reading.take(tank.context(1.5));
  reading.take(tank.context(2.0));
  EXPECT_NEAR(reading.totals()[0], 0.99 * still + 0.01 * spike, 1e-6 * still);
}

/// Above the water of the right wall, 0.7 m of 1.5 m, there is air below the pressure of the atmosphere. Where all is
/// dry, the highest pressure is below 0.
TYPED_TEST(PressureMapTest, OfDryPatchesIsThatOfTheAir) {
  constexpr int Dim = TypeParam::value;
  using T = Tank<Dim>;
  ProbeTable probe = map_probe();
  probe.region_min.assign(Dim, 0.0);
  probe.region_max.assign(Dim, 2.0);
  probe.region_min[0] = T::width;
  const auto read = [&](double level) {
    const T tank = T::filled(level);
    ProbeContext<Dim> context = tank.context(0.0);
    context.air_pressure = [](const Vec<Dim>&) { return -50.0; };
    return pressure_map_reading<Dim>(probe, tank.spec, tank.boundary).take(context).at(0);
  };
  const Row dry = read(0.0);
  EXPECT_EQ(dry[0], -50.0);
  EXPECT_NEAR(dry[1 + Dim], -50.0, 1e-10);
  const Row half = read(0.8);
  const double of_water = 0.5 * T::rho * T::g * 0.8 * 0.8;
  EXPECT_NEAR(half[1 + Dim], (of_water - 50.0 * 0.7) / T::height, T::rho * T::g * std::pow(1.5 * T::dx, 2) / T::height);
}

TEST(ChosenWalls, ForAWallOrARegionThatDoesNotExistAreRefused) {
  const Tank<2> tank = Tank<2>::filled(0.5);
  const auto message_for = [&](const ProbeTable& probe) -> std::string {
    try {
      pressure_map_reading<2>(probe, tank.spec, tank.boundary);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  ProbeTable unknown = map_probe();
  unknown.walls = {"tnk"};
  Tank<2> named = tank;
  named.boundary.walls[0].name = "tank";
  try {
    pressure_map_reading<2>(unknown, named.spec, named.boundary);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"tank\"?"), std::string::npos) << error.what();
  }
  ProbeTable beside = map_probe();
  beside.region_min = {0.2, 0.2};
  beside.region_max = {0.8, 0.8};
  const std::string message = message_for(beside);
  for (const char* part : {"probe 'map'", "(0, 0) to (1, 1.5)", "region_min"}) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
  EXPECT_EQ(message_for(map_probe()), "");
}

}  // namespace
}  // namespace tailwater
