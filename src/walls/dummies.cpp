#include "walls/dummies.h"

#include <algorithm>

#include "base/for_each.h"
#include "sampling/space_share.h"
#include "sampling/wall_particles.h"
#include "walls/wet_walls.h"

namespace tailwater {
namespace {

/// By how much the pressure of wet wall particle i exceeds the mean of the water's in reach. Calls also(batch, W) for
/// its pairs, with W 0 where the neighbours are not water.
template <int Dim, class Also>
double excess_over_water(const WallScene<Dim>& scene, const WallForce<Dim>& force, std::size_t i, Also&& also) {
  const Pairs<Dim>& pairs = scene.pairs;
  const Interfaces& interfaces = scene.surroundings.interfaces;
  VecLanes<Dim> sum{};
  for_each_pair(pairs, i, [&](const auto& batch) {
    const PlaceLanes<Dim> place = batch.place();
    const Lanes weight = batch.kernel_of_fluid(place);
    sum += (interfaces.are_any() ? weight * interfaces.density_of(batch) : weight) * place.d;
    also(batch, weight);
  });
  return force.hydrostatic_difference(scene.particles, i, sum_of(sum) / scene.surroundings.wall_fluid_weight[i]);
}

template <int Dim>
void assemble_dummy_row(const WallScene<Dim>& scene, const WallForce<Dim>& force, std::size_t i,
                        LinearSystem::Row row) {
  if (!scene.surroundings.is_wet[i]) {
    row.finish_as_zero();
    return;
  }
  const auto share = static_cast<float>(1.0 / scene.surroundings.wall_fluid_weight[i]);
  double excess = 0.0;
  const double sum = row.write_weights([&](float* weights) {
    LaneSum sums;
    excess = excess_over_water(
        scene, force, i, [&](const auto& batch, const Lanes& weight) { sums += batch.store(share * weight, weights); });
    return sums.total();
  });
  row.finish(sum, excess);  // the sum is 1 but for rounding
}

template <int Dim>
class Dummies final : public WallModel<Dim> {
 public:
  WallTraits traits() const override { return {.pairs = WallRows::fluid_only}; }

  WallParticles<Dim> make_particles(const Boundary<Dim>& boundary, double spacing, int layers, const SpaceShare& share,
                                    const Lattice<Dim>& lattice) const override {
    return make_dummy_particles<Dim>(boundary, spacing, layers, share, lattice);
  }

  void show_velocity(const WallScene<Dim>& scene, std::span<const Vec<Dim>> V,
                     std::span<Vec<Dim>> velocity) const override {
    show_water<Dim>(scene, V, velocity,
                    [](auto /*row*/, const Vec<Dim>& own, const Vec<Dim>& tangential, const Vec<Dim>& normal) {
                      return Vec<Dim>(own + tangential - normal);
                    });
  }

  /// The velocity of a no-slip mirror image, 2 V - mean_w.
  void find_no_slip_velocity(const WallScene<Dim>& scene, std::span<const Vec<Dim>> V,
                             std::span<const Vec<Dim>> velocity, std::span<Vec<Dim>> no_slip) const override {
    const std::vector<Float4> of_water = as_float4<Dim>(velocity);
    for_each(scene.pairs.owned(), [&](std::size_t i) {
      if (scene.particles.is_fluid(i)) return;
      Vec<Dim> mean = Vec<Dim>::Zero();
      if (scene.surroundings.is_wet[i]) {
        mean = fluid_velocity_at_wall<Dim>(scene.pairs, i, scene.surroundings.wall_fluid_weight[i], of_water);
      }
      const Vec<Dim> wall_velocity = entry_of<Dim>(V, scene.particles.wall_row[i]);
      no_slip[i] = (wall_velocity - mean) + wall_velocity;
    });
  }

  void assemble_rows(const WallScene<Dim>& scene, const WallForce<Dim>& force, LinearSystem& system) const override {
    for_each(scene.pairs.owned(), [&](std::size_t i) {
      if (!scene.particles.is_fluid(i)) assemble_dummy_row(scene, force, i, system.row(i));
    });
  }

  void set_sources(const WallScene<Dim>& scene, const WallForce<Dim>& force, LinearSystem& system) const override {
    for_each(scene.pairs.owned(), [&](std::size_t i) {
      if (!scene.particles.is_fluid(i) && scene.surroundings.is_wet[i]) {
        system.set_rhs(i, excess_over_water(scene, force, i, [](auto&&...) {}));
      }
    });
  }

  bool follow_pressure(const WallScene<Dim>& scene, const WallForce<Dim>& force,
                       std::span<double> pressure) const override {
    for_each(scene.pairs.owned(), [&](std::size_t i) {
      if (scene.particles.is_fluid(i) || !scene.surroundings.is_wet[i]) return;
      LaneSum sum;
      const double excess = excess_over_water(
          scene, force, i, [&](const auto& batch, const Lanes& weight) { sum += weight * batch.of(pressure); });
      const std::vector<double>& tension = scene.surroundings.wall_tension;
      const double least = tension.empty() ? 0.0 : -tension[i];
      pressure[i] = std::max(least, sum.total() / scene.surroundings.wall_fluid_weight[i] + excess);
    });
    return true;
  }
};

}  // namespace

template <int Dim>
std::unique_ptr<const WallModel<Dim>> make_dummies() {
  return std::make_unique<Dummies<Dim>>();
}

TAILWATER_IN_2D_AND_3D(make_dummies);

}  // namespace tailwater
