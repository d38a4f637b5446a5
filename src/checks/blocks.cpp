#include <cmath>

#include "checks/checks.h"
#include "geometry/from_spec.h"

namespace tailwater {
namespace {

/// `or_else`: another reason why a block that is large enough may hold no particle.
template <int Dim>
Finding inside_walls(const CaseLabel& label, const Vec<Dim>& at, double dx, const char* or_else) {
  return Finding::error("block-inside-walls",
                        {"{} at {} holds no particle of spacing {:.6g} m: {}all of it is in walls and bodies", label,
                         place(at), dx, or_else},
                        {"move the block, or give the wall around it the other fluid_side"});
}

template <int Dim>
void check_polygon(const FluidTable& block, const CaseLabel& label, double particles, double dx, Findings& findings) {
  const double area = std::abs(signed_area(block.points));
  if (area >= 0.5 * dx * dx) {
    if (particles > 0.0) return;
    findings.push_back(inside_walls<Dim>(label, to_vec<Dim>(block.points[0], label, "points[0]"), dx,
                                         "the block is thinner than the spacing, or "));
    return;
  }
  findings.push_back(
      Finding::error("block-area-too-small",
                     {"{} at {} holds no particle: its area is {:.3g} and the spacing is {:.6g} m", label,
                      place(to_vec<Dim>(block.points[0], label, "points[0]")), Amount{area, "m^2"}, dx},
                     {"use a smaller spacing, or correct the block's points"}));
}

template <int Dim>
void check_box(const FluidTable& block, const CaseLabel& label, double particles, double dx, Findings& findings) {
  const Vec<Dim> low = to_vec<Dim>(block.min, label, "min");
  const Vec<Dim> extent = to_vec<Dim>(block.max, label, "max") - low;
  int smallest = 0;
  extent.minCoeff(&smallest);
  const bool is_thin = extent[smallest] < (1.0 - corner_tolerance) * dx;
  if (particles == 0.0 && !is_thin) findings.push_back(inside_walls<Dim>(label, low, dx, ""));
  if (is_thin) {
    findings.push_back(Finding::error("block-thinner-than-spacing",
                                      {"{} at {} is {:.6g} long in {}, so it holds no particle of spacing {:.6g} m",
                                       label, place(low), Amount{extent[smallest], "m"}, "xyz"[smallest], dx},
                                      {"use a spacing of at most {:.6g} m, or a larger block", extent[smallest]}));
  }
}

template <int Dim>
void check_mesh(const FluidTable& block, const CaseLabel& label, double particles, double dx, Findings& findings) {
  if (particles > 0.0) return;
  findings.push_back(
      Finding::error("block-mesh-too-small",
                     {"{} holds no particle of spacing {:.6g} m in the mesh of {}: it is too small, or all of it is in "
                      "walls and bodies",
                      label, dx, block.file},
                     {"use a smaller spacing, or move it (translate)"}));
}

template <int Dim>
void check_fill(const FluidTable& block, const CaseLabel& label, double particles, double dx, Findings& findings) {
  if (particles > 0.0) return;
  findings.push_back(Finding::error("fill-too-small",
                                    {"{} holds no particle of spacing {:.6g} m between the walls around its seed {}",
                                     label, dx, place(to_vec<Dim>(block.seed, label, "seed"))},
                                    {"use a smaller spacing, or move the seed"}));
}

}  // namespace

template <int Dim>
Findings check_blocks(const CaseSpec& spec, const FluidParticles<Dim>& fluid) {
  if (spec.fluid.empty() && spec.inlets.empty() && std::ranges::none_of(spec.outlets, may_bring_water)) {
    return {Finding::error("no-fluid", {"there is no fluid"},
                           {"add a [[fluid]] or an [[inlet]] table, or the level of an [[outlet]]"})};
  }
  std::vector<double> particles(spec.fluid.size(), 0.0);
  for (const int block : fluid.block) particles[block] += 1.0;
  fluid.ranks.sum_of_each(particles);
  Findings findings;
  for (std::size_t b = 0; b < spec.fluid.size(); ++b) {
    const BlockShape shape = spec.fluid[b].shape;
    const auto check = shape == BlockShape::polygon ? check_polygon<Dim>
                       : shape == BlockShape::fill  ? check_fill<Dim>
                       : shape == BlockShape::mesh  ? check_mesh<Dim>
                                                    : check_box<Dim>;
    check(spec.fluid[b], fluid_label(spec, b), particles[b], spec.particles.spacing, findings);
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_blocks);

}  // namespace tailwater
