// The shape of a porous layer.
#pragma once

#include <memory>

#include "base/box.h"
#include "base/vec.h"
#include "case/spec.h"
#include "geometry/mesh_surface.h"
#include "geometry/polygon.h"

namespace tailwater {

template <int Dim>
class PorousRegion {
 public:
  /// Throws CaseError for corners of the wrong dimension and for a mesh that is not closed.
  PorousRegion(const CaseSpec& spec, const PorousTable& table);

  const Box<Dim>& box() const { return box_; }
  /// Distance [m] of a place from the surface of the layer, positive inside. Beyond `reach` [m] from the surface only
  /// its sign and that it is at least `reach` are right.
  double depth_inside(const Vec<Dim>& x, double reach) const;

 private:
  RegionShape shape_;
  Box<Dim> box_;
  Polygon outline_;
  std::shared_ptr<const MeshSurface> mesh_;
};

}  // namespace tailwater
