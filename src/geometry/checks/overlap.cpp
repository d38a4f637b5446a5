#include <algorithm>
#include <map>
#include <utility>

#include "geometry/checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/point_grid.h"

namespace tailwater {

template <int Dim>
Findings check_overlap(const CaseSpec& spec, const FluidParticles<Dim>& fluid) {
  if (spec.fluid.size() < 2) return {};
  // Particles of neighbouring blocks are dx apart, less the jitter of both.
  const double least = std::min(0.5, 1.0 - 2.0 * spec.particles.jitter) * spec.particles.spacing;
  PointGrid<Dim> grid(least * (1.0 - corner_tolerance));
  struct Overlap {
    std::size_t particles = 0;
    Vec<Dim> where;
  };
  std::map<std::pair<int, int>, Overlap> overlaps;  // by blocks
  for (std::size_t i = 0; i < fluid.position.size(); ++i) {
    int other = -1;
    grid.visit_near(fluid.position[i], [&](int j) {
      if (fluid.block[j] != fluid.block[i]) other = fluid.block[j];
    });
    grid.add(fluid.position[i]);
    if (other < 0) continue;
    Overlap& overlap = overlaps[{other, fluid.block[i]}];
    if (overlap.particles++ == 0) overlap.where = fluid.position[i];
  }
  Findings findings;
  for (const auto& [blocks, overlap] : overlaps) {
    findings.push_back(Finding::error(
        "{} and {} overlap, first at {}: {} particles of the second are nearer than {:.6g} m to particles of the "
        "first; move the blocks apart, or leave their common part out of one of them",
        fluid_label(spec, blocks.first), fluid_label(spec, blocks.second), place(overlap.where), overlap.particles,
        least));
  }
  return findings;
}

template Findings check_overlap(const CaseSpec&, const FluidParticles<2>&);
template Findings check_overlap(const CaseSpec&, const FluidParticles<3>&);

}  // namespace tailwater
