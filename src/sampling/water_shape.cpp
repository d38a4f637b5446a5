#include "sampling/water_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/box.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"
#include "sampling/fill.h"

namespace tailwater {

std::vector<Vec<2>> outline_of(const FluidTable& block, const CaseLabel& owner) {
  std::vector<Vec<2>> outline;
  for (std::size_t k = 0; k < block.points.size(); ++k) {
    outline.push_back(to_vec<2>(block.points[k], owner, fmt::format("points[{}]", k)));
  }
  if (outline.size() < 3) {
    throw CaseError("block-too-few-points", {"{} has {} points", owner, outline.size()}, {"give a polygon at least 3"});
  }
  return outline;
}

template <int Dim>
WaterShape<Dim>::WaterShape(const CaseSpec& spec, std::size_t block, const Boundary<Dim>& boundary,
                            const Lattice<Dim>& lattice)
    : tolerance_(corner_tolerance * spec.particles.spacing) {
  const FluidTable& table = spec.fluid[block];
  const CaseLabel owner = fluid_label(spec, block);
  if (table.shape == BlockShape::fill) filled_ = filled_cells<Dim>(spec, table, owner, boundary, lattice);
  if constexpr (Dim == 2) {
    if (table.shape != BlockShape::polygon) return;
    polygon_ = Polygon(outline_of(table, owner), tolerance_);
    const std::vector<Vec<2>>& corners = polygon_.corners();
    const double area = signed_area(corners);
    volume_ = std::abs(area);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      Vec<2> from = corners[k];
      Vec<2> to = corners[(k + 1) % corners.size()];
      if ((to - from).norm() <= tolerance_) continue;
      if (area < 0.0) std::swap(from, to);
      const Vec<2> along = (to - from).normalized();
      outline_.faces.push_back({{from, to}, Vec<2>(-along[1], along[0]), 0});
    }
    outline_.walls.emplace_back();
    outline_.file_faces(2.0 * spec.particles.spacing);
  } else if (table.shape == BlockShape::mesh) {
    mesh_ = boundary.water[block].get();
    volume_ = six_volumes(mesh_->mesh(), [](int) { return true; }) / 6.0;
  }
}

template <int Dim>
bool WaterShape<Dim>::holds(const Cell<Dim>& cell, const Vec<Dim>& x) {
  if (filled_) return filled_->holds(cell);
  if constexpr (Dim == 2) {
    return polygon_.corners().empty() || polygon_.where(x) != Where::outside;
  } else {
    if (mesh_ == nullptr) return true;
    if (const double distance = (x - last_).norm(); !(distance < std::abs(last_height_) - tolerance_)) {
      last_ = x;
      last_height_ = mesh_->nearest(x, std::numeric_limits<double>::infinity()).signed_distance;
    }
    return last_height_ <= tolerance_;
  }
}

template <int Dim>
Bodies<Dim>::Bodies(const CaseSpec& spec, const Boundary<Dim>& boundary)
    : boundary_(boundary), tolerance_(corner_tolerance * spec.particles.spacing) {
  for (std::size_t w = 0; w < spec.walls.size(); ++w) {
    const WallTable& wall = spec.walls[w];
    if (wall.fluid_side != FluidSide::outside) continue;
    const CaseLabel owner = wall_label(boundary, static_cast<int>(w));
    if (wall.shape == WallShape::box) {
      boxes_.emplace_back(to_vec<Dim>(wall.min, owner, "min"), to_vec<Dim>(wall.max, owner, "max"));
    } else if constexpr (Dim == 2) {
      std::vector<Vec<2>> outline;
      for (const Coordinates& point : wall.points) outline.push_back(to_vec<2>(point, owner, "points"));
      polygons_.emplace_back(std::move(outline), tolerance_);
    }
  }
  for (const WallMesh& mesh : boundary.meshes) {
    if (spec.walls[mesh.wall].fluid_side == FluidSide::outside) meshes_.push_back(&mesh);
  }
}

template <int Dim>
bool Bodies<Dim>::hold(const Vec<Dim>& x) const {
  const Vec<Dim> margin = Vec<Dim>::Constant(tolerance_);
  for (const Box<Dim>& box : boxes_) {
    if (box.contains(x - margin) && box.contains(x + margin)) {
      return true;
    }
  }
  if constexpr (Dim == 2) {
    for (const Polygon& polygon : polygons_) {
      if (polygon.where(x) == Where::inside) return true;
    }
  }
  return std::ranges::any_of(meshes_, [&](const WallMesh* mesh) {
    return boundary_.height_above(*mesh, x, std::numeric_limits<double>::infinity()) < -tolerance_;
  });
}

template class WaterShape<2>;
template class WaterShape<3>;
template class Bodies<2>;
template class Bodies<3>;

}  // namespace tailwater
