#include <cmath>

#include "base/for_each.h"
#include "flow/stages.h"

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
void steer_wave_makers(Flow<Dim>& flow) {
  const double time = flow.state.time;
  for (std::size_t m = 0; m < flow.setup.wave_plates.size(); ++m) {
    const WavePlate<Dim>& plate = flow.setup.wave_plates[m];
    if (!plate.absorbs) continue;
    MakerState& maker = flow.state.motion.wave_makers[m];
    maker.correction = maker.at(time);
    maker.time = time;
    const Vec<Dim> face = plate.foot + plate.stroke(time, maker) * plate.forward;
    const double elevation = depth_before(plate, face, flow) - plate.depth;
    maker.rate = plate.law.gain() * (plate.law.elevation(time) - elevation) - plate.law.forgetting() * maker.correction;
  }
}

TAILWATER_IN_2D_AND_3D(steer_wave_makers);

}  // namespace tailwater
