#include "walls/hidden_pairs.h"

#include "base/for_each.h"

namespace tailwater {

template <int Dim>
std::vector<int> plates_of_particles(const Walls<Dim>& walls, const Particles<Dim>& particles) {
  if (walls.boundary.screens.empty()) return {};
  std::vector<int> plates(particles.size(), -1);
  for_each(particles.size(), [&](std::size_t i) {
    if (particles.is_fluid(i)) return;
    plates[i] = walls.boundary.plate_of(walls.particles.wall[particles.wall_row[i]]);
  });
  return plates;
}

template <int Dim>
void hide_pairs_behind_plates(const Walls<Dim>& walls, const Particles<Dim>& particles,
                              Neighbourhood<Dim>& neighbourhood) {
  const std::vector<Screen<Dim>>& screens = walls.boundary.screens;
  if (screens.empty()) return;
  const std::vector<int> plates = plates_of_particles(walls, particles);
  const double radius = kernel_radius(neighbourhood.kernel());
  const Pairs<Dim>& pairs = neighbourhood.pairs();
  std::vector<int> near;
  std::size_t row = pairs.owned();
  neighbourhood.keep_pairs([&](std::size_t i, std::size_t k) {
    if (i != row) {  // the first pair of this row
      row = i;
      near.clear();
      for (const int s : walls.boundary.screens_near(particles.position[i], radius)) {
        if (screens[s].distance(particles.position[i]) < radius) near.push_back(s);
      }
    }
    const auto j = static_cast<std::size_t>(pairs.j[k]);
    const int plate = std::max(plates[i], plates[j]);
    // In an order that both rows of the pair agree about.
    const bool is_forward = particles.id[i] < particles.id[j];
    const Vec<Dim>& from = particles.position[is_forward ? i : j];
    const Vec<Dim>& to = particles.position[is_forward ? j : i];
    return !is_hidden<Dim>(screens, near, from, to, plate);
  });
}

TAILWATER_IN_2D_AND_3D(plates_of_particles);
TAILWATER_IN_2D_AND_3D(hide_pairs_behind_plates);

}  // namespace tailwater
