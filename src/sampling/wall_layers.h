// Common code for the wall particles of every kind of wall geometry. Each kind is one file with one function. The
// function proposes places for the particles of one body, layer by layer, to a WallParticleCollector, which keeps those
// that are free. It is declared at the end of this file and called in wall_particles.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/face_grid.h"
#include "geometry/images.h"
#include "geometry/point_grid.h"
#include "sampling/wall_particles.h"

namespace tailwater {

/// The requested layers of particles, `spacing` (m) apart.
struct WallLayers {
  double spacing;
  int count;
  bool starts_on_wall;    ///< whether the first layer stands on the wall; else it is spacing/2 behind it
  SpaceShare share = {};  ///< the part of space whose particles are requested

  /// The layers of a moving wall, of which all particles are requested, or of a wall at rest.
  WallLayers of_wall(bool moves) const { return {spacing, count, starts_on_wall, moves ? SpaceShare{} : share}; }
  double first_depth() const { return starts_on_wall ? 0.0 : 0.5 * spacing; }  ///< m behind the wall
};

/// Factor of a step [m] between wall particles in their relative volume; exactly 1 where the step is the spacing, up to
/// round-off.
inline double share_of_step(double step, double spacing) {
  constexpr double round_off = 1e-9;
  const double share = step / spacing;
  return std::abs(share - 1.0) < round_off ? 1.0 : share;
}

/// A place for a wall particle.
template <int Dim>
struct WallPlace {
  Vec<Dim> position;                   ///< m; must be free of other particles
  Vec<Dim> foot;                       ///< the nearest point of its own wall
  std::vector<Vec<Dim>> normals;       ///< of the faces that act there; several at a corner
  int wall = 0;                        ///< index into Boundary::walls
  Vec<Dim> offset = Vec<Dim>::Zero();  ///< m; from `position` to where the particle stands
  double share = 1.0;                  ///< volume of the particle, over dx^Dim
  bool is_beyond_end = false;          ///< whether it is beyond the end of its wall in the water

  Vec<Dim> stands_at() const { return position + offset; }
};

/// The particles of one body. None is nearer than spacing/2 to another: the first one proposed is kept. Every proposed
/// place has a number. Places outside the requested part of space are skipped, except for a seam around it. The seam
/// decides which places at the border of the part are free: particles beyond it could matter only through a chain of
/// places, each too near the next.
template <int Dim>
class WallParticleCollector {
 public:
  WallParticleCollector(const Boundary<Dim>& body, const WallLayers& layers);

  /// The number of the next place to be proposed.
  std::int64_t take_number() { return particles_.numbers++; }

  /// Whether a place is in the requested part of space, or in its seam.
  bool wants(const Vec<Dim>& x) const { return share_.is_near(wrapped<Dim>(body_.domain, x), seam_); }

  /// Keeps the place if no other particle is near.
  void add(const WallPlace<Dim>& place) {
    const std::int64_t number = take_number();
    if (wants(place.position) && is_free(place.position)) keep(place, number);
  }

  /// Keeps the place if no other particle is near and no face of another wall lies between the place and its foot.
  /// is_own(f) returns whether Boundary::faces[f], which belongs to no mesh, is a face of the place's own wall.
  template <class IsOwn>
  void add_unless_behind_another(const WallPlace<Dim>& place, IsOwn&& is_own) {
    const std::int64_t number = take_number();
    if (wants(place.position)) add_unless_behind_another(place, number, is_own);
  }

  /// Variant for a requested place that already has its number.
  template <class IsOwn>
  void add_unless_behind_another(const WallPlace<Dim>& place, std::int64_t number, IsOwn&& is_own,
                                 const WallMesh* own_mesh = nullptr) {
    if (!is_free(place.position)) return;
    const auto hides = [&](int f) {
      const auto& [drawn, face] = plain_faces_[f];
      return !is_own(drawn) && crosses(face, place.stands_at(), place.foot, tolerance_) &&
             !lies_on_own_wall(place, face) && !crosses_own_wall(place, face.wall);
    };
    if (!is_behind_mesh(place, own_mesh) && std::ranges::none_of(faces_between(place), hides)) keep(place, number);
  }

  /// To be called after all places on the wall itself have been proposed, before those behind it.
  void end_of_places_on_wall() { particles_.numbers_on_wall = particles_.numbers; }

  WallParticles<Dim> particles() && { return std::move(particles_); }

 private:
  /// A face that belongs to no mesh, or its image in another period.
  struct PlainFace {
    int drawn;  ///< index into Boundary::faces
    WallFace<Dim> face;
  };

  bool is_free(const Vec<Dim>& x) const { return !taken_.has_near(x); }
  /// Marks a place and its images as taken.
  void take(const Vec<Dim>& x);
  /// Indices of the plain faces that may lie between a place and its foot.
  std::span<const int> faces_between(const WallPlace<Dim>& place) const {
    return (place.stands_at() - place.foot).norm() <= plain_.reach() ? plain_.near(place.foot) : all_plain_;
  }
  /// Whether a face lies on the wall of the place, and faces the same way, as a wall that is drawn twice.
  bool lies_on_own_wall(const WallPlace<Dim>& place, const WallFace<Dim>& face) const;
  /// Whether a wall crosses that of the place. Behind its own wall it is then no border of water, and hides nothing.
  bool crosses_own_wall(const WallPlace<Dim>& place, int wall) const;
  /// Whether a mesh other than its own lies between a place and its foot.
  bool is_behind_mesh(const WallPlace<Dim>& place, const WallMesh* own) const;
  /// The faces within reach behind whose planes a place is, nearest first.
  std::vector<WallFace<Dim>> faces_in_front_of(const WallPlace<Dim>& place) const;
  /// Whether nothing lies between a place and the point of the face nearest to it.
  bool sees(const WallPlace<Dim>& place, const WallFace<Dim>& face) const;
  /// Whether the wall has a sharp edge between the points of two faces that are nearest to x, which is behind them.
  bool has_edge_between(const Vec<Dim>& x, const WallFace<Dim>& a, const WallFace<Dim>& b) const;
  /// WallParticles::beyond_edges of a place, from the sum of its normals.
  Mat<Dim> normals_beyond_edges(const WallPlace<Dim>& place, const Vec<Dim>& sum) const;
  void keep(const WallPlace<Dim>& place, std::int64_t number);

  const Boundary<Dim>& body_;
  double tolerance_;  ///< m
  SpaceShare share_;
  double seam_;           ///< m
  double look_distance_;  ///< m
  double touch_;          ///< m; walls that are nearer lie on each other
  double reach_;          ///< m; distance up to which dummies interact with water
  PointGrid<Dim> taken_;
  std::vector<PlainFace> plain_faces_;  ///< with their images near the domain
  FaceGrid<Dim> plain_;                 ///< `plain_faces_` by place
  std::vector<int> all_plain_;          ///< all indices of `plain_faces_`
  WallParticles<Dim> particles_;
};

/// 2D: faces joined to chains (wall_chains.cpp).
WallParticles<2> sample_chains(const Boundary<2>& body, const WallLayers& layers);

/// 2D: rows of dummies beyond the ends of walls (wall_chains.cpp), on the wall extended by the depth of the layers.
/// They act on water only through the wall, while its end is free (geometry/screen.h).
std::vector<WallParticles<2>> sample_beyond_ends(const Boundary<2>& boundary, const WallLayers& layers);

/// 3D: axis-parallel boxes (wall_boxes.cpp).
void sample_boxes(const Boundary<3>& body, const WallLayers& layers, WallParticleCollector<3>& collector);

/// 3D: the first `count` meshes (wall_meshes.cpp), on the nodes of a lattice. Throws InputError if the layers start on
/// the wall.
void sample_meshes(const Boundary<3>& body, int count, const WallLayers& layers, const Lattice<3>& lattice,
                   WallParticleCollector<3>& collector);

/// Plates (wall_plates.cpp), one part per side. The particles of both sides of a plate overlap in space, on both of its
/// sides. Water interacts only with the particles that the plate hides from it. Particles of plates from meshes stand
/// on nodes of the lattice.
template <int Dim>
std::vector<WallParticles<Dim>> sample_plates(const Boundary<Dim>& boundary, const WallLayers& layers,
                                              const Lattice<Dim>& lattice);

}  // namespace tailwater
