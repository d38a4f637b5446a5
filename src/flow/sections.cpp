#include "base/for_each.h"
#include "flow/verbs.h"

namespace tailwater {

template <int Dim>
void count_passing(Flow<Dim>& flow, const StepStart<Dim>& start) {
  const Particles<Dim>& particles = flow.state.particles;
  for (std::size_t s = 0; s < flow.setup.sections.size(); ++s) {
    const Opening<Dim>& section = flow.setup.sections[s];
    const double volume = sum_over(particles.owned, 0.0, [&](std::size_t i) {
      if (!particles.is_fluid(i)) return 0.0;
      const double before = section.beyond(start.position[i]);
      const double after = section.beyond(particles.position[i]);
      if ((before > 0.0) == (after > 0.0)) return 0.0;
      const double share = before / (before - after);
      const Vec<Dim> crossing = start.position[i] + share * (particles.position[i] - start.position[i]);
      if (!section.spans(crossing)) return 0.0;
      return after > 0.0 ? particles.volume[i] : -particles.volume[i];
    });
    flow.state.section_volumes[s] += flow.setup.ranks.sum(volume);
  }
}

TAILWATER_IN_2D_AND_3D(count_passing);

}  // namespace tailwater
