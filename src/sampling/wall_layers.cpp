#include "sampling/wall_layers.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

#include "base/box.h"
#include "base/eigen.h"
#include "geometry/crossing.h"
#include "geometry/mesh_surface.h"
#include "geometry/outer_patches.h"

namespace tailwater {
namespace {

constexpr double min_separation = 0.5;     // dx, between wall particles
constexpr double reach_over_depth = 2.0;   // most wall particles are nearer to their feet
constexpr double seam_over_spacing = 2.0;  // four places may be in the way of each other
constexpr double edge_cosine = 0.766;      // a wall that turns by 40 degrees
constexpr double edge_width = 0.25;        // within this many dx has an edge there

/// Eigenvectors and eigenvalues of a symmetric matrix other than 0. A 2 x 2 matrix is tridiagonal already, but
/// compute() would reduce it all the same, by products of blocks that take a quarter of the compile time of this
/// module. The result is identical in all digits.
template <int Dim>
std::pair<Mat<Dim>, Vec<Dim>> eigensystem_of(const Mat<Dim>& matrix) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Dim, Dim>> eigen;
  if constexpr (Dim == 2) {
    const double scale = matrix.cwiseAbs().maxCoeff();  // compute() scales by it too
    eigen.computeFromTridiagonal(to_eigen(matrix).diagonal() / scale,
                                 Eigen::Matrix<double, 1, 1>(matrix(1, 0) / scale));
    return {from_eigen<2, 2>(eigen.eigenvectors()), scale * from_eigen<2, 1>(eigen.eigenvalues())};
  } else {
    eigen.compute(to_eigen(matrix));
    return {from_eigen<3, 3>(eigen.eigenvectors()), from_eigen<3, 1>(eigen.eigenvalues())};
  }
}

/// Projector onto the directions that walls with these normals block: the sum of n n^T, eigenvalues clipped at 1.
template <int Dim>
Mat<Dim> blocked_by(const std::vector<Vec<Dim>>& normals) {
  Mat<Dim> sum = Mat<Dim>::Zero();
  for (const Vec<Dim>& n : normals) sum += n * n.transpose();
  if (normals.size() == 1) return sum;
  const auto [vectors, values] = eigensystem_of<Dim>(sum);
  return vectors * values.cwiseMin(1.0).asDiagonal() * vectors.transpose();
}

/// Whether each of two faces is behind the other, as at a convex edge.
template <int Dim>
bool form_ridge(const WallFace<Dim>& a, const WallFace<Dim>& b, double tolerance) {
  const auto is_behind = [&](const WallFace<Dim>& face, const WallFace<Dim>& other) {
    return std::ranges::all_of(face.corners, [&](const Vec<Dim>& x) { return other.height(x) < tolerance; });
  };
  return is_behind(a, b) && is_behind(b, a);
}

/// Whether a wall and a duct form a ridge, whose edges need not be the same: the middle of each is behind the other.
template <int Dim>
bool form_ridge_at_mouth(const WallFace<Dim>& a, const WallFace<Dim>& b) {
  const auto middle = [](const WallFace<Dim>& face) {
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (const Vec<Dim>& x : face.corners) sum += x;
    return Vec<Dim>(sum / Dim);
  };
  return a.height(middle(b)) < 0.0 && b.height(middle(a)) < 0.0;
}

}  // namespace

template <int Dim>
WallParticleCollector<Dim>::WallParticleCollector(const Boundary<Dim>& body, const WallLayers& layers)
    : body_(body),
      tolerance_(corner_tolerance * layers.spacing),
      share_(layers.share),
      seam_(seam_over_spacing * layers.spacing),
      look_distance_(edge_width * layers.spacing),
      touch_(reach_of_touch * layers.spacing),
      reach_(layers.starts_on_wall ? 0.0 : layers.count * layers.spacing),
      taken_((min_separation - corner_tolerance) * layers.spacing),
      plain_(reach_over_depth * layers.count * layers.spacing) {
  const Box<Dim> space = space_around<Dim>(body.domain, plain_.reach());
  body.visit_plain_faces([&](int f) {
    const WallFace<Dim>& drawn = body.faces[f];
    plain_faces_.push_back({f, drawn});
    visit_images<Dim>(body.domain, drawn.box(), space, [&](const Vec<Dim>& by) {
      plain_faces_.push_back({f, drawn.moved(by)});
    });
  });
  for (int k = 0; k < static_cast<int>(plain_faces_.size()); ++k) {
    const WallFace<Dim>& face = plain_faces_[k].face;
    const Box<Dim> box = face.box();
    plain_.add(k, box.min(), box.max(), [&](const Vec<Dim>& x) { return (closest_point(face, x) - x).norm(); });
    all_plain_.push_back(k);
  }
}

template <int Dim>
void WallParticleCollector<Dim>::take(const Vec<Dim>& x) {
  taken_.add(x);
  visit_images<Dim>(body_.domain, Box<Dim>(x), space_around<Dim>(body_.domain, seam_),
                    [&](const Vec<Dim>& by) { taken_.add(x + by); });
}

template <int Dim>
bool WallParticleCollector<Dim>::is_behind_mesh(const WallPlace<Dim>& place, const WallMesh* own) const {
  if constexpr (Dim == 3) {
    for (const WallMesh& mesh : body_.meshes) {
      // The body is sampled where it is drawn.
      if (&mesh != own && mesh.surface->first_crossed(place.stands_at(), place.foot, tolerance_) >= 0 &&
          !crosses_own_wall(place, mesh.wall)) {
        return true;
      }
    }
  }
  return false;
}

template <int Dim>
bool WallParticleCollector<Dim>::lies_on_own_wall(const WallPlace<Dim>& place, const WallFace<Dim>& face) const {
  return face.height(place.foot) < touch_ && std::ranges::any_of(place.normals, [&](const Vec<Dim>& n) {
           return face.normal.dot(n) > 1.0 - corner_tolerance;
         });
}

template <int Dim>
bool WallParticleCollector<Dim>::crosses_own_wall(const WallPlace<Dim>& place, int wall) const {
  const Vec<Dim> x = place.stands_at();
  return cross_near(body_, place.wall, wall, x, (x - place.foot).norm());
}

template <int Dim>
std::vector<WallFace<Dim>> WallParticleCollector<Dim>::faces_in_front_of(const WallPlace<Dim>& place) const {
  const Vec<Dim> x = place.stands_at();
  std::vector<std::pair<double, WallFace<Dim>>> found;
  const auto look_at = [&](const WallFace<Dim>& face) {
    if (face.height(x) > -tolerance_) return;
    const double distance = (closest_point(face, x) - x).norm();
    if (distance < reach_) found.emplace_back(distance, face);
  };
  for (const int f : faces_between(place)) look_at(plain_faces_[f].face);
  if constexpr (Dim == 3) {
    const Vec<3> around = Vec<3>::Constant(reach_);
    for (const WallMesh& mesh : body_.meshes) {
      mesh.surface->visit_in(x - around, x + around,
                             [&](int t) { look_at(face_of(mesh.surface->mesh(), t, mesh.wall)); });
    }
  }
  std::ranges::stable_sort(found, {}, [](const auto& entry) { return entry.first; });
  std::vector<WallFace<Dim>> faces;
  for (auto& entry : found) faces.push_back(std::move(entry.second));
  return faces;
}

template <int Dim>
bool WallParticleCollector<Dim>::sees(const WallPlace<Dim>& place, const WallFace<Dim>& face) const {
  WallPlace<Dim> through = place;
  through.foot = closest_point(face, place.stands_at());
  return !is_behind_mesh(through, nullptr) && std::ranges::none_of(faces_between(place), [&](int f) {
    return crosses(plain_faces_[f].face, place.stands_at(), through.foot, tolerance_);
  });
}

template <int Dim>
bool WallParticleCollector<Dim>::has_edge_between(const Vec<Dim>& x, const WallFace<Dim>& a,
                                                  const WallFace<Dim>& b) const {
  const Vec<Dim> from = closest_point(a, x);
  const Vec<Dim> offset = closest_point(b, x) - from;
  const int looks = static_cast<int>(std::ceil(offset.norm() / look_distance_));
  Vec<Dim> normal = a.normal;
  for (int look = 1; look <= looks; ++look) {
    const Vec<Dim> there = from + static_cast<double>(look) / looks * offset;
    const int f = body_.nearest(wrapped<Dim>(body_.domain, there), reach_).face;
    if (f < 0 || body_.faces[f].normal.dot(normal) < edge_cosine) return true;
    normal = body_.faces[f].normal;
  }
  return b.normal.dot(normal) < edge_cosine;  // at a corner the nearest face may be the one before it
}

template <int Dim>
Mat<Dim> WallParticleCollector<Dim>::normals_beyond_edges(const WallPlace<Dim>& place, const Vec<Dim>& sum) const {
  Mat<Dim> beyond = Mat<Dim>::Zero();
  const bool is_halfway_through = sum.norm() < corner_tolerance;  // a thin wall: it has no side
  if (is_halfway_through || body_.walls[place.wall].is_plate) return beyond;
  std::vector<WallFace<Dim>> meeting;  // at convex edges
  for (const WallFace<Dim>& face : faces_in_front_of(place)) {
    const auto turns_away = [&](const WallFace<Dim>& other) { return face.normal.dot(other.normal) < edge_cosine; };
    if (!std::ranges::all_of(meeting, turns_away) || !sees(place, face)) continue;
    const auto form_ridge_with = [&](const WallFace<Dim>& other) {
      const bool is_at_mouth = body_.walls[face.wall].is_duct != body_.walls[other.wall].is_duct;
      return is_at_mouth ? form_ridge_at_mouth(face, other) : form_ridge(face, other, tolerance_);
    };
    if (!std::ranges::all_of(meeting, form_ridge_with)) return beyond;
    if (meeting.empty() || has_edge_between(place.stands_at(), meeting.front(), face)) meeting.push_back(face);
  }
  if (meeting.size() < 2) return beyond;
  int column = 0;
  for (const WallFace<Dim>& face : meeting) {
    const bool is_own = face.normal.dot(sum.normalized()) > 1.0 - corner_tolerance;
    if (!is_own && column < Dim) beyond.put_column(column++, face.normal);
  }
  return beyond;
}

template <int Dim>
void WallParticleCollector<Dim>::keep(const WallPlace<Dim>& place, std::int64_t number) {
  take(place.position);
  if (!share_.holds(wrapped<Dim>(body_.domain, place.position))) return;
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (const Vec<Dim>& n : place.normals) sum += n;
  particles_.position.push_back(place.stands_at());
  particles_.normal.push_back(sum.normalized());
  particles_.blocked.push_back(blocked_by<Dim>(place.normals));
  particles_.beyond_edges.push_back(normals_beyond_edges(place, sum));
  particles_.share.push_back(place.share);
  particles_.wall.push_back(place.wall);
  particles_.is_beyond_end.push_back(place.is_beyond_end ? 1 : 0);
  particles_.number.push_back(number);
}

template class WallParticleCollector<2>;
template class WallParticleCollector<3>;

}  // namespace tailwater
