#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "base/box.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/images.h"
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

/// Whether an image of a box in another period is nearer than `distance` (m) to a place, along each axis.
template <int Dim>
bool is_near_image(const PeriodicDomain<Dim>& domain, const Box<Dim>& box, const Vec<Dim>& x, double distance) {
  bool is_in_other_period = false;
  for (int axis = 0; axis < Dim; ++axis) {
    const double below = x[axis] - distance - box.max()[axis];
    const double above = x[axis] + distance - box.min()[axis];
    if (!domain[axis]) {
      if (below > 0.0 || above < 0.0) return false;
      continue;
    }
    const double length = domain[axis]->second - domain[axis]->first;
    const double from = std::ceil(below / length);
    const double to = std::floor(above / length);
    if (from > to) return false;
    is_in_other_period = is_in_other_period || from != 0.0 || to != 0.0;
  }
  return is_in_other_period;
}

/// The particles of all ranks that are nearer than `distance` (m) to the box around another block, or to an image of
/// the box around any block, in their order.
template <int Dim>
CandidateList<Dim> particles_in_other_boxes(const CaseSpec& spec, const PeriodicDomain<Dim>& domain,
                                            const FluidParticles<Dim>& fluid, double distance) {
  std::vector<Box<Dim>> boxes(spec.fluid.size());
  for (std::size_t i = 0; i < fluid.position.size(); ++i) boxes[fluid.block[i]].extend(fluid.position[i]);
  const std::vector<Box<Dim>> of_ranks = gather_on_all(fluid.ranks, boxes);
  for (std::size_t k = 0; k < of_ranks.size(); ++k) {
    if (!of_ranks[k].isEmpty()) boxes[k % boxes.size()].extend(of_ranks[k]);
  }
  CandidateList<Dim> own;
  for (std::size_t i = 0; i < fluid.position.size(); ++i) {
    const Vec<Dim>& x = fluid.position[i];
    const auto block = static_cast<std::size_t>(fluid.block[i]);
    bool is_near = false;
    for (std::size_t b = 0; b < boxes.size() && !is_near; ++b) {
      if (boxes[b].isEmpty()) continue;
      is_near = (b != block && boxes[b].squaredExteriorDistance(x) <= distance * distance) ||
                is_near_image<Dim>(domain, boxes[b], x, distance);
    }
    if (is_near) own.push_back({x, fluid.block[i]});
  }
  return gather_on_all(fluid.ranks, own);
}

template <int Dim>
struct Overlap {
  std::size_t particles = 0;
  Vec<Dim> where;
  bool is_through_period = true;  ///< the blocks are apart as drawn
};

template <int Dim>
Finding overlap_finding(const Overlap<Dim>& overlap, const CaseLabel& first, const CaseLabel& second, double least) {
  return Finding::error("blocks-overlap",
                        {"{} and {} overlap{}, first at {}: {} particles of the second are nearer than {:.6g} m to "
                         "particles of the first",
                         first, second, overlap.is_through_period ? " through the period" : "", place(overlap.where),
                         overlap.particles, least},
                        {"move the blocks apart, or leave their common part out of one of them"});
}

template <int Dim>
Finding overlap_finding(const Overlap<Dim>& overlap, const CaseLabel& block, double least) {
  return Finding::error("block-overlaps-itself",
                        {"{} overlaps itself through the period, first at {}: {} of its particles are nearer than "
                         "{:.6g} m to images of others",
                         block, place(overlap.where), overlap.particles, least},
                        {"make the block at most one period long"});
}

}  // namespace

template <int Dim>
Findings check_overlap(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  const PeriodicDomain<Dim>& domain = boundary.domain;
  const bool is_periodic = std::ranges::any_of(domain, [](const auto& range) { return range.has_value(); });
  if (spec.fluid.size() < 2 && !is_periodic) return {};
  // Particles of neighbouring blocks are dx apart, less the jitter of both.
  const double least = std::min(0.5, 1.0 - 2.0 * spec.particles.jitter) * spec.particles.spacing;
  const CandidateList<Dim> candidates = particles_in_other_boxes<Dim>(spec, domain, fluid, least);
  const double radius = least * (1.0 - corner_tolerance);
  const Box<Dim> space = space_around<Dim>(domain, least);
  PointGrid<Dim> grid(radius);                           // inside the domain
  std::map<std::pair<int, int>, Overlap<Dim>> overlaps;  // by blocks
  for (const auto& candidate : candidates) {
    int other = -1;
    bool is_apart = false;
    const Vec<Dim> inside = wrapped<Dim>(domain, candidate.position);
    const auto look_from = [&](const Vec<Dim>& x) {
      const std::span<const int> screens = boundary.screens_near(x, least);
      grid.visit_near(x, [&](int j) {
        const auto& [position, block] = candidates[j];
        const bool are_apart = (position - candidate.position).norm() >= radius;
        if (block == candidate.block && !are_apart) return;
        if (is_hidden<Dim>(boundary.screens, screens, wrapped<Dim>(domain, position), x)) return;
        other = block;
        is_apart = are_apart;
      });
    };
    look_from(inside);
    visit_images<Dim>(domain, Box<Dim>(inside), space, [&](const Vec<Dim>& by) { look_from(inside + by); });
    grid.add(inside);
    if (other < 0) continue;
    Overlap<Dim>& overlap = overlaps[{other, candidate.block}];
    if (overlap.particles++ == 0) overlap.where = candidate.position;
    overlap.is_through_period = overlap.is_through_period && is_apart;
  }
  Findings findings;
  for (const auto& [blocks, overlap] : overlaps) {
    const CaseLabel first = fluid_label(spec, blocks.first);
    findings.push_back(blocks.first == blocks.second
                           ? overlap_finding(overlap, first, least)
                           : overlap_finding(overlap, first, fluid_label(spec, blocks.second), least));
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_overlap);

}  // namespace tailwater
