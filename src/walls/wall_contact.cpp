#include "walls/wall_contact.h"

#include "base/for_each.h"

namespace tailwater {
namespace {

constexpr double contact_distance = 0.5;  // dx
constexpr double min_gap = 0.01;          // dx; a move that starts nearer, or behind a wall, counts as starting here

/// Where the water was before a move, carried along by the wall.
template <int Dim>
Vec<Dim> carried_by(const WallDisplacements<Dim>& displacements, int wall, const Vec<Dim>& before) {
  return displacements.of_wall.empty() ? before : displacements.of_wall[wall](before);
}

/// A wall that limits a move.
template <int Dim>
struct LimitingWall {
  int face = -1;
  double signed_distance = 0.0;  ///< m; as of NearestWall
  double side = 1.0;             ///< -1: the water is on the side to which the normal of the face does not point
};

/// The wall that limits the move: one with a screen that the move has passed, else the nearest wall.
template <int Dim>
LimitingWall<Dim> limiting_wall(const Boundary<Dim>& boundary, double spacing,
                                const WallDisplacements<Dim>& displacements, const Vec<Dim>& before,
                                const Vec<Dim>& position) {
  // Twice the displacement, because a wall that moves carries the place where it began.
  for (const int s : boundary.screens_near(position, 2.0 * (position - before).norm())) {
    const Screen<Dim>& screen = boundary.screens[s];
    const Vec<Dim> carried = carried_by(displacements, screen.wall, before);
    if (screen.is_beyond || !screen.is_between(carried, position)) continue;
    const bool was_in_front = screen.height(carried) >= 0.0;
    return {was_in_front ? screen.front : screen.back, -std::abs(screen.height(position)),
            was_in_front || screen.is_plate ? 1.0 : -1.0};
  }
  const NearestWall<Dim> wall = boundary.nearest_to_water(position, search_distance * spacing);
  return {wall.face, wall.signed_distance};
}

/// Applies one cushion per adjacent wall; a corner has at most Dim of them. Returns whether the move would have ended
/// behind a wall.
template <int Dim>
bool cushion(const Boundary<Dim>& boundary, double spacing, const WallDisplacements<Dim>& displacements,
             const Vec<Dim>& before, Vec<Dim>& position, Vec<Dim>* velocity) {
  const double contact = contact_distance * spacing;
  bool would_cross = false;
  int last_face = -1;
  for (int attempt = 0; attempt < Dim; ++attempt) {
    const LimitingWall<Dim> wall = limiting_wall(boundary, spacing, displacements, before, position);
    if (wall.face < 0 || wall.face == last_face || wall.signed_distance >= contact) break;
    last_face = wall.face;
    const WallFace<Dim>& face = boundary.faces[wall.face];
    const Vec<Dim> carried = carried_by(displacements, face.wall, before);
    const Vec<Dim> normal = wall.side * face.normal;
    const double gap = std::clamp(wall.side * face.height(carried), min_gap * spacing, contact);
    const double approach = gap - wall.signed_distance;
    if (approach <= 0.0) continue;
    const double share = gap / (gap + approach);
    position += (share * gap - wall.signed_distance) * normal;
    if (velocity) {
      const double advance = displacements.of_wall.empty() ? 0.0 : normal.dot(carried - before) / displacements.dt;
      *velocity -= (1.0 - share) * std::min(0.0, velocity->dot(normal) - advance) * normal;
    }
    would_cross = would_cross || wall.signed_distance < 0.0;
  }
  return would_cross;
}

}  // namespace

template <int Dim>
void find_wall_overlap(const Pairs<Dim>& pairs, const Boundary<Dim>& boundary, double spacing,
                       const Particles<Dim>& particles, std::span<double> overlap) {
  for_each(pairs.owned(), [&](std::size_t i) {
    overlap[i] = 0.0;
    if (!particles.is_fluid(i) || pairs.sees_wall[i] == 0) return;
    const double contact = contact_distance * spacing * pairs.relative_spacing_of(i);
    const NearestWall<Dim> wall = boundary.nearest_to_water(particles.position[i], contact);
    if (wall.face < 0) return;
    const double s = std::clamp(1.0 - wall.signed_distance / contact, 0.0, 1.0);
    overlap[i] = 0.25 * s * s * (3.0 - s);
  });
}

template <int Dim>
std::size_t keep_off_walls(const Pairs<Dim>& pairs, const Boundary<Dim>& boundary, double spacing,
                           const WallDisplacements<Dim>& displacements, std::span<const Vec<Dim>> before,
                           Particles<Dim>& particles, std::span<Vec<Dim>> velocity) {
  return count_each(pairs.owned(), [&](std::size_t i) {
    if (!particles.is_fluid(i)) return false;
    // Beside the end of a wall no wall particle need be in sight.
    const double move = (particles.position[i] - before[i]).norm();
    return (pairs.sees_wall[i] != 0 || !boundary.screens_near(particles.position[i], 2.0 * move).empty()) &&
           cushion(boundary, spacing * pairs.relative_spacing_of(i), displacements, before[i], particles.position[i],
                   velocity.empty() ? nullptr : &velocity[i]);
  });
}

TAILWATER_IN_2D_AND_3D(find_wall_overlap);
TAILWATER_IN_2D_AND_3D(keep_off_walls);

}  // namespace tailwater
