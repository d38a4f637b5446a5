#include <algorithm>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "base/box.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/point_grid.h"
#include "parallel/at_start.h"

namespace tailwater {

namespace {

template <int Dim>
struct Candidate {
  Vec<Dim> position;
  int block;
};
template <int Dim>
using CandidateList = std::vector<Candidate<Dim>>;

/// The particles of all ranks that are nearer than `distance` (m) to the box around another block, in their order.
template <int Dim>
CandidateList<Dim> particles_in_other_boxes(const CaseSpec& spec, const FluidParticles<Dim>& fluid, double distance) {
  std::vector<Box<Dim>> boxes(spec.fluid.size());
  for (std::size_t i = 0; i < fluid.position.size(); ++i) boxes[fluid.block[i]].extend(fluid.position[i]);
  const std::vector<Box<Dim>> of_ranks = gather_on_all(fluid.ranks, boxes);
  for (std::size_t k = 0; k < of_ranks.size(); ++k) {
    if (!of_ranks[k].isEmpty()) boxes[k % boxes.size()].extend(of_ranks[k]);
  }
  CandidateList<Dim> own;
  for (std::size_t i = 0; i < fluid.position.size(); ++i) {
    const auto block = static_cast<std::size_t>(fluid.block[i]);
    bool is_near = false;
    for (std::size_t b = 0; b < boxes.size(); ++b) {
      is_near = is_near || (b != block && !boxes[b].isEmpty() &&
                            boxes[b].squaredExteriorDistance(fluid.position[i]) <= distance * distance);
    }
    if (is_near) own.push_back({fluid.position[i], fluid.block[i]});
  }
  return gather_on_all(fluid.ranks, own);
}

}  // namespace

template <int Dim>
Findings check_overlap(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  if (spec.fluid.size() < 2) return {};
  // Particles of neighbouring blocks are dx apart, less the jitter of both.
  const double least = std::min(0.5, 1.0 - 2.0 * spec.particles.jitter) * spec.particles.spacing;
  const CandidateList<Dim> candidates = particles_in_other_boxes(spec, fluid, least);
  PointGrid<Dim> grid(least * (1.0 - corner_tolerance));
  struct Overlap {
    std::size_t particles = 0;
    Vec<Dim> where;
  };
  std::map<std::pair<int, int>, Overlap> overlaps;  // by blocks
  for (const auto& candidate : candidates) {
    int other = -1;
    const std::span<const int> screens = boundary.screens_near(candidate.position, least);
    grid.visit_near(candidate.position, [&](int j) {
      const auto& [position, block] = candidates[j];
      if (block == candidate.block) return;
      if (!is_hidden<Dim>(boundary.screens, screens, position, candidate.position)) other = block;
    });
    grid.add(candidate.position);
    if (other < 0) continue;
    Overlap& overlap = overlaps[{other, candidate.block}];
    if (overlap.particles++ == 0) overlap.where = candidate.position;
  }
  Findings findings;
  for (const auto& [blocks, overlap] : overlaps) {
    findings.push_back(
        Finding::error("blocks-overlap",
                       {"{} and {} overlap, first at {}: {} particles of the second are nearer than {:.6g} m to "
                        "particles of the first",
                        fluid_label(spec, blocks.first), fluid_label(spec, blocks.second), place(overlap.where),
                        overlap.particles, least},
                       {"move the blocks apart, or leave their common part out of one of them"}));
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_overlap);

}  // namespace tailwater
