#include "walls/turning_walls.h"

#include <algorithm>
#include <array>

#include "base/for_each.h"
#include "geometry/rotation.h"
#include "walls/wet_walls.h"

namespace tailwater {
namespace {

constexpr double corner_cosine = 0.766;  // of 40 degrees
constexpr int looks = 4;                 // within dx, on each side

/// The normal of the body's wall nearest to x, on the side of `like`; 0 if a corner is between them.
template <int Dim>
Vec<Dim> normal_near(const Boundary<Dim>& boundary, int body, const Vec<Dim>& x, const Vec<Dim>& like, double reach) {
  const NearestWall<Dim> wall = boundary.nearest(x, reach);
  if (wall.face < 0) return Vec<Dim>::Zero();
  const WallFace<Dim>& face = boundary.faces[wall.face];
  const WallProperties& properties = boundary.walls[face.wall];
  if (properties.body != body) return Vec<Dim>::Zero();
  const bool is_other_side = properties.is_plate && face.normal.dot(like) < 0.0;
  const Vec<Dim> normal = is_other_side ? Vec<Dim>(-face.normal) : face.normal;
  return normal.dot(like) > corner_cosine ? normal : Vec<Dim>(Vec<Dim>::Zero());
}

/// The normal at the end of a displacement along the wall, on which it was n; 0 if there is a corner.
template <int Dim>
Vec<Dim> normal_along(const Boundary<Dim>& boundary, int body, const Vec<Dim>& foot, const Vec<Dim>& n,
                      const Vec<Dim>& along, double reach) {
  Vec<Dim> normal = n;
  for (int look = 1; look <= looks && !normal.isZero(0.0); ++look) {
    const Vec<Dim> x = foot + static_cast<double>(look) / looks * along;
    normal = normal_near<Dim>(boundary, body, x, normal, reach);
  }
  return normal;
}

/// One unit vector across n in 2D, two in 3D.
template <int Dim>
std::array<Vec<Dim>, Dim - 1> tangents_of(const Vec<Dim>& n) {
  if constexpr (Dim == 2) {
    return {Vec<2>(n[1], -n[0])};
  } else {
    const Vec<3> first = across(n);
    return {first, n.cross(first)};
  }
}

template <int Dim>
Mat<Dim> curvature_at(const Walls<Dim>& walls, std::size_t row, double spacing, double reach) {
  const Boundary<Dim>& boundary = walls.boundary;
  const Mat<Dim> none = Mat<Dim>::Zero();
  const NearestWall<Dim> wall = boundary.nearest(walls.particles.position[row], reach);
  if (wall.face < 0) return none;
  const int body = boundary.walls[walls.particles.wall[row]].body;
  const Vec<Dim> n = normal_near(boundary, body, wall.point, walls.particles.normal[row], reach);
  if (n.isZero(0.0)) return none;
  Mat<Dim> S = none;
  for (const Vec<Dim>& t : tangents_of<Dim>(n)) {
    const Vec<Dim> ahead = normal_along<Dim>(boundary, body, wall.point, n, spacing * t, reach);
    const Vec<Dim> behind = normal_along<Dim>(boundary, body, wall.point, n, -spacing * t, reach);
    if (ahead.isZero(0.0) || behind.isZero(0.0)) return none;
    S += (ahead - behind) / (2.0 * spacing) * t.transpose();
  }
  const Mat<Dim> along = Mat<Dim>::Identity() - n * n.transpose();
  return 0.5 * along * (S + S.transpose()) * along;
}

/// In 3D boxes and rectangles are flat.
template <int Dim>
bool may_be_curved(const Boundary<Dim>& boundary) {
  return Dim == 2 || !boundary.meshes.empty() ||
         std::ranges::any_of(boundary.plates, [](const WallPlate& plate) { return plate.sheet != nullptr; });
}

/// By how much a normal n at a row turns until mid-step, in the wall's frame.
template <int Dim>
Vec<Dim> turn_of_normal(const Walls<Dim>& walls, const WallTurns<Dim>& turns, std::size_t row, const Vec<Dim>& n,
                        const Vec<Dim>& t) {
  const Mat<Dim> S = walls.is_curved ? walls.curvature[row] : Mat<Dim>(Mat<Dim>::Zero());
  if (row >= walls.moving) return 0.5 * turns.dt * (S * t);
  const int wall = walls.particles.wall[row];
  const Mat<Dim>& from_drawn = turns.from_drawn[wall];
  return 0.5 * turns.dt * (from_drawn * (S * (from_drawn.transpose() * t))) + turns.in_step[wall] * n - n;
}

}  // namespace

template <int Dim>
std::vector<Mat<Dim>> find_curvature(const Walls<Dim>& walls, double spacing, double reach) {
  if (!may_be_curved(walls.boundary)) return {};
  std::vector<Mat<Dim>> curvature(walls.particles.size());
  for_each(curvature.size(), [&](std::size_t row) { curvature[row] = curvature_at(walls, row, spacing, reach); });
  return curvature;
}

template <int Dim>
void follow_turning_walls(const WallScene<Dim>& scene, const WallTurns<Dim>& turns, std::span<const Vec<Dim>> V,
                          std::span<Vec<Dim>> velocity, std::span<Vec<Dim>> acceleration) {
  const Walls<Dim>& walls = scene.walls;
  for_each(scene.pairs.owned(), [&](std::size_t i) {
    acceleration[i].setZero();
    if (scene.particles.is_fluid(i) || !scene.surroundings.is_wet[i]) return;
    const auto row = static_cast<std::size_t>(scene.particles.wall_row[i]);
    if (row >= walls.moving && (!walls.is_curved || walls.curvature[row].isZero(0.0))) return;
    const Mirror<Dim> mirror = mirror_at(scene, i);
    const Vec<Dim>& n = mirror.normal;
    const Vec<Dim> relative = velocity[i] - entry_of<Dim>(V, scene.particles.wall_row[i]);
    const Vec<Dim> t = relative - mirror.blocked * relative;
    const double c = t.dot(turn_of_normal(walls, turns, row, n, t));
    if (turns.comes_from_chord) acceleration[i] = -2.0 * c / turns.dt * n;
    velocity[i] += (turns.comes_from_chord ? 2.0 : -2.0) * c * n;  // mirrored at V + c n, at V - c n
  });
}

TAILWATER_IN_2D_AND_3D(find_curvature);
TAILWATER_IN_2D_AND_3D(follow_turning_walls);

}  // namespace tailwater
