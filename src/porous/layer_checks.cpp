#include "porous/layer_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/box.h"
#include "base/finding.h"
#include "case/formulation.h"
#include "geometry/ducts.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"
#include "motion/floating_body.h"
#include "porous/porous_region.h"

namespace tailwater {
namespace {

/// Throws CaseError where a layer reaches beyond an opening through which it does not continue. The border of a layer
/// that ends at the opening is as wide as the kernel's support.
template <int Dim>
void require_open_ends_in_open_water(const CaseSpec& spec, const Boundary<Dim>& boundary,
                                     const PorousField<Dim>& field) {
  const double dx = spec.particles.spacing;
  const double border = traits_of(spec).support * dx;
  const double zone = duct_length(spec) - border;
  for (const Opening<Dim>& opening : make_open_ends<Dim>(spec)) {
    const bool continues = std::ranges::any_of(boundary.ducts, [&](const Duct<Dim>& duct) {
      return duct.mouth.kind == opening.kind && duct.mouth.name == opening.name && !has_lead(spec, duct);
    });
    if (continues) continue;
    double points = std::ceil(zone / dx);
    for (const Vec<Dim>& edge : opening.edges) points *= std::ceil(edge.norm() / dx);
    for (double k = 0.0; k < points; ++k) {
      double rest = k;
      const auto next_share = [&](double length) {
        const double count = std::ceil(length / dx);
        const double share = (std::fmod(rest, count) + 0.5) / count;
        rest = std::floor(rest / count);
        return share;
      };
      Vec<Dim> x = opening.corner + (border + next_share(zone) * zone) * opening.normal;
      for (const Vec<Dim>& edge : opening.edges) x += next_share(edge.norm()) * edge;
      if (field.porosity_at(x) == 1.0) continue;
      throw CaseError(
          "porous-layer-beyond-opening",
          {"{}: a porous layer is at {}, beyond the opening, where water enters and leaves as in open water",
           opening.label(), place<Dim>(x)},
          {"end the layer at the opening"});
    }
  }
}

/// Throws CaseError for a layer that no water of the case can reach, or whose grains are larger than it.
template <int Dim>
void require_layers_in_case(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  Box<Dim> box = box_around(boundary.faces);
  if (box.isEmpty()) return;
  for (const Opening<Dim>& opening : make_open_ends<Dim>(spec)) box.extend(box_around(opening.as_faces()));
  for (const FluidTable& water : spec.fluid) {  // over a bed without walls beside it
    for (const Coordinates& corner : {water.min, water.max}) {
      if (!corner.empty()) box.extend(Vec<Dim>::Map(corner.data()));
    }
  }
  for (const PorousTable& table : spec.porous) {
    const Box<Dim> layer = PorousRegion<Dim>(spec, table).box();
    if (table.grain_size > layer.sizes().minCoeff()) {
      throw CaseError("porous-grains-too-large",
                      {"{} = {:g} is larger than the thickness of the layer, {:.4g}",
                       CaseLabel("porous", table.name).with_key("grain_size"), Amount{table.grain_size, "m"},
                       Amount{layer.sizes().minCoeff(), "m"}},
                      {"give the size of the grains in metres"});
    }
    if (box.intersects(layer)) continue;
    throw CaseError("porous-layer-outside-walls",
                    {"{} reaches from {} to {}, outside of the walls, and of the water, which are between {} and {}",
                     CaseLabel("porous", table.name), place<Dim>(layer.min()), place<Dim>(layer.max()),
                     place<Dim>(box.min()), place<Dim>(box.max())},
                    {"move it"});
  }
}

/// The volume [m^Dim] that the faces of these walls enclose; they face the water outside.
template <int Dim>
double volume_of(const Boundary<Dim>& boundary, const std::vector<int>& walls, const Vec<Dim>& about) {
  double volume = 0.0;
  for (int f = 0; f < static_cast<int>(boundary.faces.size()); ++f) {
    const WallFace<Dim>& face = boundary.faces[f];
    if (std::ranges::find(walls, face.wall) == walls.end()) continue;
    volume += face.measure() * face.normal.dot(face.corners[0] - about) / Dim;
  }
  return volume;
}

/// [m]; depth below x at which a layer begins: 0 in the layer, infinite if the next wall below is above it.
template <int Dim>
double way_to_layer(const PorousRegion<Dim>& region, const Boundary<Dim>& boundary, const std::vector<int>& own,
                    const Vec<Dim>& x, const Vec<Dim>& down, double spacing) {
  const double step = 0.5 * spacing;  // so deep a body may stand in the layer on which it is drawn
  const Box<Dim>& box = region.box();
  const double farthest = down.isZero(0.0) ? 0.0 : (box.center() - x).norm() + box.diagonal().norm();
  for (double way = 0.0; way <= farthest; way += step) {
    const Vec<Dim> there = x + way * down;
    if (box.contains(there) && region.depth_inside(there, spacing) > step) return way;
    const NearestWall<Dim> wall = boundary.nearest(there, step);
    if (wall.face >= 0 && std::ranges::find(own, boundary.faces[wall.face].wall) == own.end()) break;
  }
  return std::numeric_limits<double>::infinity();
}

/// Throws CaseError for a body that is drawn in a layer, or sinks to one: stones do not hold bodies.
template <int Dim>
void require_bodies_off_layers(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  for (const FloatingBody<Dim>& body : make_bodies<Dim>(spec)) {
    const bool is_held = !body.springs.isZero(0.0) || std::ranges::any_of(spec.moorings, [&](const MooringTable& line) {
      return std::ranges::find(line.bodies, body.name) != line.bodies.end();
    });
    bool sinks = !is_held && body.mass > spec.physics.density * volume_of(boundary, body.walls, body.drawn.centre);
    for (int axis = 0; axis < Dim; ++axis) {
      sinks = sinks && (gravity[axis] == 0.0 || std::ranges::find(body.free, axis) != body.free.end());
    }
    const Vec<Dim> down = sinks && !gravity.isZero(0.0) ? gravity.normalized() : Vec<Dim>(Vec<Dim>::Zero());
    for (const PorousTable& table : spec.porous) {
      const PorousRegion<Dim> region(spec, table);
      double way = std::numeric_limits<double>::infinity();
      for (const WallFace<Dim>& face : boundary.faces) {
        if (std::ranges::find(body.walls, face.wall) == body.walls.end()) continue;
        for (const Vec<Dim>& corner : face.corners) {
          way = std::min(way, way_to_layer(region, boundary, body.walls, corner, down, spec.particles.spacing));
        }
      }
      if (way == 0.0) {
        throw CaseError("body-in-porous-layer",
                        {"{} is drawn in {}: the stones of a layer do not hold bodies, which pass through them",
                         CaseLabel("body", body.name), CaseLabel("porous", table.name)},
                        {"draw the body outside of the layer, or the surface of the layer as a wall"});
      }
      if (way == std::numeric_limits<double>::infinity()) continue;
      throw CaseError("body-sinks-to-porous-layer",
                      {"{} is heavy and sinks to {}: the stones of a layer do not hold bodies, which pass through them",
                       CaseLabel("body", body.name), CaseLabel("porous", table.name)},
                      {"draw the surface of the layer as a wall, or hold the body with a mooring or `free`"});
    }
  }
}

/// Throws CaseError for a layer at a wall that moves, as in a tank that is shaken: layers do not move.
template <int Dim>
void require_layers_off_moving_walls(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  for (const PorousTable& table : spec.porous) {
    const Box<Dim> layer = PorousRegion<Dim>(spec, table).box();
    for (const WallFace<Dim>& face : boundary.faces) {
      const bool moves = boundary.walls[face.wall].moves() && spec.walls[face.wall].drive.by == Drive::By::wall;
      if (!moves || !face.box().intersects(layer)) continue;
      throw CaseError("porous-layer-at-moving-wall",
                      {"{} lies at {}, which moves, and layers stay where they are drawn",
                       CaseLabel("porous", table.name), wall_label(boundary, face.wall)},
                      {"leave out the motion, or end the layer before the wall"});
    }
  }
}

}  // namespace

template <int Dim>
void require_sound_layers(const CaseSpec& spec, const Boundary<Dim>& boundary, const PorousField<Dim>& field) {
  require_layers_in_case(spec, boundary);
  require_open_ends_in_open_water(spec, boundary, field);
  require_bodies_off_layers(spec, boundary);
  require_layers_off_moving_walls(spec, boundary);
}

TAILWATER_IN_2D_AND_3D(require_sound_layers);

}  // namespace tailwater
