// Probes have the same readings for any distribution of the particles. Sums over particles have another order, so that
// readings differ by rounding: some hundred terms of one sign are exact to 1e-13, and no reading magnifies this by ten.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "io/shared_folder.h"
#include "probes/probe_set.h"
#include "probes/tank.h"
#include "support/dimensions.h"
#include "walls/patches.h"

namespace tailwater {
namespace {

/// Returns the rank of particle `i` at `x`.
template <int Dim>
using Deal = std::function<int(std::size_t i, const Vec<Dim>& x)>;

/// Sloping water that moves, and a single particle beyond its front and above it.
template <int Dim>
Tank<Dim> sloping_tank() {
  Tank<Dim> tank(0.6, [](const Vec<Dim>& x) { return x[0] < 0.8 && x[Dim - 1] < 0.6 - 0.3 * x[0]; });
  Vec<Dim> drop = Vec<Dim>::Constant(0.52);
  drop[0] = 0.93;
  drop[Dim - 1] = 1.1;
  tank.add(drop, true, 3.0);
  for (std::size_t i = 0; i < tank.particles.size(); ++i) {
    const Vec<Dim>& x = tank.particles.position[i];
    for (int d = 0; d < Dim; ++d) tank.particles.velocity[i][d] = std::sin(3.0 * x[0] + 2.0 * x[Dim - 1] + d);
  }
  tank.locate();
  return tank;
}

/// A probe on the part of the walls left of x = 0.63.
template <int Dim>
ProbeTable on_walls(ProbeType type, const Coordinates& moment_about) {
  ProbeTable probe = probe_at(type, {});
  probe.region_min.assign(Dim, -1.0);
  probe.region_max.assign(Dim, 2.0);
  probe.region_max[0] = 0.63;
  probe.moment_about = moment_about;
  return probe;
}

/// Arbitrary forces through every owned particle.
template <int Dim>
WallForces<Dim> made_forces(const Particles<Dim>& particles) {
  WallForces<Dim> forces;
  forces.reset(particles.owned);
  for (std::size_t i = 0; i < particles.owned; ++i) {
    const Vec<Dim>& x = particles.position[i];
    if (particles.is_fluid(i)) {
      forces.through_water[i] = Vec<Dim>::Constant(std::cos(4.0 * x[0] + 2.0 * x[Dim - 1]));
      continue;
    }
    forces.pressure[i] = Vec<Dim>::Constant(std::sin(7.0 * x[0] + 3.0 * x[Dim - 1]));
    forces.friction[i][0] = std::cos(5.0 * x[0] - x[Dim - 1]);
  }
  return forces;
}

template <int Dim>
std::vector<ProbeTable> all_probes() {
  using Tank = Tank<Dim>;
  std::vector<ProbeTable> probes{
      probe_at(ProbeType::depth, Tank::at(0.33, 0.1)),
      probe_at(ProbeType::depth, Tank::at(0.95, 0.1)),  // dry, below the drop
      probe_along(ProbeType::profile, Tank::at(0.1, 0.1), Tank::at(0.9, 0.1)),
      probe_at(ProbeType::wall_pressure, Tank::at(0.0, 0.2)),
      probe_at(ProbeType::wall_pressure, Tank::at(0.0, 1.2)),
      // Nearest to the left wall, then to the floor.
      probe_along(ProbeType::wall_pressure_mean, Tank::at(0.0, 0.14), Tank::at(0.14, 0.0)),
      probe_at(ProbeType::pressure, Tank::at(0.41, 0.23)),
      probe_at(ProbeType::velocity, Tank::at(0.41, 0.23)),
      probe_at(ProbeType::velocity, Tank::at(0.5, 1.4)),
      probe_at(ProbeType::energy, {}),
      probe_at(ProbeType::volume, {}),
      on_walls<Dim>(ProbeType::pressure_map, {}),
      on_walls<Dim>(ProbeType::force, Tank::at(0.2, 0.1)),
      probe_at(ProbeType::velocity_profile, Tank::at(0.43, 0.0)),
      probe_along(ProbeType::level_map, Coordinates(Dim, 0.1), Coordinates(Dim, 0.9)),
      on_walls<Dim>(ProbeType::run_up, {}),
      probe_at(ProbeType::front, {}),
  };
  for (std::size_t k = 0; k < probes.size(); ++k) probes[k].name = "p" + std::to_string(k);
  return probes;
}

/// The sloping tank with a plate across its water and some particles of the plate on both of its sides. Also returns
/// the plate that each particle belongs to.
template <int Dim>
std::pair<Tank<Dim>, std::vector<int>> tank_with_plate() {
  Tank<Dim> tank = sloping_tank<Dim>();
  const std::size_t others = tank.particles.size();
  WallTable plate;
  plate.shape = WallShape::plate;
  plate.points =
      Dim == 2 ? std::vector<Coordinates>{{0.42, 0.0}, {0.42, 0.4}}
               : std::vector<Coordinates>{
                     {0.42, 0.0, 0.0}, {0.42, Tank<Dim>::width, 0.0}, {0.42, Tank<Dim>::width, 0.4}, {0.42, 0.0, 0.4}};
  tank.spec.walls.push_back(plate);
  tank.boundary = make_boundary<Dim>(tank.spec);
  for (int k = 0; k < 40; ++k) {
    Vec<Dim> x = Vec<Dim>::Constant(0.5);
    x[0] = 0.42 + (k % 2 == 0 ? 1.0 : -1.0) * 0.5 * tank.dx;
    x[Dim - 1] = 0.01 * k;
    tank.add(x, false, 100.0 * k);
  }
  tank.locate();
  std::vector<int> felt_through(tank.particles.size(), -1);
  std::fill(felt_through.begin() + static_cast<std::ptrdiff_t>(others), felt_through.end(), 1);
  return {std::move(tank), std::move(felt_through)};
}

/// The particles that rank `rank` has: its own, and with `with_ghosts` all others as ghosts.
template <int Dim>
Particles<Dim> part_of(const Particles<Dim>& all, const Deal<Dim>& deal, int rank, bool with_ghosts) {
  Particles<Dim> part;
  for (const bool is_own : {true, false}) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if ((deal(i, all.position[i]) == rank) != is_own || !(is_own || with_ghosts)) continue;
      part.position.push_back(all.position[i]);
      part.velocity.push_back(all.velocity[i]);
      part.pressure.push_back(all.pressure[i]);
      part.volume.push_back(all.volume[i]);
      part.kind.push_back(all.kind[i]);
      part.wall_row.push_back(all.wall_row[i]);
      part.id.push_back(all.id[i]);
    }
    if (is_own) part.owned = part.size();
  }
  return part;
}

std::vector<double> numbers_in(const std::filesystem::path& path) {
  std::string text = text_of(path);
  text.erase(0, text.find('\n') + 1);
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream stream(text);
  return {std::istream_iterator<double>(stream), {}};
}

/// Takes all readings on one rank and on all ranks, and compares them.
template <int Dim>
void expect_same_readings(const Deal<Dim>& deal, bool with_ghosts) {
  Tank<Dim> tank = sloping_tank<Dim>();
  tank.accelerate(5.0);
  tank.spec.probes = all_probes<Dim>();
  // Without ghosts no rank can determine which particles are connected.
  if (!with_ghosts) tank.spec.probes.resize(tank.spec.probes.size() - 2);
  const FlowTotals totals{.kinetic_energy = 1.5, .potential_energy = 2.5, .volume_out = 0.25};

  const SharedFolder together;
  const Communicator& ranks = together.ranks();
  ProbeSet<Dim> probes(make_probes<Dim>(tank.spec, tank.boundary),
                       RunFolder::create(together.path(), false, together.ranks()), together.ranks());
  const Particles<Dim> part = part_of<Dim>(tank.particles, deal, ranks.rank(), with_ghosts);
  const CellGrid<Dim> grid(part.position, 3.0 * tank.dx);
  const ProbeContext<Dim> whole = tank.context();
  const WallForces<Dim> own_forces = made_forces(part);
  ProbeContext<Dim> own = whole.of(part, grid);
  own.totals = totals;
  own.ranks = ranks;
  own.wall_forces = &own_forces;
  Walls<Dim> walls;
  walls.boundary = tank.boundary;
  PatchesOfWalls<Dim> patches(tank.spec, walls);
  own.patches = &patches;
  const WallInertia<Dim> inertia{tank.blocked, tank.acceleration, {}};
  own.wall_inertia = &inertia;
  probes.record(own);

  if (!ranks.is_root()) return;
  const TemporaryFolder alone;
  ProbeSet<Dim> single(make_probes<Dim>(tank.spec, tank.boundary), RunFolder::create(alone.path(), false));
  const WallForces<Dim> all_forces = made_forces(whole.particles);
  ProbeContext<Dim> on_one = whole;
  on_one.totals = totals;
  on_one.wall_forces = &all_forces;
  on_one.patches = &patches;
  on_one.wall_inertia = &inertia;
  single.record(on_one);
  for (const ProbeTable& probe : tank.spec.probes) {
    const std::filesystem::path file = std::filesystem::path("probes") / (probe.name + ".csv");
    const std::vector<double> expected = numbers_in(alone.path() / file);
    const std::vector<double> read = numbers_in(together.path() / file);
    ASSERT_EQ(read.size(), expected.size()) << probe.name;
    for (std::size_t k = 0; k < read.size(); ++k) {
      EXPECT_NEAR(read[k], expected[k], 1e-12 * std::max(1.0, std::abs(expected[k]))) << probe.name << ", number " << k;
    }
  }
}

template <class Dimension>
class ProbesOnRanks : public testing::Test {
 protected:
  static Deal<Dimension::value> round_robin() {
    return [n = Communicator::world().size()](std::size_t i, const Vec<Dimension::value>&) {
      return static_cast<int>(i % n);
    };
  }
  /// Ranks from 2 on have no particles.
  static Deal<Dimension::value> halves() {
    return [n = Communicator::world().size()](std::size_t, const Vec<Dimension::value>& x) {
      return n > 1 && x[0] < 0.4 ? 1 : 0;
    };
  }
};
TYPED_TEST_SUITE(ProbesOnRanks, Dimensions);

TYPED_TEST(ProbesOnRanks, RoundRobin) { expect_same_readings<TypeParam::value>(this->round_robin(), false); }
TYPED_TEST(ProbesOnRanks, RoundRobinWithGhosts) { expect_same_readings<TypeParam::value>(this->round_robin(), true); }
TYPED_TEST(ProbesOnRanks, HalvesAndEmptyRanks) { expect_same_readings<TypeParam::value>(this->halves(), false); }
TYPED_TEST(ProbesOnRanks, HalvesAndEmptyRanksWithGhosts) {
  expect_same_readings<TypeParam::value>(this->halves(), true);
}

// The root combines the readings of all ranks. Particles of a plate count for the water that the plate hides.
TYPED_TEST(ProbesOnRanks, BesideAPlate) {
  constexpr int Dim = TypeParam::value;
  auto made = tank_with_plate<Dim>();
  Tank<Dim>& tank = made.first;
  std::vector<int>& felt_through = made.second;
  tank.spec.probes = {probe_at(ProbeType::depth, Tank<Dim>::at(0.40, 0.1)),
                      probe_at(ProbeType::depth, Tank<Dim>::at(0.44, 0.1))};
  tank.spec.probes[0].name = "left";
  tank.spec.probes[1].name = "right";
  const SharedFolder together;
  const Communicator& ranks = together.ranks();
  const auto is_own = [&](std::size_t i) { return static_cast<int>(i) % ranks.size() == ranks.rank(); };
  Particles<Dim> part = part_of<Dim>(
      tank.particles, [&](std::size_t i, const Vec<Dim>&) { return is_own(i) ? ranks.rank() : -1; }, ranks.rank(),
      false);
  std::vector<int> felt_through_of_part;
  for (std::size_t i = 0; i < felt_through.size(); ++i) {
    if (is_own(i)) felt_through_of_part.push_back(felt_through[i]);
  }
  const CellGrid<Dim> grid(part.position, 3.0 * tank.dx);
  ProbeContext<Dim> whole = tank.context();
  whole.felt_through = felt_through;
  std::vector<std::vector<double>> expected;
  for (const Probe<Dim>& probe : make_probes<Dim>(tank.spec, tank.boundary)) {
    expected.push_back(probe.reading.take(whole).at(0));
  }
  for (int& plate : felt_through) plate = -1;
  EXPECT_GT(std::abs(make_probes<Dim>(tank.spec, tank.boundary)[0].reading.take(whole).at(0).at(0) - expected[0][0]),
            1e-6)
      << "it matters who is of the plate";

  ProbeSet<Dim> probes(make_probes<Dim>(tank.spec, tank.boundary), RunFolder::create(together.path(), false, ranks),
                       ranks);
  ProbeContext<Dim> own = whole.of(part, grid);
  own.ranks = ranks;
  own.felt_through = felt_through_of_part;
  probes.record(own);
  if (!ranks.is_root()) return;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const std::vector<double> read = numbers_in(together.path() / "probes" / (tank.spec.probes[k].name + ".csv"));
    ASSERT_EQ(read.size(), expected[k].size() + 1);
    for (std::size_t n = 0; n < expected[k].size(); ++n) {
      EXPECT_NEAR(read[n + 1], expected[k][n], 1e-12 * std::max(1.0, std::abs(expected[k][n])));
    }
  }
}

TYPED_TEST(ProbesOnRanks, WithoutFluidTheFrontIsZero) {
  constexpr int dimension = TypeParam::value;
  const Tank<dimension> tank(0.5, [](const Vec<dimension>&) { return false; });
  ProbeContext<dimension> context = tank.context();
  const Reading<dimension> front = make_probes<dimension>(
                                       [&] {
                                         CaseSpec spec = tank.spec;
                                         spec.probes = {probe_at(ProbeType::front, {})};
                                         return spec;
                                       }(),
                                       tank.boundary)[0]
                                       .reading;
  const ProbeContext<dimension> on_ranks{context.particles,
                                         context.grid,
                                         context.kernel,
                                         context.boundary,
                                         context.density,
                                         context.gravity,
                                         context.spacing,
                                         0.0,
                                         {},
                                         Communicator::world()};
  EXPECT_EQ(front.take(on_ranks), (std::vector<Row>{{0.0, 0.0}}));
}

}  // namespace
}  // namespace tailwater
