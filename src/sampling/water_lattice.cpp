#include "sampling/water_lattice.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/box.h"
#include "geometry/from_spec.h"
#include "geometry/mesh_surface.h"
#include "sampling/water_shape.h"

namespace tailwater {
namespace {

/// dx; a face divides the lattice if its area is at least that of a square with this edge (in 2D, if it is as long).
constexpr double min_edge = 3.0;

template <int Dim>
bool is_axis_parallel(const WallFace<Dim>& face) {
  return face.normal.cwiseAbs().maxCoeff() > 1.0 - 1e-9;
}

/// The box around a box or polygon.
template <int Dim>
Box<Dim> box_around(const FluidTable& block, const CaseLabel& owner) {
  Box<Dim> box;
  if (block.shape == BlockShape::polygon) {
    if constexpr (Dim == 3) {
      throw CaseError("block-shape-2d-only", {"{} = \"polygon\" exists in 2D only", owner.with_key("shape")},
                      {"in 3D use shape = \"box\", \"mesh\" or \"fill\""});
    } else {
      for (const Vec<2>& corner : outline_of(block, owner)) box.extend(corner);
    }
  } else {
    box.min() = to_vec<Dim>(block.min, owner, "min");
    box.max() = to_vec<Dim>(block.max, owner, "max");
  }
  for (int axis = 0; axis < Dim; ++axis) {
    if (box.max()[axis] > box.min()[axis]) continue;
    throw CaseError("block-without-extent",
                    {"{} has no extent in {}: it starts at {} and ends at {}", owner, "xyz"[axis], box.min()[axis],
                     box.max()[axis]},
                    {"give an end that is greater than the start"});
  }
  return box;
}

/// Coordinates of the planes of axis-parallel walls normal to `axis` that reach into the box.
template <int Dim>
std::vector<double> planes_in(const Boundary<Dim>& boundary, const Box<Dim>& box, int axis, double min_measure) {
  std::vector<double> planes;
  for (const WallFace<Dim>& face : boundary.faces) {
    if (is_axis_parallel(face) && face.measure() >= min_measure && std::abs(face.normal[axis]) > 0.5 &&
        box.intersects(face.box())) {
      planes.push_back(face.corners[0][axis]);
    }
  }
  std::ranges::sort(planes);
  planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
  return planes;
}

/// Coordinates of the planes of a mesh's faces normal to `axis`. The faces may be small if together they are large
/// enough.
std::vector<double> planes_in(const TriangleMesh& mesh, int axis, double spacing) {
  const double tolerance = corner_tolerance * spacing;
  std::vector<std::pair<double, double>> flats;  // plane and area
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const Vec<3> normal = mesh.area_normal(t);
    if (std::abs(normal[axis]) < (1.0 - 1e-9) * normal.norm()) continue;
    flats.emplace_back(mesh.corner(t, 0)[axis], 0.5 * normal.norm());
  }
  std::ranges::sort(flats);
  std::vector<double> planes;
  for (std::size_t k = 0; k < flats.size();) {
    double area = 0.0;
    const double plane = flats[k].first;
    for (; k < flats.size() && flats[k].first - plane <= tolerance; ++k) area += flats[k].second;
    if (area >= power<2>(min_edge * spacing)) planes.push_back(plane);
  }
  return planes;
}

/// Appends the coordinates of a polygon's axis-parallel sides normal to `axis`.
void append_flat_sides(const std::vector<Vec<2>>& outline, int axis, double spacing, std::vector<double>& planes) {
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec<2> side = outline[(k + 1) % outline.size()] - outline[k];
    if (side[axis] == 0.0 && side.norm() >= min_edge * spacing) planes.push_back(outline[k][axis]);
  }
}

}  // namespace

template <int Dim>
Lattice<Dim> make_lattice(const CaseSpec& spec, std::size_t block, const Boundary<Dim>& boundary) {
  const FluidTable& water = spec.fluid[block];
  const CaseLabel owner = fluid_label(spec, block);
  const double dx = spec.particles.spacing;
  std::array<LatticeAxis, Dim> lattice;
  Box<Dim> box;
  if (water.shape == BlockShape::fill) {
    box = box_around(boundary.faces);
    box.extend(to_vec<Dim>(water.seed, owner, "seed"));
    box.max()[Dim - 1] = water.level;
  } else if (Dim == 3 && water.shape == BlockShape::mesh) {
    if constexpr (Dim == 3) box = {boundary.water[block]->low(), boundary.water[block]->high()};
  } else {
    box = box_around<Dim>(water, owner);
  }
  // Walls that only touch the sides of the water do not divide it.
  const Vec<Dim> margin = Vec<Dim>::Constant(0.25 * dx);
  const Box<Dim> inside(Vec<Dim>(box.min() + margin), Vec<Dim>(box.max() - margin));
  for (int axis = 0; axis < Dim; ++axis) {
    const double low = box.min()[axis];
    const double high = box.max()[axis];
    std::vector<double> planes{low, high};
    if (const std::vector<double>& range = periodic_range(spec.domain, axis);
        water.shape == BlockShape::fill && range.size() == 2) {
      planes = range;
    } else {
      const std::vector<double> walls = planes_in(boundary, inside, axis, std::pow(min_edge * dx, Dim - 1));
      planes.insert(planes.end(), walls.begin(), walls.end());
      if constexpr (Dim == 2) {
        if (water.shape == BlockShape::polygon) append_flat_sides(outline_of(water, owner), axis, dx, planes);
      } else {
        const auto divide_at = [&](const MeshSurface& mesh) {
          if (!inside.intersects(Box<3>(mesh.low(), mesh.high()))) return;
          for (const double plane : planes_in(mesh.mesh(), axis, dx)) {
            if (plane > inside.min()[axis] && plane < inside.max()[axis]) planes.push_back(plane);
          }
        };
        if (boundary.water[block]) divide_at(*boundary.water[block]);
        for (const WallPlate& plate : boundary.plates) {
          if (plate.sheet) divide_at(*plate.sheet);
        }
      }
    }
    lattice[axis] = LatticeAxis(planes, dx);
  }
  return lattice;
}

template <int Dim>
Lattice<Dim> lattice_behind_meshes(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const bool has_sheet =
      std::ranges::any_of(boundary.plates, [](const WallPlate& plate) { return plate.sheet != nullptr; });
  if ((boundary.meshes.empty() && !has_sheet) || spec.fluid.empty()) return {};
  return make_lattice<Dim>(spec, 0, boundary);
}

TAILWATER_IN_2D_AND_3D(make_lattice);
TAILWATER_IN_2D_AND_3D(lattice_behind_meshes);

}  // namespace tailwater
