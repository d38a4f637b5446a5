#include "porous/porous_region.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "geometry/face.h"
#include "geometry/from_spec.h"
#include "geometry/mesh_walls.h"

namespace tailwater {
namespace {

/// Distance [m] from the outline of a polygon.
double distance_from_outline(const std::vector<Vec<2>>& corners, const Vec<2>& x) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const WallFace<2> edge{{corners[k], corners[(k + 1) % corners.size()]}, Vec<2>::Zero()};
    least = std::min(least, (x - closest_point(edge, x)).norm());
  }
  return least;
}

}  // namespace

template <int Dim>
PorousRegion<Dim>::PorousRegion(const CaseSpec& spec, const PorousTable& table) : shape_(table.shape) {
  const CaseLabel owner("porous", table.name);
  if (shape_ == RegionShape::box) {
    box_ = {to_vec<Dim>(table.min, owner, "min"), to_vec<Dim>(table.max, owner, "max")};
    return;
  }
  if constexpr (Dim == 2) {
    std::vector<Vec<2>> corners;
    for (std::size_t k = 0; k < table.points.size(); ++k) {
      corners.push_back(to_vec<2>(table.points[k], owner, fmt::format("points[{}]", k)));
      box_.extend(corners.back());
    }
    outline_ = Polygon(std::move(corners), 0.0);
  } else {
    mesh_ = std::make_shared<const MeshSurface>(make_water_mesh(spec, table, owner, {}));
    box_ = {mesh_->low(), mesh_->high()};
  }
}

template <int Dim>
double PorousRegion<Dim>::depth_inside(const Vec<Dim>& x, double reach) const {
  const double outside = box_.exteriorDistance(x);
  if (outside > 0.0 && (outside >= reach || shape_ == RegionShape::box)) return -outside;
  if (shape_ == RegionShape::box) return std::min((x - box_.min()).minCoeff(), (box_.max() - x).minCoeff());
  if constexpr (Dim == 2) {
    const double distance = distance_from_outline(outline_.corners(), x);
    return outline_.where(x) == Where::inside ? distance : -distance;
  } else {
    return -mesh_->nearest(x, std::numeric_limits<double>::infinity()).signed_distance;  // its front is outside
  }
}

template class PorousRegion<2>;
template class PorousRegion<3>;

}  // namespace tailwater
