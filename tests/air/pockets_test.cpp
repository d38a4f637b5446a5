// What becomes of pockets and their gas as voids change, on voids drawn by hand: slots of cells in water.
#include "air/pockets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "air/air_watch.h"
#include "base/error.h"

namespace tailwater {
namespace pockets_test {

constexpr double dx = 0.1;

/// Slots 0.8 high: [from, to] in x.
struct Slot {
  double from, to;
};

class Basin {
 public:
  Basin() : grid_({Vec<2>::Zero(), Vec<2>(3.0, 1.0)}, dx, {}) {}

  /// Looks at these slots, of which `open` ones reach the open air, after water has gone `displacement` dx.
  void look(const std::vector<Slot>& closed, const std::vector<Slot>& open = {}, double displacement = 0.5) {
    CellMarks water(grid_.rows(), grid_.length());
    const auto is_in = [](const std::vector<Slot>& slots, const Vec<2>& x) {
      return std::ranges::any_of(slots, [&](const Slot& slot) { return x[0] > slot.from && x[0] < slot.to; });
    };
    for (int row = 0; row < grid_.rows(); ++row) {
      for (int place = 0; place < grid_.length(); ++place) {
        const Vec<2> x = grid_.centre(grid_.cell(row, place));
        const bool is_void = (x[1] > 0.1 && x[1] < 0.9 && is_in(closed, x)) || (x[1] > 0.1 && is_in(open, x));
        if (!is_void) water.mark(row, place, place + 1);
      }
    }
    state.displacement = displacement * dx;
    const Voids<2> voids(grid_, water, CellMarks(grid_.rows(), grid_.length()));
    const std::vector<FoundPocket> found = follow_pockets<2>(grid_, dx, voids, law, state);
    std::vector<double> volumes;
    for (const FoundPocket& pocket : found) {
      double cells = 0.0;
      for (const CellRun& run : pocket.pocket.cells) cells += run.cells();
      volumes.push_back(cells * grid_.cell_volume());
    }
    take_over(found, volumes, dx, law, state);
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
};

/// Of a slot of that width.
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
  basin.look({{0.5, 0.55}});  // 1 x 16 cells; a pocket begins with 4 x 4 = 16, so take one of half the height
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
  EXPECT_EQ(basin.state.pockets[0].number, 1);  // that of the larger one
  EXPECT_NEAR(basin.gas(), gas, 1e-12);
  EXPECT_LT(basin.law.energy(basin.state.pockets[0].gas, basin.state.pockets[0].volume), energy);
  const double pressure = basin.law.pressure(basin.state.pockets[0].gas, basin.state.pockets[0].volume);
  basin.look({{0.5, 1.0}, {1.1, 1.8}});
  ASSERT_EQ(basin.state.pockets.size(), 2u);
  EXPECT_NE(basin.state.pockets[0].number, basin.state.pockets[1].number);
  // The cells of the wall between them are water now: they take a part of the gas and of the volume along.
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
  EXPECT_NO_THROW(AirWatch<2>(spec, {Vec<2>::Zero(), Vec<2>::Ones()}, {}));
  for (const double length : {1e5, 1e15, 1e100}) {
    const Eigen::AlignedBox<double, 2> box(Vec<2>::Zero(), Vec<2>::Constant(length));
    EXPECT_THROW(AirWatch<2>(spec, box, {}), InputError) << length;
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

// Water that has gone 50 dx takes 1 - 1/e of the difference out.
TEST(Pockets, ComeBackToTheVolumeOfTheirCells) {
  Basin basin;
  basin.look({{0.5, 1.0}});
  basin.state.pockets[0].volume *= 1.1;
  for (int n = 0; n < 100; ++n) basin.look({{0.5, 1.0}});
  EXPECT_NEAR(basin.state.pockets[0].volume, volume_of(0.5) * (1.0 + 0.1 * std::exp(-1.0)), 1e-9);
}

}  // namespace pockets_test
}  // namespace tailwater
