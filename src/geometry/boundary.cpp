#include "geometry/boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/mesh_surface.h"

namespace tailwater {

template <int Dim>
void Boundary<Dim>::file_faces(double reach) {
  moving_.clear();
  resting_ = FaceGrid<Dim>(reach);
  visit_plain_faces([&](int f) {
    if (walls[faces[f].wall].moves()) {
      moving_.push_back(f);
      return;
    }
    const Eigen::AlignedBox<double, Dim> box = faces[f].box();
    resting_.add(f, box.min(), box.max(), [&](const Vec<Dim>& x) { return (closest_point(faces[f], x) - x).norm(); });
  });
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
  if (search_distance > resting_.reach() && resting_.reach() > 0.0) {
    // Most places that are asked about are beside a wall.
    const NearestWall<Dim> near = nearest(x, resting_.reach());
    if (near.face >= 0) return near;
  }
  NearestWall<Dim> best;
  double best_distance = search_distance;
  double best_height = 0.0;
  const auto look_at = [&](int f) {
    const WallFace<Dim>& face = faces[f];
    const double tie = 1e-9 * (face.corners[1] - face.corners[0]).norm();
    const double height = face.height(x);
    if (std::abs(height) > best_distance + tie) return;
    bool is_far = false;
    for (int axis = 0; axis < Dim; ++axis) {
      double low = face.corners[0][axis];
      double high = low;
      for (int c = 1; c < Dim; ++c) {
        low = std::min(low, face.corners[c][axis]);
        high = std::max(high, face.corners[c][axis]);
      }
      is_far = is_far || std::max(low - x[axis], x[axis] - high) > best_distance + tie;
    }
    if (is_far) return;
    const Vec<Dim> point = closest_point(face, x);
    const double distance = (x - point).norm();
    const bool is_tie = best.face >= 0 && std::abs(distance - best_distance) <= tie;
    if (height < 0.0 && !plates.empty() && walls[face.wall].is_plate) return;  // its other face is as near
    if (is_tie ? std::abs(height) > std::abs(best_height) : distance <= best_distance) {
      best = {f, point, height < 0.0 ? -distance : distance};
      best_distance = distance;
      best_height = height;
    }
  };
  if (search_distance <= resting_.reach()) {
    for (const int f : resting_.near(x)) look_at(f);
    for (const int f : moving_) look_at(f);
  } else {
    visit_plain_faces(look_at);
  }
  if constexpr (Dim == 3) {
    for (const WallMesh& mesh : meshes) {
      const Vec<3> moved = displacement_of(mesh);
      const SurfacePlace place = mesh.surface->nearest(x - moved, best_distance);
      if (place.triangle < 0) continue;
      // Where a mesh touches another wall, what is behind either is behind the walls.
      const double distance = std::abs(place.signed_distance);
      const bool is_tie = best.face >= 0 && best_distance - distance <= 1e-9 * distance;
      if (is_tie && place.signed_distance >= 0.0) continue;
      best = {mesh.first_face + place.triangle, place.point + moved, place.signed_distance};
      best_distance = distance;
    }
  }
  return best;
}

template struct Boundary<2>;
template struct Boundary<3>;

}  // namespace tailwater
