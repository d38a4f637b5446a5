#include "sampling/particle_count.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/box.h"
#include "base/vec.h"
#include "case/formulation.h"
#include "geometry/from_spec.h"
#include "geometry/mesh_surface.h"
#include "sampling/wall_particles.h"

namespace tailwater {

template <int Dim>
ParticleCount expected_particle_count(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const double dx = spec.particles.spacing;
  ParticleCount count;
  for (std::size_t b = 0; b < spec.fluid.size(); ++b) {
    const FluidTable& block = spec.fluid[b];
    const CaseLabel label = fluid_label(spec, b);
    if (block.shape == BlockShape::polygon) {
      count.fluid += block.points.empty() ? 0.0 : std::abs(signed_area(block.points)) / power<Dim>(dx);
    } else if (block.shape == BlockShape::fill) {
      // At most: the box around the walls up to the level.
      Box<Dim> box = box_around(boundary.faces);
      if (box.isEmpty()) continue;
      box.max()[Dim - 1] = std::min(box.max()[Dim - 1], block.level);
      count.fluid += std::max(box.volume(), 0.0) / power<Dim>(dx);  // below 0 with a level below the walls
    } else if (Dim == 3 && block.shape == BlockShape::mesh) {
      if constexpr (Dim == 3) {
        count.fluid += six_volumes(boundary.water[b]->mesh(), [](int) { return true; }) / 6.0 / power<Dim>(dx);
      }
    } else {
      const Vec<Dim> extent = to_vec<Dim>(block.max, label, "max") - to_vec<Dim>(block.min, label, "min");
      count.fluid += (extent / dx).each([](double steps) { return std::max(1.0, std::round(steps)); }).prod();
    }
  }
  const int layers = traits_of(spec).walls.behind ? dummy_layers(spec) : 1;
  for (const WallFace<Dim>& face : boundary.faces) count.wall += layers * face.measure() * dx / power<Dim>(dx);
  return count;
}

TAILWATER_IN_2D_AND_3D(expected_particle_count);

}  // namespace tailwater
