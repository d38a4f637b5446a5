#include "results/result_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "io/messages.h"

namespace tailwater {
namespace {

/// dx; smaller lifts of all water are not detected.
constexpr double resolved_lift = 0.05;

/// Fraction of the work of open ends up to which a rise may be the error of that work. The pressure of an inlet has a
/// relative error of (dx/depth)^2, and some per cent more where the flow turns: 5 % for a box that fills through its
/// floor.
constexpr double doubt_of_ends = 0.1;
/// Fraction of the work of walls, whose sum misses (dx/depth)^2, 4 % for a piston that lifts 12 rows.
constexpr double doubt_of_walls = 0.05;

/// Factor of growth since its warning above which an error is reported again.
constexpr double worth_telling = 1.5;

}  // namespace

template <int Dim>
ResultLimits::ResultLimits(const LimitsTable& limits, const Flow<Dim>& flow)
    : energy_{"the energy rose, without the work of walls, by {:.3g} % of m g L/2 plus the kinetic energy",
              "the energy rose, without the work of walls, by {:.3g} % of m g L/2, the kinetic energy of the start and "
              "the work of open ends",
              "energy", limits.energy_warning, limits.energy_stop},
      volume_{"the mean density of the water away from the surface was off by {:.3g} %",
              "the mean density of the water away from the surface was off by {:.3g} %", "volume",
              limits.volume_warning, limits.volume_stop},
      volume_at_start_(flow.setup.ranks.sum(fluid_sums_of_rank(flow).mass) / flow.setup.liquid.density),
      kinetic_at_start_(flow.setup.ranks.sum(fluid_sums_of_rank(flow).kinetic_energy)),
      potential_scale_(0.5 * flow.setup.liquid.density * flow.setup.gravity.norm() * flow.setup.length),
      unresolved_(resolved_lift * flow.setup.liquid.density * flow.setup.gravity.norm() * flow.setup.scale.spacing) {}

void ResultLimits::check(double time, double energy_rise, double work_of_ends, double work_of_walls,
                         const FlowMeasures& measures) {
  const double density_error = std::abs(measures.density_error_mean);
  check(volume_, time, density_error, 0.0, density_error);
  // The work of the prescribed flow at open ends is an estimate, whose error grows with the water that passes. A case
  // that fills has hardly any energy at the start as a reference.
  const double volume = volume_at_start_ + measures.arrived.volume;
  const double brought = volume * potential_scale_ + work_of_ends;
  const double at_hand = brought + measures.kinetic_energy;
  if (at_hand <= 0.0) return;
  const double harmless = volume * unresolved_ + doubt_of_ends * work_of_ends + doubt_of_walls * work_of_walls;
  const double growth_scale = brought + kinetic_at_start_;
  check(energy_, time, energy_rise / at_hand, harmless / at_hand,
        energy_rise / (growth_scale > 0.0 ? growth_scale : at_hand));
}

void ResultLimits::check(Limit& limit, double time, double error, double harmless, double growth) {
  if (growth > limit.largest) {
    limit.largest = growth;
    limit.time_of_largest = time;
  }
  const auto describe = [&](const char* kind, double bound) {
    return fmt::format("at t = {:.4f} s {}, more than limits.{}_{} = {:g}", time,
                       fmt::format(fmt::runtime(limit.what), 100.0 * error), limit.keys, kind, bound);
  };
  if (limit.stop > 0.0 && error > limit.stop) {
    throw SolverError("{}. Remedy: a smaller particles.spacing or scheme.courant, or a higher limit",
                      describe("stop", limit.stop));
  }
  if (limit.warning > 0.0 && error > std::max(limit.warning, harmless) && limit.told == 0.0) {
    limit.told = growth;
    warn("balance-limit-passed", "{}; remedy: use a smaller particles.spacing or scheme.courant",
         describe("warning", limit.warning));
  }
}

void ResultLimits::warn_of_largest() {
  for (Limit* limit : {&energy_, &volume_}) {
    if (limit->told == 0.0 || limit->largest <= worth_telling * limit->told) continue;
    limit->told = limit->largest;
    warn("balance-worst", "until t = {:.4f} s {}, the largest value in this run", limit->time_of_largest,
         fmt::format(fmt::runtime(limit->most), 100.0 * limit->largest));
  }
}

Json ResultLimits::saved() const {
  Json saved;
  for (const Limit* limit : {&energy_, &volume_}) {
    saved[limit->keys] = {limit->told, limit->largest, limit->time_of_largest};
  }
  return saved;
}

void ResultLimits::restore(const Json& saved) {
  for (Limit* limit : {&energy_, &volume_}) {
    const Json& numbers = saved.at(limit->keys);
    numbers.at(0).get_to(limit->told);
    numbers.at(1).get_to(limit->largest);
    numbers.at(2).get_to(limit->time_of_largest);
  }
}

template ResultLimits::ResultLimits(const LimitsTable&, const Flow<2>&);
template ResultLimits::ResultLimits(const LimitsTable&, const Flow<3>&);

}  // namespace tailwater
