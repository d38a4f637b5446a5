#include <vector>

#include "base/for_each.h"
#include "flow/stages.h"
#include "neighbours/halo.h"

namespace tailwater {
namespace {

/// 1 if the way from `start` to `end` leads through the section in its direction, -1 if it leads back, else 0.
template <int Dim>
double way_through(const Opening<Dim>& section, const Vec<Dim>& start, const Vec<Dim>& end) {
  const double before = section.beyond(start);
  const double after = section.beyond(end);
  if ((before > 0.0) == (after > 0.0)) return 0.0;
  if (!section.spans(start + before / (before - after) * (end - start))) return 0.0;
  return after > 0.0 ? 1.0 : -1.0;
}

}  // namespace

template <int Dim>
void count_passing(Flow<Dim>& flow, const StepStart<Dim>& start) {
  const Particles<Dim>& particles = flow.state.particles;
  const std::vector<Vec<Dim>> shifts = image_shifts<Dim>(flow.setup.domain);
  for (std::size_t s = 0; s < flow.setup.sections.size(); ++s) {
    const Opening<Dim>& section = flow.setup.sections[s];
    const double volume = sum_over(particles.owned, 0.0, [&](std::size_t i) {
      if (!particles.is_fluid(i)) return 0.0;
      // What leaves a periodic domain at one end passes the sections at the other.
      double passes = 0.0;
      for (const Vec<Dim>& shift : shifts) {
        passes += way_through<Dim>(section, start.position[i] + shift, particles.position[i] + shift);
      }
      return passes * particles.volume[i];
    });
    flow.state.section_volumes[s] += flow.setup.ranks.sum(volume);
  }
}

TAILWATER_IN_2D_AND_3D(count_passing);

}  // namespace tailwater
