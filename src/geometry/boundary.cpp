#include "geometry/boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/assert.h"
#include "base/box.h"
#include "geometry/crossing.h"
#include "geometry/face_grid.h"
#include "geometry/mesh_surface.h"
#include "geometry/some_walls.h"

namespace tailwater {
namespace {

/// A wall as seen from a point.
template <int Dim>
struct WallInSight {
  NearestWall<Dim> wall;
  double distance;              ///< m; of the point from the wall
  double plane_distance = 0.0;  ///< m; of the point from the plane of a face
  bool is_on_rim = false;       ///< the nearest point is on the rim of a mesh, where the sign has no meaning
};

/// Whether face `a` is nearer than `b`. At a shared corner, where the distances differ by no more than `tolerance` [m],
/// the face whose plane is farther away counts as the nearer one: its sign is right.
template <int Dim>
bool nearer(const WallInSight<Dim>& a, const WallInSight<Dim>& b, double tolerance) {
  const bool are_equal = b.wall.face >= 0 && std::abs(a.distance - b.distance) <= tolerance;
  return are_equal ? a.plane_distance > b.plane_distance : a.distance <= b.distance;
}

/// The largest distance of `x` from the box around a face along any axis [m]; negative inside the box.
template <int Dim>
double distance_along_axes(const WallFace<Dim>& face, const Vec<Dim>& x) {
  Vec<Dim> low = face.corners[0];
  Vec<Dim> high = low;
  for (int c = 1; c < Dim; ++c) {
    low = low.cwiseMin(face.corners[c]);
    high = high.cwiseMax(face.corners[c]);
  }
  return (low - x).cwiseMax(x - high).maxCoeff();
}

/// The search for the wall nearest to a point. It visits faces and meshes in any number and keeps the nearest one.
/// Faces come first: where a mesh touches a face, the mesh replaces the face only for points behind the mesh.
template <int Dim>
class WallSearch {
 public:
  /// `counts` says of each wall whether it takes part; empty: all do.
  WallSearch(const Boundary<Dim>& boundary, const Vec<Dim>& x, double search_distance,
             std::span<const std::uint8_t> counts = {})
      : boundary_(boundary), x_(x), best_{{}, search_distance}, counts_(counts) {}

  const NearestWall<Dim>& nearest() const { return best_.wall; }
  bool is_on_rim() const { return best_.is_on_rim; }

  void visit_face(int f) {
    const WallFace<Dim>& face = boundary_.faces[f];
    if (!takes(face.wall)) return;
    const double tolerance = 1e-9 * (face.corners[1] - face.corners[0]).norm();
    const double height = face.height(x_);
    // Cheap lower bounds of the distance exclude most faces.
    if (std::abs(height) > best_.distance + tolerance) return;
    if (distance_along_axes(face, x_) > best_.distance + tolerance) return;
    if (height < 0.0 && boundary_.plate_of(face.wall) >= 0) return;  // the plate's opposite face is as near
    const Vec<Dim> point = closest_point(face, x_);
    const double distance = (x_ - point).norm();
    const bool is_behind = height < 0.0 && !boundary_.is_free_end(f, point);
    const WallInSight<Dim> seen{{f, point, is_behind ? -distance : distance}, distance, std::abs(height)};
    if (nearer(seen, best_, tolerance)) best_ = seen;
  }

  void visit_meshes() {
    if constexpr (Dim == 3) {
      for (const WallMesh& mesh : boundary_.meshes) visit_mesh(mesh);
    }
  }

 private:
  void visit_mesh(const WallMesh& mesh) {
    if (!takes(mesh.wall)) return;
    const Vec<Dim> moved = boundary_.displacement_of(mesh);
    SurfacePlace place = mesh.surface->nearest(x_ - moved, best_.distance);
    if (place.triangle < 0) return;
    if (place.is_on_rim && is_at_ended_edge(mesh, place)) place.signed_distance = std::abs(place.signed_distance);
    const double distance = std::abs(place.signed_distance);
    const int face = mesh.first_face + place.triangle;
    const double plane_distance = place.is_on_rim ? std::abs(boundary_.faces[face].height(x_)) : 0.0;
    // A point behind either of two walls that touch is behind the walls. Where they join at a rim, that whose plane is
    // farther away shows the side.
    const bool are_equal = best_.wall.face >= 0 && best_.distance - distance <= 1e-9 * distance;
    if (are_equal && (place.is_on_rim ? plane_distance <= best_.plane_distance : place.signed_distance >= 0.0)) return;
    best_ = {{face, place.point + moved, place.signed_distance}, distance, plane_distance, place.is_on_rim};
  }

  bool takes(int wall) const { return counts_.empty() || counts_[static_cast<std::size_t>(wall)] != 0; }

  static bool is_at_ended_edge(const WallMesh& mesh, const SurfacePlace& place) {
    return !mesh.ended_edges.empty() &&
           std::ranges::any_of(place.triangles, [&](int t) { return mesh.ended_edges[t] != 0; });
  }

  const Boundary<Dim>& boundary_;
  const Vec<Dim>& x_;
  WallInSight<Dim> best_;  ///< no face and the search distance until a wall is found
  std::span<const std::uint8_t> counts_;
};

/// The search among all faces and meshes, without the grid of faces.
template <int Dim>
WallSearch<Dim> search_all(const Boundary<Dim>& boundary, WallSearch<Dim> search) {
  boundary.visit_plain_faces([&](int f) { search.visit_face(f); });
  search.visit_meshes();
  return search;
}

/// Walls touch that are nearer than this fraction of the distances in question.
constexpr double touch = 1e-4;

/// The faces of a wall whose boxes meet a box.
template <int Dim>
std::vector<WallFace<Dim>> faces_in(const Boundary<Dim>& boundary, int wall, const Box<Dim>& box) {
  std::vector<WallFace<Dim>> found;
  boundary.visit_plain_faces([&](int f) {
    const WallFace<Dim>& face = boundary.faces[f];
    if (face.wall == wall && face.box().intersects(box)) found.push_back(face);
  });
  if constexpr (Dim == 3) {
    for (const WallMesh& mesh : boundary.meshes) {
      if (mesh.wall != wall) continue;
      const Vec<3> moved = boundary.displacement_of(mesh);
      mesh.surface->visit_in(box.min() - moved, box.max() - moved,
                             [&](int t) { found.push_back(boundary.faces[mesh.first_face + t]); });
    }
  }
  return found;
}

/// Whether a wall passes between two places.
bool is_between(const Boundary<3>& boundary, int wall, const Vec<3>& from, const Vec<3>& to) {
  Box<3> box;
  box.extend(from);
  box.extend(to);
  const auto faces = faces_in(boundary, wall, box);
  const double tolerance = touch * (to - from).norm();
  return std::ranges::any_of(faces, [&](const WallFace<3>& face) { return crosses(face, from, to, tolerance); });
}

/// The wall behind which `x` is, although it is in front of the `nearest` one: a wall that crosses the nearest one,
/// with no third wall between `x` and its nearest point. Without such a wall, the nearest one. search(WallSearch)
/// visits all walls within the search distance.
template <int Dim, class Search>
NearestWall<Dim> behind_crossing(const Boundary<Dim>& boundary, const Vec<Dim>& x, double search_distance,
                                 const NearestWall<Dim>& nearest, Search&& search) {
  if constexpr (Dim == 3) {
    if (boundary.meshes.empty() || nearest.face < 0 || nearest.signed_distance < 0.0) return nearest;
    const int first = boundary.faces[nearest.face].wall;
    std::vector<int> between;  // walls that are nearer than the next, but the first
    std::vector<std::uint8_t> is_left(boundary.walls.size(), 1);
    is_left[static_cast<std::size_t>(first)] = 0;
    while (between.size() + 1 < boundary.walls.size()) {
      const WallSearch<Dim> found = search({boundary, x, search_distance, is_left});
      const NearestWall<Dim>& next = found.nearest();
      if (next.face < 0) break;
      const int wall = boundary.faces[next.face].wall;
      const bool is_behind = next.signed_distance < 0.0 && !found.is_on_rim();
      if (is_behind && cross_near(boundary, first, wall, x, -next.signed_distance) &&
          std::ranges::none_of(between, [&](int other) { return is_between(boundary, other, x, next.point); })) {
        return next;
      }
      between.push_back(wall);
      is_left[static_cast<std::size_t>(wall)] = 0;
    }
  }
  return nearest;
}

}  // namespace

template <int Dim>
bool cross_near(const Boundary<Dim>& boundary, int a, int b, const Vec<Dim>& x, double distance) {
  for (const int wall : {a, b}) {
    if (boundary.walls[wall].is_duct || boundary.walls[wall].is_plate) return false;
  }
  constexpr double farthest_line = 4.0;
  const Vec<Dim> margin = Vec<Dim>::Constant(farthest_line * distance);
  const Box<Dim> around(Vec<Dim>(x - margin), Vec<Dim>(x + margin));
  const auto of_a = faces_in(boundary, a, around);
  const auto of_b = faces_in(boundary, b, around);
  const auto passes = [&](const WallFace<Dim>& one, const WallFace<Dim>& other) {
    for (int c = 0; c < Dim; ++c) {
      if (crosses(other, one.corners[c], one.corners[(c + 1) % Dim], touch * distance)) return true;
    }
    return false;
  };
  return std::ranges::any_of(of_a, [&](const WallFace<Dim>& one) {
    const Box<Dim> box = one.box();
    return std::ranges::any_of(of_b, [&](const WallFace<Dim>& other) {
      return box.intersects(other.box()) && (passes(one, other) || passes(other, one));
    });
  });
}

template <int Dim>
void Boundary<Dim>::file_faces(double reach) {
  moving_.clear();
  auto resting = std::make_shared<FaceGrid<Dim>>(reach);
  visit_plain_faces([&](int f) {
    if (walls[faces[f].wall].moves()) {
      moving_.push_back(f);
      return;
    }
    const Box<Dim> box = faces[f].box();
    resting->add(f, box.min(), box.max(), [&](const Vec<Dim>& x) { return (closest_point(faces[f], x) - x).norm(); });
  });
  resting_ = std::move(resting);
}

template <int Dim>
double Boundary<Dim>::filed_reach() const {
  return resting_ == nullptr ? 0.0 : resting_->reach();
}

int WallMesh::end_face() const { return first_face + static_cast<int>(surface->mesh().triangles.size()); }

template <int Dim>
const WallMesh* Boundary<Dim>::mesh_of(int face) const {
  for (const WallMesh& mesh : meshes) {
    if (face >= mesh.first_face && face < mesh.end_face()) return &mesh;
  }
  return nullptr;
}

template <int Dim>
double Boundary<Dim>::height_above(const WallMesh& mesh, const Vec<Dim>& x, double search_distance) const {
  if constexpr (Dim == 3) {
    const SurfacePlace place = mesh.surface->nearest(x - displacement_of(mesh), search_distance);
    if (place.triangle >= 0) return place.signed_distance;
  }
  return std::numeric_limits<double>::infinity();
}

template <int Dim>
Vec<Dim> Boundary<Dim>::displacement_of(const WallMesh& mesh) const {
  if constexpr (Dim == 3) return faces[mesh.first_face].corners[0] - mesh.surface->mesh().corner(0, 0);
  return Vec<Dim>::Zero();
}

template <int Dim>
NearestWall<Dim> Boundary<Dim>::nearest(const Vec<Dim>& x, double search_distance) const {
  const double filed_distance = filed_reach();
  const auto search_filed = [&](WallSearch<Dim> search) {
    for (const int f : resting_->near(x)) search.visit_face(f);
    for (const int f : moving_) search.visit_face(f);
    search.visit_meshes();
    return search;
  };
  if (filed_distance > 0.0) {  // first, because most points are near a wall
    const double distance = std::min(search_distance, filed_distance);
    const NearestWall<Dim> wall = search_filed({*this, x, distance}).nearest();
    if (wall.face >= 0) return behind_crossing(*this, x, distance, wall, search_filed);
    if (search_distance <= filed_distance) return wall;
  }
  const NearestWall<Dim> wall = search_all<Dim>(*this, {*this, x, search_distance}).nearest();
  TAILWATER_ASSERT(wall.face >= 0 || faces.empty() || std::isfinite(search_distance),
                   "a search without a limit finds a wall");
  if (filed_distance > 0.0) return wall;
  return behind_crossing(*this, x, search_distance, wall,
                         [&](const WallSearch<Dim>& search) { return search_all(*this, search); });
}

template <int Dim>
NearestWall<Dim> Boundary<Dim>::nearest_to_water(const Vec<Dim>& x, double search_distance) const {
  NearestWall<Dim> wall = nearest(x, search_distance);
  if (wall.face < 0 || wall.signed_distance >= 0.0) return wall;
  const bool is_screened = std::ranges::any_of(screens_near(wall.point, 0.0), [&](int s) {
    return !screens[s].is_plate && !screens[s].is_beyond && screens[s].front == wall.face;
  });
  if (is_screened && is_beside_free_end(faces[wall.face].wall, wall.point)) {
    wall.signed_distance = -wall.signed_distance;
  }
  return wall;
}

template <int Dim>
bool Boundary<Dim>::is_free_end(int face, const Vec<Dim>& x) const {
  return std::ranges::any_of(ends, [&](const WallEnd& end) {
    if (!(end.is_free || end.is_at_plate) || end.face != face) return false;
    const auto& corners = faces[face].corners;
    return (x - corners[end.corner]).norm() <= 1e-9 * (corners[1] - corners[0]).norm();
  });
}

template <int Dim>
NearestWall<Dim> nearest_among(const Boundary<Dim>& boundary, std::span<const std::uint8_t> is_part, const Vec<Dim>& x,
                               double search_distance) {
  return search_all<Dim>(boundary, {boundary, x, search_distance, is_part}).nearest();
}

template <int Dim>
bool is_crossed(const Boundary<Dim>& boundary, std::span<const std::uint8_t> is_part, const Vec<Dim>& from,
                const Vec<Dim>& to, double tolerance) {
  if constexpr (Dim == 3) {
    for (const WallMesh& mesh : boundary.meshes) {
      if (is_part[mesh.wall] == 0) continue;
      const Vec<3> moved = boundary.displacement_of(mesh);
      if (mesh.surface->first_crossed(from - moved, to - moved, tolerance) >= 0) return true;
    }
  }
  bool found = false;
  boundary.visit_plain_faces([&](int f) {
    const WallFace<Dim>& face = boundary.faces[f];
    found = found || (is_part[face.wall] != 0 && crosses(face, from, to, tolerance));
  });
  return found;
}

TAILWATER_IN_2D_AND_3D(cross_near);
TAILWATER_IN_2D_AND_3D(nearest_among);
TAILWATER_IN_2D_AND_3D(is_crossed);

template struct Boundary<2>;
template struct Boundary<3>;

}  // namespace tailwater
