#include "published/on_wall.h"

#include "base/for_each.h"
#include "walls/wet_walls.h"

namespace tailwater {

template <int Dim>
void OnWall<Dim>::show_velocity(const WallScene<Dim>& scene, std::span<const Vec<Dim>> V,
                                std::span<Vec<Dim>> velocity) const {
  const std::vector<Four> of_water = in_fours<Dim>(velocity);
  for_each(scene.pairs.owned(), [&](std::size_t i) {
    if (scene.particles.is_fluid(i)) return;
    velocity[i].setZero();
    if (!scene.here.is_wet[i]) return;
    const Vec<Dim> mean = fluid_velocity_at_wall<Dim>(scene.pairs, i, scene.here.wall_fluid_weight[i], of_water);
    const auto row = scene.particles.wall_row[i];
    const Vec<Dim> own = entry_of<Dim>(V, row);
    const Vec<Dim> relative = mean - own;
    const Vec<Dim> normal_part = scene.walls.particles.blocked[row] * relative;
    const Vec<Dim> tangential_part = relative - normal_part;
    velocity[i] = own + (1.0 - scene.walls.friction[row]) * tangential_part;
  });
}

template <int Dim>
void OnWall<Dim>::find_no_slip_velocity(const WallScene<Dim>& scene, std::span<const Vec<Dim>> V,
                                        std::span<const Vec<Dim>> /*velocity*/, std::span<Vec<Dim>> no_slip) const {
  for_each(scene.pairs.owned(), [&](std::size_t i) {
    if (!scene.particles.is_fluid(i)) no_slip[i] = entry_of<Dim>(V, scene.particles.wall_row[i]);
  });
}

template class OnWall<2>;
template class OnWall<3>;

}  // namespace tailwater
