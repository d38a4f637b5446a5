#include "parts/wave_makers.h"

#include <cmath>

#include "base/for_each.h"
#include "flow/flow.h"

namespace tailwater {
namespace {

/// The depth [m] in front of a plate whose face crosses the still water's level at `face`: the water under a tent
/// around the gauge, which is as wide to each side as the gauge is far from the plate. A tent of whole lattice columns
/// counts a lattice exactly wherever it stands.
template <int Dim>
double depth_before(const WavePlate<Dim>& plate, const Vec<Dim>& face, const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  const double volume = sum_over(particles.owned, 0.0, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return 0.0;
    const Vec<Dim> x = particles.position[i] - face;
    const double off = std::abs(plate.forward.dot(x) - plate.gauge);
    if (off >= plate.gauge || (Dim == 3 && std::abs(plate.along.dot(x)) > 0.5 * plate.width)) return 0.0;
    return (1.0 - off / plate.gauge) * particles.volume[i];
  });
  return flow.setup.ranks.sum(volume) / (plate.gauge * plate.width);
}

}  // namespace

template <int Dim>
void WaveMakers<Dim>::begin_step(Flow<Dim>& flow, double dt) {
  if (dt == 0.0) return;  // no plate moves
  const double time = flow.state.time;
  for (std::size_t m = 0; m < plates_.size(); ++m) {
    const WavePlate<Dim>& plate = plates_[m];
    if (!plate.absorbs) continue;
    MakerState& maker = flow.state.motion.wave_makers[m];
    maker.correction = maker.at(time);
    maker.time = time;
    const Vec<Dim> face = plate.foot + plate.stroke(time, maker) * plate.forward;
    const double elevation = depth_before(plate, face, flow) - plate.depth;
    maker.rate = plate.law.gain() * (plate.law.elevation(time) - elevation) - plate.law.forgetting() * maker.correction;
  }
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_wave_makers(const CaseSpec& spec, const Setup<Dim>& /*setup*/,
                                            const Boundary<Dim>& /*boundary*/) {
  if (spec.wave_makers.empty()) return nullptr;
  std::vector<WavePlate<Dim>> plates;
  for (const WaveMakerTable& maker : spec.wave_makers) plates.emplace_back(spec, maker);
  return std::make_unique<WaveMakers<Dim>>(std::move(plates));
}

template class WaveMakers<2>;
template class WaveMakers<3>;
TAILWATER_IN_2D_AND_3D(make_wave_makers);

}  // namespace tailwater
