#include "walls/facing_walls.h"

#include "geometry/facing.h"

namespace tailwater {
namespace {

constexpr double to_foot = 3.0;      // supports; rows are not farther from their wall
constexpr double like_cosine = 0.5;  // walls that turn by less than 60 degrees are one
constexpr double way_to_corner = 0.9;
constexpr double on_wall = 1e-3;  // supports

/// Whether a wall continues from `from`, a point of it, to nearly its intersection with another wall at `corner`.
template <int Dim>
bool goes_on(const Boundary<Dim>& boundary, const Vec<Dim>& from, const Vec<Dim>& corner, double radius) {
  return boundary.nearest(from + way_to_corner * (corner - from), on_wall * radius).face >= 0;
}

/// Whether two walls, seen at a point of each, meet in a corner of the water.
template <int Dim>
bool meet_in_corner(const Boundary<Dim>& boundary, const NearestWall<Dim>& a, const NearestWall<Dim>& b,
                    double radius) {
  const Vec<Dim>& n = boundary.faces[a.face].normal;
  const Vec<Dim>& m = boundary.faces[b.face].normal;
  if (face_each_other<Dim>(n, m)) return false;
  const Vec<Dim> towards = n.dot(m) * n - m;  // along wall a, down to wall b
  const double height = m.dot(a.point - b.point);
  const Vec<Dim> corner = a.point + height / towards.squaredNorm() * towards;
  return goes_on<Dim>(boundary, a.point, corner, radius) && goes_on<Dim>(boundary, b.point, corner, radius);
}

}  // namespace

template <int Dim>
Vec<Dim> normal_in_gap(const Walls<Dim>& walls, std::size_t row, double radius) {
  const Vec<Dim> none = Vec<Dim>::Zero();
  const Boundary<Dim>& boundary = walls.boundary;
  const NearestWall<Dim> own = boundary.nearest(walls.particles.position[row], to_foot * radius);
  if (own.face < 0) return none;
  // A ball that touches the wall from the water's side. Of walls as near as its own none faces it.
  const Vec<Dim>& n = boundary.faces[own.face].normal;
  const NearestWall<Dim> other = boundary.nearest(own.point + radius * n, radius);
  if (other.face < 0 || boundary.faces[other.face].normal.dot(n) > like_cosine) return none;
  return meet_in_corner(boundary, own, other, radius) ? none : n;
}

TAILWATER_IN_2D_AND_3D(normal_in_gap);

}  // namespace tailwater
