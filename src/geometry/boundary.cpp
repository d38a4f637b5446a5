#include "geometry/boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/box.h"
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
  WallSearch(const Boundary<Dim>& boundary, const Vec<Dim>& x, double search_distance)
      : boundary_(boundary), x_(x), best_{{}, search_distance} {}

  const NearestWall<Dim>& nearest() const { return best_.wall; }

  void visit_face(int f) {
    const WallFace<Dim>& face = boundary_.faces[f];
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

  void visit_mesh(const WallMesh& mesh) {
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
    best_ = {{face, place.point + moved, place.signed_distance}, distance, plane_distance};
  }

 private:
  static bool is_at_ended_edge(const WallMesh& mesh, const SurfacePlace& place) {
    return !mesh.ended_edges.empty() &&
           std::ranges::any_of(place.triangles, [&](int t) { return mesh.ended_edges[t] != 0; });
  }

  const Boundary<Dim>& boundary_;
  const Vec<Dim>& x_;
  WallInSight<Dim> best_;  ///< no face and the search distance until a wall is found
};

}  // namespace

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
  if (filed_distance > 0.0) {  // first, because most points are near a wall
    WallSearch<Dim> search(*this, x, std::min(search_distance, filed_distance));
    for (const int f : resting_->near(x)) search.visit_face(f);
    for (const int f : moving_) search.visit_face(f);
    search.visit_meshes();
    if (search.nearest().face >= 0 || search_distance <= filed_distance) return search.nearest();
  }
  WallSearch<Dim> search(*this, x, search_distance);
  visit_plain_faces([&](int f) { search.visit_face(f); });
  search.visit_meshes();
  return search.nearest();
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
  const auto takes = [&](int wall) { return is_part[static_cast<std::size_t>(wall)] != 0; };
  WallSearch<Dim> search(boundary, x, search_distance);
  boundary.visit_plain_faces([&](int f) {
    if (takes(boundary.faces[f].wall)) search.visit_face(f);
  });
  if constexpr (Dim == 3) {
    for (const WallMesh& mesh : boundary.meshes) {
      if (takes(mesh.wall)) search.visit_mesh(mesh);
    }
  }
  return search.nearest();
}

TAILWATER_IN_2D_AND_3D(nearest_among);

template struct Boundary<2>;
template struct Boundary<3>;

}  // namespace tailwater
