#include "bodies/covered_walls.h"

#include <algorithm>

namespace tailwater {
namespace {

/// Where bodies are, as boxes that hold all that they may cover.
template <int Dim>
std::vector<Eigen::AlignedBox<double, Dim>> boxes_around(const FloatingBodies<Dim>& bodies, double spacing,
                                                         const std::vector<AffineMap<Dim>>& placement) {
  std::vector<Eigen::AlignedBox<double, Dim>> boxes(placement.size());
  const double margin = (reach_behind_walls + widest_cover) * spacing;
  for (std::size_t b = 0; b < placement.size(); ++b) {
    for (const Vec<Dim>& point : bodies.contact.points[b]) boxes[b].extend(placement[b](point));
    boxes[b].min().array() -= margin;
    boxes[b].max().array() += margin;
  }
  return boxes;
}

/// How far a place in front of a wall is inside a body: 1 if it is deep inside, 0 if it is well outside.
template <int Dim>
double share_inside(const ContactSurface<Dim>& surface, const AffineMap<Dim>& placement, const Vec<Dim>& x,
                    double width, double reach) {
  const NearestWall<Dim> hull = surface.boundary.nearest(placement.inverse(x), reach);
  return hull.face < 0 ? 0.0 : std::clamp(0.5 - hull.signed_distance / width, 0.0, 1.0);
}

}  // namespace

template <int Dim>
std::vector<CoveredParticle<Dim>> find_covered(const Flow<Dim>& flow, const FloatingBodies<Dim>& bodies, double time) {
  std::vector<CoveredParticle<Dim>> covered;
  const Setup<Dim>& setup = flow.setup;
  const Particles<Dim>& particles = flow.state.particles;
  const double width = widest_cover * setup.scale.spacing;
  std::vector<AffineMap<Dim>> placement;
  for (const BodyState<Dim>& body : flow.state.motion.bodies.each) placement.push_back(body.at(time));
  const std::vector<Eigen::AlignedBox<double, Dim>> boxes = boxes_around(bodies, setup.scale.spacing, placement);
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: few are covered
    if (particles.is_fluid(i) || !flow.surroundings.is_wet[i]) continue;
    const auto row = particles.wall_row[i];
    const Vec<Dim>& x = flow.walls.particles.position[row];
    if (std::ranges::none_of(boxes, [&](const auto& box) { return box.contains(x); })) continue;
    if (flow.walls.boundary.walls[flow.walls.particles.wall[row]].moves()) continue;
    const NearestWall<Dim> wall =
        bodies.contact.each.front().boundary.nearest(x, reach_behind_walls * setup.scale.spacing);
    if (wall.face < 0 || wall.signed_distance >= 0.0) continue;
    const Vec<Dim> normal = (x - wall.point) / wall.signed_distance;
    const Vec<Dim> in_front = wall.point + 0.5 * width * normal;
    for (const ContactSurface<Dim>& surface : bodies.contact.each) {
      if (surface.body < 0 || !boxes[surface.body].contains(x)) continue;
      const double share =
          share_inside(surface, placement[surface.body], in_front, width, contact_reach * setup.scale.spacing);
      if (share > 0.0) covered.push_back({i, surface.body, normal, share});
    }
  }
  return covered;
}

TAILWATER_IN_2D_AND_3D(find_covered);

}  // namespace tailwater
