#include "results/water_balance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/box.h"
#include "base/for_each.h"
#include "geometry/mesh_surface.h"
#include "neighbours/neighbourhood.h"
#include "open_ends/open_ends.h"
#include "parts/domain_floor.h"

namespace tailwater {
namespace {

/// The first wall below a falling body.
struct Landing {
  double share = std::numeric_limits<double>::infinity();  ///< fraction of the fall at which it meets the wall
  /// m; height of the place above it: positive if it meets the front
  double height = -1.0;
};

template <int Dim>
Landing landing_of(const Boundary<Dim>& boundary, const Vec<Dim>& x, const Vec<Dim>& fall, double tolerance) {
  const Vec<Dim> lowest = x + fall;
  Landing first;
  const auto meets = [&](const WallFace<Dim>& face) {
    // Only the face of a plate that faces x counts.
    if (face.height(x) <= 0.0 && boundary.walls[face.wall].is_plate) return;
    const double share = face.height(x) / (face.height(x) - face.height(lowest));
    if (share < first.share) first = {share, face.height(x)};
  };
  boundary.visit_plain_faces([&](int f) {
    if (crosses(boundary.faces[f], x, lowest, tolerance)) meets(boundary.faces[f]);
  });
  if constexpr (Dim == 3) {
    for (const WallMesh& mesh : boundary.meshes) {
      const Vec<3> drawn = boundary.displacement_of(mesh);
      const int triangle = mesh.surface->first_crossed(x - drawn, lowest - drawn, tolerance);
      if (triangle >= 0) meets(boundary.faces[mesh.first_face + triangle]);
    }
  }
  return first;
}

/// The place and those of its images from which `fall` may lead through the domain: a body that leaves a periodic
/// domain on one side continues at the other.
template <int Dim>
std::vector<Vec<Dim>> images_along(const PeriodicDomain<Dim>& domain, const Vec<Dim>& x, const Vec<Dim>& fall) {
  std::vector<Vec<Dim>> images{x};
  for (int axis = 0; axis < Dim; ++axis) {
    if (!domain[axis]) continue;
    const double period = domain[axis]->second - domain[axis]->first;
    const int count = 1 + static_cast<int>(std::ceil(std::abs(fall[axis]) / period));
    const std::vector<Vec<Dim>> before = images;
    for (const Vec<Dim>& image : before) {
      for (int k = 1; k <= count; ++k) {
        for (const int shift : {-k, k}) images.push_back(image + shift * period * Vec<Dim>::Unit(axis));
      }
    }
  }
  return images;
}

/// Whether water that is beyond the box around the walls falls onto the front of one, as spray above an open tank does.
/// Without gravity, or where the case repeats itself along it, no water leaves for good: true.
template <int Dim>
bool falls_back(const Flow<Dim>& flow, const Box<Dim>& box, const Vec<Dim>& x) {
  const Vec<Dim>& gravity = flow.setup.gravity;
  if (flow.setup.gravity_across().norm() == 0.0) return true;
  const double length = box.exteriorDistance(x) + box.diagonal().norm() + flow.setup.scale.spacing;
  const Vec<Dim> fall = length * gravity.normalized();
  Landing first;
  for (const Vec<Dim>& place : images_along<Dim>(flow.setup.domain, x, fall)) {
    const Landing landing =
        landing_of<Dim>(flow.walls.boundary, place, fall, corner_tolerance * flow.setup.scale.spacing);
    if (landing.share < first.share) first = landing;
  }
  return first.height > 0.0;
}

/// The water of the particles for which `is_counted(particle)`; without its energy. Collective.
template <int Dim, class IsCounted>
WaterAmount water_where(const Flow<Dim>& flow, IsCounted&& is_counted) {
  const Particles<Dim>& particles = flow.state.particles;
  WaterAmount water = sum_over(particles.owned, WaterAmount(), [&](std::size_t i) -> WaterAmount {
    if (!particles.is_fluid(i) || !is_counted(i)) return {};
    const double volume = flow.water_volume_of(i);
    return {1, volume, flow.density_of(i) * volume};
  });
  flow.setup.ranks.sum_each(water.particles, water.volume, water.mass);
  return water;
}

/// Whether owned particle i is water that has left the walls, which are in `box`, for good.
template <int Dim>
bool is_outside(const Flow<Dim>& flow, const Box<Dim>& box, std::size_t i) {
  const Vec<Dim> x = flow.neighbourhood->wrapped(flow.state.particles.position[i]);
  return flow.state.particles.is_fluid(i) && !box.contains(x) && !falls_back(flow, box, x) &&
         !flow.template part<OpenEnds<Dim>>().is_passed_by(x);
}

}  // namespace

std::string text_of(const WaterAmount& water) {
  return fmt::format("{} particles ({:.6g} m^3)", water.particles, water.volume);
}

template <int Dim>
WaterAmount water_in(const Flow<Dim>& flow) {
  return water_where(flow, [](std::size_t) { return true; });
}

template <int Dim>
WaterAmount water_outside(const Flow<Dim>& flow) {
  const Box<Dim> box = flow.box();
  if (box.isEmpty()) return {};
  WaterAmount water = water_where(flow, [&](std::size_t i) { return is_outside(flow, box, i); });
  water += flow.template part<DomainFloor<Dim>>().fallen();
  return water;
}

template <int Dim>
Vec<Dim> place_of_water_outside(const Flow<Dim>& flow) {
  const Box<Dim> box = flow.box();
  const Particles<Dim>& particles = flow.state.particles;
  std::int64_t own = std::numeric_limits<std::int64_t>::max();
  std::vector<double> place(Dim, 0.0);
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: of several, the first counts
    if (particles.id[i] >= own || !is_outside(flow, box, i)) continue;
    own = particles.id[i];
    for (int axis = 0; axis < Dim; ++axis) place[axis] = particles.position[i][axis];
  }
  if (flow.setup.ranks.least(own) != own) place.assign(Dim, 0.0);
  flow.setup.ranks.sum_of_each(place);
  return Vec<Dim>::NullaryExpr([&](int axis) { return place[axis]; });
}

template <int Dim>
WaterAmount water_inside(const Flow<Dim>& flow) {
  WaterAmount water = water_in(flow);
  water += flow.template part<DomainFloor<Dim>>().fallen();
  water -= water_outside(flow);
  return water;
}

template <int Dim>
Json water_balance(const WaterAmount& at_start, const Flow<Dim>& flow) {
  const double density = flow.setup.liquid.density;
  const auto& ends = flow.template part<OpenEnds<Dim>>();
  return {{"start", summary_of(at_start)},
          {"in", summary_of(ends.arrived())},
          {"inside", summary_of(water_inside(flow))},
          {"outside", summary_of(water_outside(flow))},
          {"out", summary_of(ends.departed())},
          {"inlets", ends.balance(OpeningKind::inlet, density)},
          {"outlets", ends.balance(OpeningKind::outlet, density)}};
}

TAILWATER_IN_2D_AND_3D(water_in);
TAILWATER_IN_2D_AND_3D(water_outside);
TAILWATER_IN_2D_AND_3D(place_of_water_outside);
TAILWATER_IN_2D_AND_3D(water_inside);
TAILWATER_IN_2D_AND_3D(water_balance);

}  // namespace tailwater
