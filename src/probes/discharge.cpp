#include "probes/discharge.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/for_each.h"
#include "geometry/from_spec.h"
#include "geometry/opening.h"
#include "neighbours/halo.h"

namespace tailwater {
namespace {

/// [dx]; with two columns on each side the tent counts a lattice exactly wherever it stands.
constexpr double half_width_over_spacing = 2.0;
/// Smoothing time of the volume that has passed, in spacings: the time in which a long wave in water as deep as the
/// section is high travels so far. Single particles vanish in such a mean, but changes of such water do not.
constexpr double smoothing_over_spacing = 20.0;

/// Index of the probe among the discharge probes.
std::size_t number_among_sections(const ProbeTable& probe, const CaseSpec& spec) {
  std::size_t number = 0;
  for (const ProbeTable& other : spec.probes) {
    if (other.name == probe.name) break;
    number += other.type == ProbeType::discharge;
  }
  return number;
}

/// The sum of weight(i, distance beyond the section) over the water whose foot is on the section. Water near one end of
/// a periodic domain is near sections at the other end, too. Collective.
template <int Dim, class Weight>
double sum_near(const Opening<Dim>& section, const ProbeContext<Dim>& context, Weight&& weight) {
  const Particles<Dim>& particles = context.particles;
  const std::vector<Vec<Dim>> shifts = image_shifts<Dim>(context.domain);
  return context.ranks.sum(sum_over(particles.owned, 0.0, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return 0.0;
    double sum = 0.0;
    for (const Vec<Dim>& shift : shifts) {
      const Vec<Dim> x = particles.position[i] + shift;
      const double here = weight(i, section.beyond(x));
      if (here != 0.0 && section.spans(x)) sum += here;
    }
    return sum;
  }));
}

/// The volume [m^Dim] by which the water is farther through the section than the count of whole particles says. A
/// particle counts as half through when it passes, and as a whole before and after that for half its width.
template <int Dim>
double volume_in_passage(const Opening<Dim>& section, const ProbeContext<Dim>& context) {
  return sum_near(section, context, [&](std::size_t i, double beyond) {
    const double volume = context.particles.volume[i];
    const double width = edge_of<Dim>(volume);
    if (std::abs(beyond) >= 0.5 * width) return 0.0;
    return (0.5 + beyond / width - (beyond > 0.0 ? 1.0 : 0.0)) * volume;
  });
}

/// The flux [m^Dim/s] of the water within two spacings of the section, at one instant.
template <int Dim>
double flux_near(const Opening<Dim>& section, const ProbeContext<Dim>& context) {
  const double half = half_width_over_spacing * context.spacing;
  return sum_near(section, context,
                  [&](std::size_t i, double beyond) {
                    const double share = std::max(0.0, 1.0 - std::abs(beyond) / half);
                    return share * context.particles.volume[i] * section.normal.dot(context.particles.velocity[i]);
                  }) /
         half;
}

/// The state of a probe between readings, as the numbers that checkpoints save.
struct Memory {
  explicit Memory(std::vector<double>& numbers)
      : largest(numbers[0]), time_of_largest(numbers[1]), time(numbers[2]), passed(numbers[3]), discharge(numbers[4]) {}

  static std::vector<double> at_start() { return {0.0, 0.0, -1.0, 0.0, 0.0}; }
  bool is_new() const { return time < 0.0; }

  double& largest;
  double& time_of_largest;
  double& time;    ///< time of the last reading; below 0: there was none
  double& passed;  ///< volume that had passed at that time
  double& discharge;
};

}  // namespace

template <int Dim>
double discharge_smoothed_over(const ProbeTable& probe, const CaseSpec& spec) {
  const Opening<Dim> section = make_section<Dim>(probe, spec.particles.spacing);
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  double upright = 0.0;  // m^2/s^2; gravity times the height
  double widest = 0.0;
  for (const Vec<Dim>& edge : section.edges) {
    upright = std::max(upright, std::abs(edge.dot(gravity)));
    widest = std::max(widest, edge.norm() * gravity.norm());
  }
  const bool lies_flat = upright < 1e-3 * widest;
  const double celerity = std::sqrt(lies_flat ? widest : upright);
  return celerity > 0.0 ? smoothing_over_spacing * spec.particles.spacing / celerity : 0.0;
}

template <int Dim>
Reading<Dim> discharge_reading(const ProbeTable& probe, const CaseSpec& spec) {
  const Opening<Dim> section = make_section<Dim>(probe, spec.particles.spacing);
  const std::size_t number = number_among_sections(probe, spec);
  const double smoothing = discharge_smoothed_over<Dim>(probe, spec);
  Reading<Dim> reading;
  reading.columns = columns_of(probe, Dim);
  reading.memory = std::make_shared<std::vector<double>>(Memory::at_start());
  reading.take = [=, numbers = reading.memory](const ProbeContext<Dim>& context) -> std::vector<Row> {
    Memory memory(*numbers);
    const double volume = context.totals.section_volumes.at(number);
    const double passed = volume + volume_in_passage(section, context);
    if (memory.is_new()) {
      memory.discharge = flux_near(section, context);
    } else if (const double since = context.time - memory.time; since > 0.0) {
      const double share = 1.0 - std::exp(-since / smoothing);
      memory.discharge += share * ((passed - memory.passed) / since - memory.discharge);
    }
    memory.time = context.time;
    memory.passed = passed;
    if (memory.discharge > memory.largest) {
      memory.largest = memory.discharge;
      memory.time_of_largest = context.time;
    }
    return {{memory.discharge, volume}};
  };
  reading.totals = [=, numbers = reading.memory]() -> std::vector<double> {
    const Memory memory(*numbers);
    return {memory.largest, memory.time_of_largest, smoothing};
  };
  return reading;
}

TAILWATER_IN_2D_AND_3D(discharge_smoothed_over);
TAILWATER_IN_2D_AND_3D(discharge_reading);

}  // namespace tailwater
