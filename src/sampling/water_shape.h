// The shape of a block of water as drawn, without regard to walls and bodies.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/box.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "geometry/mesh_surface.h"
#include "geometry/polygon.h"
#include "sampling/cell_set.h"
#include "sampling/lattice_axis.h"

namespace tailwater {

/// Corners of a polygon. Throws CaseError if there are fewer than three.
std::vector<Vec<2>> outline_of(const FluidTable& block, const CaseLabel& owner);

/// Shape of a block. A box and a fill have no surface of their own: their lattice ends with them.
template <int Dim>
class WaterShape {
 public:
  /// Throws InputError as outline_of and filled_cells do.
  WaterShape(const CaseSpec& spec, std::size_t block, const Boundary<Dim>& boundary, const Lattice<Dim>& lattice);

  /// Whether the point, the centre of a cell, is in the shape or on its surface. Calls in order along a line rarely
  /// search a mesh: a point nearer to the last one than the surface was is on the same side.
  bool holds(const Cell<Dim>& cell, const Vec<Dim>& x);

  bool has_surface() const { return mesh_ != nullptr || !outline_.faces.empty(); }
  double volume() const { return volume_; }  ///< m^Dim, enclosed by the surface

  /// Calls visit(point, height, normal) with the point of the surface nearest to x, if it is within `reach` [m]. The
  /// height of x above it is positive inside.
  template <class Visit>
  void visit_surface(const Vec<Dim>& x, double reach, Visit&& visit) const {
    if (!outline_.faces.empty()) {
      const NearestWall<Dim> near = outline_.nearest(x, reach);
      if (near.face >= 0) visit(near.point, near.signed_distance, outline_.faces[near.face].normal);
    }
    if constexpr (Dim == 3) {
      if (mesh_ == nullptr) return;
      const SurfacePlace near = mesh_->nearest(x, reach);
      if (near.triangle < 0) return;
      visit(near.point, -near.signed_distance, Vec<3>(-mesh_->mesh().area_normal(near.triangle).normalized()));
    }
  }

 private:
  double tolerance_;       ///< m
  Boundary<Dim> outline_;  ///< of a polygon
  Polygon polygon_;
  const MeshSurface* mesh_ = nullptr;  ///< its front is outside
  std::optional<CellSet<Dim>> filled_;
  double volume_ = 0.0;
  Vec<Dim> last_ = Vec<Dim>::Zero();  ///< the point of the last call of `holds`
  double last_height_ = 0.0;          ///< m; of `last_` above the mesh
};

/// Bodies that stand in the water: walls with the water outside.
template <int Dim>
class Bodies {
 public:
  Bodies(const CaseSpec& spec, const Boundary<Dim>& boundary);

  /// Whether `x` is inside a body, not on its surface.
  bool hold(const Vec<Dim>& x) const;

 private:
  const Boundary<Dim>& boundary_;
  double tolerance_;  ///< m
  std::vector<Box<Dim>> boxes_;
  std::vector<Polygon> polygons_;
  std::vector<const WallMesh*> meshes_;
};

/// Whether the particles of `block` are fitted to this face. A misfit between the edge of a box and an axis-parallel
/// wall that is not a body is an error of the case file, and check_geometry reports it.
template <int Dim>
bool adapts_to_wall(const CaseSpec& spec, const FluidTable& block, const WallFace<Dim>& face) {
  const bool is_axis_parallel = face.normal.cwiseAbs().maxCoeff() > 1.0 - 1e-9;
  return block.shape != BlockShape::box || !is_axis_parallel || spec.walls[face.wall].fluid_side == FluidSide::outside;
}

}  // namespace tailwater
