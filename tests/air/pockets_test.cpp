// Changes of pockets and their gas as voids change. The voids are drawn by hand: slots of cells in water.
#include "air/pockets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "air/air_watch.h"
#include "base/box.h"
#include "base/error.h"

namespace tailwater {
namespace pockets_test {

constexpr double dx = 0.1;

/// A slot 0.8 high: [from, to] in x.
struct Slot {
  double from, to;
};

class Basin {
 public:
  Basin() : grid_({Vec<2>::Zero(), Vec<2>(3.0, 1.0)}, dx, {}), walls_(grid_.rows(), grid_.length()) {}

  /// Closes the basin on all sides, 0.05 inside its border.
  void seal(double left = 0.05) {
    for (int row = 0; row < grid_.rows(); ++row) {
      for (int place = 0; place < grid_.length(); ++place) {
        const Vec<2> x = grid_.centre(grid_.cell(row, place));
        const bool is_inside = x[0] > left && x[0] < 2.95 && x[1] > 0.05 && x[1] < 0.95;
        if (!is_inside) walls_.mark(row, place, place + 1);
      }
    }
  }

  void open() { walls_.clear(); }

  /// Updates the pockets for these slots after a displacement of the water by `displacement` dx. The slots `open`
  /// connect to the open air.
  void look(const std::vector<Slot>& closed, const std::vector<Slot>& open = {}, double displacement = 0.5) {
    CellMarks water(grid_.rows(), grid_.length());
    const auto is_in = [](const std::vector<Slot>& slots, const Vec<2>& x) {
      return std::ranges::any_of(slots, [&](const Slot& slot) { return x[0] > slot.from && x[0] < slot.to; });
    };
    for (int row = 0; row < grid_.rows(); ++row) {
      for (int place = 0; place < grid_.length(); ++place) {
        const Vec<2> x = grid_.centre(grid_.cell(row, place));
        const bool is_void = (x[1] > 0.1 && x[1] < 0.9 && is_in(closed, x)) || (x[1] > 0.1 && is_in(open, x));
        if (!is_void && !walls_(row, place)) water.mark(row, place, place + 1);
      }
    }
    state.displacement = displacement * dx;
    const Voids<2> voids(grid_, water, walls_);
    SealedSpaces<2> spaces(grid_, walls_);
    spaces.find_ways_out(voids);
    const std::int64_t begun_before = state.begun;
    const double pace = correction_of_volume(state.displacement, dx);
    std::vector<FoundPocket> found = follow_pockets<2>(grid_, dx, voids, spaces, law, state);
    std::vector<double> volumes;
    for (const FoundPocket& pocket : found) {
      double cells = 0.0;
      for (const CellRun& run : pocket.pocket.cells) cells += run.cells();
      volumes.push_back(cells * grid_.cell_volume());
    }
    exchange_gas<2>(grid_, spaces, volumes, begun_before, pace, law, found, state);
    take_over(found, volumes, pace, law, state);
  }

  double gas() const {
    double sum = 0.0;
    for (const AirPocket& pocket : state.pockets) sum += pocket.gas;
    return sum;
  }

  AirState state;
  GasLaw law;

 private:
  VoidGrid<2> grid_;
  CellMarks walls_;
};

/// Volume of a slot of a given width.
double volume_of(double width) { return 0.8 * width; }

TEST(Pockets, AirThatIsShutInHasTheAtmospheresPressure) {
  Basin basin;
  basin.look({{0.5, 1.0}});
  ASSERT_EQ(basin.state.pockets.size(), 1u);
  EXPECT_NEAR(basin.state.pockets[0].volume, volume_of(0.5), 1e-12);
  EXPECT_NEAR(basin.state.pockets[0].gas, volume_of(0.5), 1e-12);
  EXPECT_NEAR(basin.state.gas_found, volume_of(0.5), 1e-12);
}

TEST(Pockets, SmallOnesAreNone) {
  Basin basin;
  basin.look({{0.5, 0.55}});  // 1 x 16 cells; the smallest pocket has 4 x 4 = 16
  EXPECT_LE(basin.state.pockets.size(), 1u);
  Basin other;
  other.look({});
  EXPECT_TRUE(other.state.pockets.empty());
}

TEST(Pockets, KeepTheirNumberAsTheyMove) {
  Basin basin;
  for (int n = 0; n < 10; ++n) basin.look({{0.5 + 0.05 * n, 1.0 + 0.05 * n}});
  ASSERT_EQ(basin.state.pockets.size(), 1u);
  EXPECT_EQ(basin.state.pockets[0].number, 0);
  EXPECT_NEAR(basin.gas(), volume_of(0.5), 1e-12);
}

TEST(Pockets, KeepTheirGasWhereTheyJoinAndPart) {
  Basin basin;
  basin.look({{0.5, 1.0}, {1.1, 1.8}});
  ASSERT_EQ(basin.state.pockets.size(), 2u);
  basin.state.pockets[0].gas *= 1.5;
  const double gas = basin.gas();
  const double energy = basin.law.energy(basin.state.pockets[0].gas, basin.state.pockets[0].volume);
  basin.look({{0.5, 1.8}});
  ASSERT_EQ(basin.state.pockets.size(), 1u);
  EXPECT_EQ(basin.state.pockets[0].number, 1);  // the number of the larger pocket
  EXPECT_NEAR(basin.gas(), gas, 1e-12);
  EXPECT_LT(basin.law.energy(basin.state.pockets[0].gas, basin.state.pockets[0].volume), energy);
  const double pressure = basin.law.pressure(basin.state.pockets[0].gas, basin.state.pockets[0].volume);
  basin.look({{0.5, 1.0}, {1.1, 1.8}});
  ASSERT_EQ(basin.state.pockets.size(), 2u);
  EXPECT_NE(basin.state.pockets[0].number, basin.state.pockets[1].number);
  // The cells between the slots are water now and take part of the gas and of the volume with them.
  for (const AirPocket& pocket : basin.state.pockets) {
    EXPECT_NEAR(basin.law.pressure(pocket.gas, pocket.volume), pressure, 0.05 * std::abs(pressure));
  }
  EXPECT_NEAR(basin.gas(), gas, 1e-12);
}

TEST(Pockets, KeepTheirGasWhileAFilmTearsForAMoment) {
  Basin basin;
  basin.look({{0.5, 1.0}});
  basin.look({}, {{0.5, 1.0}});
  ASSERT_EQ(basin.state.pockets.size(), 1u);
  EXPECT_GT(basin.state.pockets[0].torn, 0.0);
  basin.look({{0.5, 1.0}});
  ASSERT_EQ(basin.state.pockets.size(), 1u);
  EXPECT_EQ(basin.state.pockets[0].torn, 0.0);
  EXPECT_EQ(basin.state.pockets[0].number, 0);
  EXPECT_EQ(basin.state.begun, 1);
  EXPECT_NEAR(basin.gas(), volume_of(0.5), 1e-9);
  EXPECT_EQ(basin.state.gas_lost, 0.0);
}

TEST(Pockets, LoseTheirGasWhenTheyHaveBeenOpenForAWhile) {
  Basin basin;
  basin.look({{0.5, 1.0}});
  basin.state.pockets[0].gas *= 1.1;
  const double gas = basin.gas();
  const double energy = basin.law.energy(gas, basin.state.pockets[0].volume);
  for (int n = 0; n < 6; ++n) basin.look({}, {{0.5, 1.0}});
  EXPECT_TRUE(basin.state.pockets.empty());
  EXPECT_NEAR(basin.state.gas_lost, gas, 1e-12);
  EXPECT_NEAR(basin.state.energy_lost, energy, 1e-9 * energy);
  EXPECT_EQ(basin.state.ended, 1);
}

TEST(Pockets, CellsThatThereAreNotAreGone) {
  Basin basin;
  basin.look({{0.5, 1.0}});
  const double gas = basin.gas();
  for (CellRun& run : basin.state.pockets[0].cells) run.row = run.row % 2 == 0 ? 100'000'000 : -1;
  basin.look({});
  EXPECT_TRUE(basin.state.pockets.empty());
  EXPECT_EQ(basin.state.gas_lost, gas);
}

TEST(Pockets, MoreSpaceThanMemoryIsRefused) {
  CaseSpec spec;
  spec.particles.spacing = dx;
  spec.air.pockets = AirPockets::adiabatic;
  EXPECT_NO_THROW(AirWatch<2>(spec, {}, {Vec<2>::Zero(), Vec<2>::Ones()}, {}));
  for (const double length : {1e5, 1e15, 1e100}) {
    const Box<2> box(Vec<2>::Zero(), Vec<2>::Constant(length));
    EXPECT_THROW(AirWatch<2>(spec, {}, box, {}), InputError) << length;
  }
}

TEST(Pockets, TakeInAirThatIsShutInBesideThem) {
  Basin basin;
  basin.look({{0.5, 1.0}}, {{1.5, 2.8}});
  basin.look({{0.5, 2.8}});
  ASSERT_EQ(basin.state.pockets.size(), 1u);
  EXPECT_NEAR(basin.gas(), volume_of(2.3), 1e-9);
  EXPECT_EQ(basin.state.pockets[0].number, 0);
}

// The difference decays by 1 - 1/e while the water moves by 50 dx.
TEST(Pockets, ComeBackToTheVolumeOfTheirCells) {
  Basin basin;
  basin.look({{0.5, 1.0}});
  basin.state.pockets[0].volume *= 1.1;
  for (int n = 0; n < 100; ++n) basin.look({{0.5, 1.0}});
  EXPECT_NEAR(basin.state.pockets[0].volume, volume_of(0.5) * (1.0 + 0.1 * std::exp(-1.0)), 1e-9);
}

/// Volume of all pockets, including gas without a pocket.
double volume_in(const AirState& state) {
  double sum = 0.0;
  for (const AirPocket& pocket : state.pockets) sum += pocket.volume;
  for (const AirPocket& pocket : state.hidden) sum += pocket.volume;
  return sum;
}

TEST(SealedBasin, GivesTheGasOfAPocketThatEndsToTheNearestOne) {
  Basin basin;
  basin.seal();
  basin.look({{0.2, 1.2}, {1.5, 1.6}, {1.8, 2.2}});
  ASSERT_EQ(basin.state.pockets.size(), 3U);
  const double gas = basin.gas();
  const double middle = basin.state.pockets[1].gas;
  const double right = basin.state.pockets[2].gas;
  basin.look({{0.2, 1.2}, {1.8, 2.2}});
  ASSERT_EQ(basin.state.pockets.size(), 2U);
  EXPECT_NEAR(basin.gas(), gas, 1e-12);
  EXPECT_NEAR(basin.state.pockets[1].gas, right + middle, 0.1 * middle);  // 0.2 away, not 0.3
  EXPECT_EQ(basin.state.gas_lost, 0.0);
  EXPECT_NEAR(basin.state.gas_handed_on, middle, 1e-12);
  EXPECT_EQ(basin.state.ended, 1);
}

TEST(SealedBasin, KeepsGasThatHasNoPocketUntilThereIsOneAgain) {
  Basin basin;
  basin.seal();
  basin.look({{0.5, 1.0}});
  const double gas = basin.gas();
  basin.look({});
  EXPECT_TRUE(basin.state.pockets.empty());
  ASSERT_EQ(basin.state.hidden.size(), 1U);
  basin.look({});
  basin.look({{2.0, 2.2}});
  ASSERT_EQ(basin.state.pockets.size(), 1U);
  EXPECT_TRUE(basin.state.hidden.empty());
  EXPECT_NEAR(basin.gas(), gas, 1e-12);
  EXPECT_NEAR(basin.state.gas_found, gas, 1e-12);
}

TEST(SealedBasin, KeepsTheGasOfAPocketThatAWallMovesOver) {
  Basin basin;
  basin.seal();
  basin.look({{0.0, 0.1}, {1.0, 2.0}});
  ASSERT_EQ(basin.state.pockets.size(), 2U);
  const double gas = basin.gas();
  basin.seal(0.1);
  basin.look({{0.0, 0.1}, {1.0, 2.0}});
  ASSERT_EQ(basin.state.pockets.size(), 1U);
  EXPECT_NEAR(basin.gas(), gas, 1e-12);
  EXPECT_EQ(basin.state.gas_lost, 0.0);
}

TEST(SealedBasin, FillsAPocketThatBeginsFromItsNeighbour) {
  Basin basin;
  basin.seal();
  basin.look({{0.2, 1.2}});
  basin.state.pockets[0].gas *= 1.5;
  const double gas = basin.gas();
  const double volume = volume_in(basin.state);
  const double pressure = basin.law.pressure(basin.state.pockets[0].gas, basin.state.pockets[0].volume);
  basin.look({{0.2, 1.2}, {1.4, 1.6}});
  ASSERT_EQ(basin.state.pockets.size(), 2U);
  EXPECT_NEAR(basin.gas(), gas, 1e-12);
  EXPECT_NEAR(volume_in(basin.state), volume, 1e-12);
  EXPECT_NEAR(basin.state.pockets[1].volume, volume_of(0.2), 1e-12);
  for (const AirPocket& pocket : basin.state.pockets) {
    EXPECT_NEAR(basin.law.pressure(pocket.gas, pocket.volume), pressure, 1e-6);
  }
}

TEST(SealedBasin, NeverGainsEnergyByExchange) {
  Basin basin;
  basin.seal();
  basin.look({{0.2, 1.2}, {1.6, 2.6}});
  basin.state.pockets[0].gas *= 1.3;
  basin.state.pockets[1].gas *= 0.8;
  const double gas = basin.gas();
  const double volume = volume_in(basin.state);
  const auto energy = [&] {
    double sum = 0.0;
    for (const AirPocket& pocket : basin.state.pockets) sum += basin.law.energy(pocket.gas, pocket.volume);
    return sum;
  };
  const double first = energy();
  for (int n = 0; n < 30; ++n) {
    const double before = energy();
    const double shift = 0.05 * (n % 7);
    basin.look({{0.2, 1.2 - shift}, {1.3, 1.5}, {1.6 + shift, 2.6}});
    EXPECT_LE(energy(), before * (1.0 + 1e-12)) << n;
  }
  EXPECT_NEAR(energy() + basin.state.energy_lost, first, 1e-9 * first);
  EXPECT_NEAR(basin.gas(), gas, 1e-12);
  EXPECT_NEAR(volume_in(basin.state), volume, 1e-12);
}

TEST(SealedBasin, ThatIsOpenedLosesItsGasAsAnyOther) {
  Basin basin;
  basin.seal();
  basin.look({{0.5, 1.0}});
  const double gas = basin.gas();
  basin.open();
  for (int n = 0; n < 6; ++n) basin.look({}, {{0.5, 1.0}});
  EXPECT_TRUE(basin.state.pockets.empty());
  EXPECT_TRUE(basin.state.hidden.empty());
  EXPECT_NEAR(basin.state.gas_lost, gas, 1e-12);
}

}  // namespace pockets_test
}  // namespace tailwater
