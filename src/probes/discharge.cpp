#include "probes/discharge.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/for_each.h"
#include "geometry/opening.h"

namespace tailwater {
namespace {

/// [dx]; with two columns on each side the tent counts a lattice exactly wherever it stands.
constexpr double half_width_over_spacing = 2.0;

/// Which of the discharge probes it is.
std::size_t number_among_sections(const ProbeTable& probe, const CaseSpec& spec) {
  std::size_t number = 0;
  for (const ProbeTable& other : spec.probes) {
    if (other.name == probe.name) break;
    number += other.type == ProbeType::discharge;
  }
  return number;
}

}  // namespace

template <int Dim>
Reading<Dim> discharge_reading(const ProbeTable& probe, const CaseSpec& spec) {
  const Opening<Dim> section = make_section<Dim>(probe, spec.particles.spacing);
  const std::size_t number = number_among_sections(probe, spec);
  Reading<Dim> reading;
  reading.columns = {"discharge_m3_per_s", "volume_m3"};
  reading.memory = std::make_shared<std::vector<double>>(2, 0.0);  // the largest discharge, and when it was
  reading.take = [section, number, memory = reading.memory](const ProbeContext<Dim>& context) -> std::vector<Row> {
    const Particles<Dim>& particles = context.particles;
    const double half = half_width_over_spacing * context.spacing;
    const double flux = sum_over(particles.owned, 0.0, [&](std::size_t i) {
      if (!particles.is_fluid(i)) return 0.0;
      const Vec<Dim>& x = particles.position[i];
      const double off = std::abs(section.beyond(x));
      if (off >= half || !section.spans(x)) return 0.0;
      return (1.0 - off / half) * particles.volume[i] * section.normal.dot(particles.velocity[i]);
    });
    const double discharge = context.ranks.sum(flux) / half;
    if (discharge > memory->front()) *memory = {discharge, context.time};
    return {{discharge, context.totals.section_volumes.at(number)}};
  };
  reading.summary = [memory = reading.memory]() -> std::vector<std::pair<std::string, double>> {
    return {{"largest_m3_per_s", memory->front()}, {"time_of_largest_s", memory->back()}};
  };
  return reading;
}

template Reading<2> discharge_reading<2>(const ProbeTable&, const CaseSpec&);
template Reading<3> discharge_reading<3>(const ProbeTable&, const CaseSpec&);

}  // namespace tailwater
