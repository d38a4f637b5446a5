#include <cmath>

#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"

namespace tailwater {
namespace {

/// dx. The law of rough walls (closures/wall_law.h) has no velocity up to k_s/30 from the wall, and the first particles
/// stand dx/2 from it. Above this limit they would be in the range without flow.
constexpr double largest_over_spacing = 15.0;

/// Text with k_s, and with Manning's n if the wall has that.
Clause roughness_text(const WallTable& wall, double roughness) {
  if (wall.manning == 0.0) return {"its roughness k_s = {:.3g}", Amount{roughness, "m"}};
  return {"its roughness k_s = {:.3g}, from manning = {:.6g} s/m^(1/3),", Amount{roughness, "m"}, wall.manning};
}

/// The largest value of the key for this roughness, as a remedy, rounded so that it does not exceed the bound.
std::string bound_on_key(const WallTable& wall, double roughness, double bound) {
  const double largest = 0.99 * bound;
  if (wall.manning == 0.0) return fmt::format("a roughness of at most {:.3g} m", largest);
  return fmt::format("manning = {:.3g} or less", wall.manning * std::pow(largest / roughness, 1.0 / 6.0));
}

/// Height [m] of all water along gravity, which the water cannot exceed for long without inflow; 0: unknown.
template <int Dim>
double height_without_inflow(const CaseSpec& spec, const FluidParticles<Dim>& fluid) {
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  const bool is_open = !spec.inlets.empty() || !spec.outlets.empty();
  if (gravity.norm() == 0.0 || is_open || fluid.all == 0) return 0.0;
  return fluid.extent_along(gravity.normalized()) + spec.particles.spacing;
}

Finding too_rough(const CaseLabel& label, const WallTable& wall, double roughness, double largest, Clause why) {
  return Finding::error(
      "roughness-too-large", {"{}: {} {}", label, roughness_text(wall, roughness), why},
      {"give {}, and draw larger roughness elements as the shape of the wall", bound_on_key(wall, roughness, largest)});
}

/// Checks the side walls, whose law is a mean over half of the width.
Findings check_side_walls(const PhysicsTable& physics) {
  const double half = 0.5 * physics.channel_width;
  if (half == 0.0 || physics.channel_roughness <= half) return {};
  return {
      Finding::error("channel-roughness-too-large",
                     {"{} = {:.3g} is larger than half of the channel's width, {:.3g} m, so the law of rough walls "
                      "does not hold",
                      CaseLabel("physics").with_key("channel_roughness"), Amount{physics.channel_roughness, "m"}, half},
                     {"give a roughness of at most {:.3g} m", half})};
}

}  // namespace

template <int Dim>
Findings check_roughness(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  const double dx = spec.particles.spacing;
  const double depth = height_without_inflow(spec, fluid);
  Findings findings = check_side_walls(spec.physics);
  for (std::size_t w = 0; w < boundary.walls.size(); ++w) {
    const double roughness = boundary.walls[w].roughness;
    if (boundary.walls[w].friction == 0.0 || roughness <= dx) continue;
    const WallTable& wall = spec.walls[w];
    const CaseLabel label = wall_label(boundary, static_cast<int>(w));
    if (roughness > largest_over_spacing * dx) {
      const Clause why{
          "is more than {:g} spacings of {:.3g} m: up to k_s/30 = {:.3g} m from the wall, where the first "
          "particles stand, the law of rough walls has no flow",
          largest_over_spacing, dx, roughness / 30.0};
      findings.push_back(too_rough(label, wall, roughness, largest_over_spacing * dx, why));
    } else if (depth > 0.0 && roughness > depth) {
      const Clause why{"is larger than the water is deep, {:.3g} m, and the law of rough walls ends there", depth};
      findings.push_back(too_rough(label, wall, roughness, depth, why));
    } else {
      findings.push_back(
          Finding::warning("roughness-above-spacing",
                           {"{}: {} is larger than the spacing, {:.3g} m, and the law of rough walls does not hold for "
                            "particles between its grains",
                            label, roughness_text(wall, roughness), dx},
                           {"use a larger spacing, or draw the largest elements and give the roughness of the rest"}));
    }
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_roughness);

}  // namespace tailwater
