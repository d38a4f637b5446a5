#include "published/on_wall.h"

#include "base/for_each.h"
#include "walls/wet_walls.h"

namespace tailwater {

template <int Dim>
void OnWall<Dim>::show_velocity(const WallScene<Dim>& scene, std::span<const Vec<Dim>> V,
                                std::span<Vec<Dim>> velocity) const {
  show_water<Dim>(scene, V, velocity,
                  [&](auto row, const Vec<Dim>& own, const Vec<Dim>& tangential, const Vec<Dim>& /*normal*/) {
                    return Vec<Dim>(own + (1.0 - scene.walls.friction[row]) * tangential);
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
