#include <algorithm>
#include <limits>

#include "checks/checks.h"
#include "motion/wave_maker.h"

namespace tailwater {
namespace {

constexpr double reach = 4.0;         // dx, in front of a plate, where the water is looked at
constexpr double most_error = 0.1;    // of the depth
constexpr double most_columns = 1.0;  // dx; of the same

/// Height [m] of the water in front of a plate above its foot, over all ranks; none where there is no water.
template <int Dim>
std::optional<double> depth_at(const WavePlate<Dim>& plate, const FluidParticles<Dim>& fluid, double dx) {
  constexpr double none = -std::numeric_limits<double>::infinity();
  double highest = none;
  for (const Vec<Dim>& x : fluid.position) {
    const double ahead = plate.forward.dot(x - plate.foot);
    const bool is_beside = Dim == 3 && std::abs(plate.along.dot(x - plate.foot)) > 0.5 * plate.width;
    if (ahead < 0.0 || ahead > reach * dx || is_beside) continue;
    highest = std::max(highest, plate.up.dot(x - plate.foot) + 0.5 * dx);
  }
  highest = fluid.ranks.largest(highest);
  return highest > none ? std::optional(highest) : std::nullopt;
}

/// Waves that the particles do not resolve.
Findings check_height(const WaveMakerTable& maker, double dx) {
  if (maker.waves == WaveKind::none || maker.height >= lowest_resolved_wave * dx) return {};
  return {Finding::warning(
      {"{} = {:.4g} is {:.2g} spacings: waves lower than {:g} spacings are not resolved, and their heights are not to "
       "be trusted",
       CaseLabel("wave_maker", maker.name).with_key("height"), Amount{maker.height, "m"}, maker.height / dx,
       lowest_resolved_wave},
      {"use a spacing of at most {:.3g} m, better a tenth of the height", 0.99 * maker.height / lowest_resolved_wave})};
}

}  // namespace

template <int Dim>
Findings check_wave_makers(const CaseSpec& spec, const FluidParticles<Dim>& fluid) {
  Findings findings;
  const double dx = spec.particles.spacing;
  for (const WaveMakerTable& maker : spec.wave_makers) {
    append(findings, check_height(maker, dx));
    const std::optional<double> depth = depth_at(WavePlate<Dim>(spec, maker), fluid, dx);
    if (!depth || std::abs(*depth - maker.depth) <= std::max(most_error * maker.depth, most_columns * dx)) continue;
    findings.push_back(
        Finding::error({"{} = {:.4g}, but the water in front of it is {:.4g} m deep at the start: its waves would not "
                        "have the prescribed height",
                        CaseLabel("wave_maker", maker.name).with_key("depth"), Amount{maker.depth, "m"}, *depth},
                       {"correct depth or the water"}));
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_wave_makers);

}  // namespace tailwater
