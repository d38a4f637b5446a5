#include "closures/wall_contact.h"

#include "base/for_each.h"

namespace tailwater {
namespace {

constexpr double least_distance = 0.05;  // dx
constexpr double search_distance = 3.0;  // dx

/// One time per adjacent wall: a corner has at most Dim of them.
template <int Dim>
bool put_back(const Boundary<Dim>& boundary, double spacing, Vec<Dim>& position, Vec<Dim>& velocity) {
  bool moved = false;
  for (int attempt = 0; attempt < Dim; ++attempt) {
    const NearestWall<Dim> wall = boundary.nearest(position, search_distance * spacing);
    if (wall.face < 0 || wall.signed_distance >= least_distance * spacing) break;
    const Vec<Dim>& normal = boundary.faces[wall.face].normal;
    position = wall.point + least_distance * spacing * normal;
    velocity -= std::min(0.0, velocity.dot(normal)) * normal;
    moved = true;
  }
  return moved;
}

}  // namespace

template <int Dim>
std::size_t keep_off_walls(const Pairs<Dim>& pairs, const Boundary<Dim>& boundary, double spacing,
                           Particles<Dim>& particles) {
  return count_each(pairs.owned(), [&](std::size_t i) {
    if (!particles.is_fluid(i)) return false;
    bool is_near_wall = false;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i) && !is_near_wall; ++k) {
      is_near_wall = !particles.is_fluid(pairs.j[k]);
    }
    return is_near_wall && put_back(boundary, spacing, particles.position[i], particles.velocity[i]);
  });
}

template std::size_t keep_off_walls<2>(const Pairs<2>&, const Boundary<2>&, double, Particles<2>&);
template std::size_t keep_off_walls<3>(const Pairs<3>&, const Boundary<3>&, double, Particles<3>&);

}  // namespace tailwater
