#include "sampling/wall_layers.h"

#include <Eigen/Eigenvalues>

#include "geometry/mesh_surface.h"

namespace tailwater {
namespace {

constexpr double least_distance = 0.5;     // dx, between wall particles
constexpr double reach_over_depth = 2.0;   // most wall particles are nearer to their feet
constexpr double seam_over_spacing = 2.0;  // four places may be in the way of each other

/// Projector onto the directions that walls with these normals block: the sum of n n^T, eigenvalues clipped at 1.
template <int Dim>
Mat<Dim> blocked_by(const std::vector<Vec<Dim>>& normals) {
  Mat<Dim> sum = Mat<Dim>::Zero();
  for (const Vec<Dim>& n : normals) sum += n * n.transpose();
  if (normals.size() == 1) return sum;
  const Eigen::SelfAdjointEigenSolver<Mat<Dim>> eigen(sum);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMin(1.0).asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

template <int Dim>
WallParticleCollector<Dim>::WallParticleCollector(const Boundary<Dim>& body, const WallLayers& layers)
    : body_(body),
      tolerance_(corner_tolerance * layers.spacing),
      share_(layers.share),
      seam_(seam_over_spacing * layers.spacing),
      taken_((least_distance - corner_tolerance) * layers.spacing),
      plain_(reach_over_depth * layers.count * layers.spacing) {
  body.visit_plain_faces([&](int f) {
    const WallFace<Dim>& face = body.faces[f];
    const Eigen::AlignedBox<double, Dim> box = face.box();
    plain_.add(f, box.min(), box.max(), [&](const Vec<Dim>& x) { return (closest_point(face, x) - x).norm(); });
    all_plain_.push_back(f);
  });
}

template <int Dim>
bool WallParticleCollector<Dim>::is_behind_mesh(const WallPlace<Dim>& place, const WallMesh* own) const {
  if constexpr (Dim == 3) {
    for (const WallMesh& mesh : body_.meshes) {
      // The body is sampled where it is drawn.
      if (&mesh != own && mesh.surface->first_crossed(place.stands_at(), place.foot, tolerance_) >= 0) return true;
    }
  }
  return false;
}

template <int Dim>
void WallParticleCollector<Dim>::keep(const WallPlace<Dim>& place, std::int64_t number) {
  taken_.add(place.position);
  if (!share_.holds(place.position)) return;
  Vec<Dim> mean = Vec<Dim>::Zero();
  for (const Vec<Dim>& n : place.normals) mean += n;
  particles_.position.push_back(place.stands_at());
  particles_.normal.push_back(mean.normalized());
  particles_.blocked.push_back(blocked_by<Dim>(place.normals));
  particles_.share.push_back(place.share);
  particles_.wall.push_back(place.wall);
  particles_.number.push_back(number);
}

template class WallParticleCollector<2>;
template class WallParticleCollector<3>;

}  // namespace tailwater
