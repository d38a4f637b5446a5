#include "probes/discharge.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/assert.h"
#include "base/for_each.h"
#include "geometry/from_spec.h"
#include "geometry/opening.h"
#include "neighbours/halo.h"

namespace tailwater {
namespace {

/// [dx]; with two columns on each side the tent counts a lattice exactly wherever it stands.
constexpr double half_width_over_spacing = 2.0;
/// Time of the mean, in spacings: the time in which a long wave in water as deep as the section is high travels so far.
/// Single particles vanish in such a mean, but changes of such water do not.
constexpr double mean_over_spacing = 20.0;

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

/// The state of a probe between readings, as the numbers that checkpoints save: the largest mean and its time, then the
/// time and the volume that had passed at each of the last readings.
class Memory {
 public:
  explicit Memory(std::vector<double>& numbers) : numbers_(numbers) {}

  static std::vector<double> at_start() { return {0.0, 0.0}; }
  double largest() const { return numbers_[0]; }
  double time_of_largest() const { return numbers_[1]; }

  bool has_readings() const { return count() > 0; }
  void add_first(double time, double passed) { numbers_.insert(numbers_.end(), {time, passed}); }

  /// The mean discharge at a later reading: over the time `over`, or since the last reading if that is longer. It is
  /// the mean over all readings until such a time has passed.
  double add(double time, double passed, double over) {
    TAILWATER_ASSERT(time > time_at(count() - 1), "each reading is later than the one before");
    constexpr double rounding = 1e-9;
    const double begin = std::min(time - over, time_at(count() - 1));
    const bool is_whole = begin >= time_at(0) - rounding * over;
    numbers_.insert(numbers_.end(), {time, passed});
    while (time_at(1) <= begin) numbers_.erase(numbers_.begin() + 2, numbers_.begin() + 4);
    const double mean = (passed - passed_at(begin)) / (time - std::max(begin, time_at(0)));
    if (is_whole && mean > largest()) {
      numbers_[0] = mean;
      numbers_[1] = time;
    }
    return mean;
  }

 private:
  std::size_t count() const { return numbers_.size() / 2 - 1; }
  double time_at(std::size_t reading) const { return numbers_[2 + 2 * reading]; }
  double passed_at(double time) const {
    const double share = std::clamp((time - numbers_[2]) / (numbers_[4] - numbers_[2]), 0.0, 1.0);
    return numbers_[3] + share * (numbers_[5] - numbers_[3]);
  }

  std::vector<double>& numbers_;
};

}  // namespace

template <int Dim>
double discharge_mean_over(const ProbeTable& probe, const CaseSpec& spec) {
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
  return celerity > 0.0 ? mean_over_spacing * spec.particles.spacing / celerity : 0.0;
}

template <int Dim>
Reading<Dim> discharge_reading(const ProbeTable& probe, const CaseSpec& spec) {
  const Opening<Dim> section = make_section<Dim>(probe, spec.particles.spacing);
  const std::size_t number = number_among_sections(probe, spec);
  const double over = discharge_mean_over<Dim>(probe, spec);
  Reading<Dim> reading;
  reading.columns = columns_of(probe, Dim);
  reading.memory = std::make_shared<std::vector<double>>(Memory::at_start());
  reading.memory_grows = true;
  reading.take = [=, numbers = reading.memory](const ProbeContext<Dim>& context) -> std::vector<Row> {
    Memory memory(*numbers);
    const double volume = context.totals.section_volumes.at(number);
    const double passed = volume + volume_in_passage(section, context);
    if (memory.has_readings()) return {{memory.add(context.time, passed, over), volume}};
    memory.add_first(context.time, passed);
    return {{flux_near(section, context), volume}};
  };
  reading.totals = [=, numbers = reading.memory]() -> std::vector<double> {
    const Memory memory(*numbers);
    return {memory.largest(), memory.time_of_largest(), over};
  };
  return reading;
}

TAILWATER_IN_2D_AND_3D(discharge_mean_over);
TAILWATER_IN_2D_AND_3D(discharge_reading);

}  // namespace tailwater
