#include "run/result_limits.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "io/messages.h"

namespace tailwater {

template <int Dim>
ResultLimits::ResultLimits(const LimitsTable& limits, const Flow<Dim>& flow)
    : energy_{"the energy has risen, apart from what walls brought, by {:.3g} % of m g L/2 plus the kinetic energy",
              "energy", limits.energy_warning, limits.energy_stop},
      volume_{"the mean density of the water away from the surface is off by {:.3g} %", "volume", limits.volume_warning,
              limits.volume_stop},
      volume_at_start_(flow.setup.ranks.sum(fluid_sums_of_rank(flow).mass) / flow.setup.density),
      potential_scale_(0.5 * flow.setup.density * flow.setup.gravity.norm() * flow.setup.length) {}

void ResultLimits::check(double time, double energy_rise, const FlowMeasures& measures) {
  check(volume_, time, std::abs(measures.density_error_mean));
  // The work of what is prescribed at open ends is an estimate, whose error grows with the water that passes.
  const double volume = volume_at_start_ + measures.arrived.volume;
  const double at_hand = volume * potential_scale_ + measures.kinetic_energy;
  if (at_hand > 0.0) check(energy_, time, energy_rise / at_hand);
}

void ResultLimits::check(Limit& limit, double time, double error) {
  const auto describe = [&](const char* kind, double bound) {
    return fmt::format("at t = {:.4f} s {}, more than limits.{}_{} = {:g}", time,
                       fmt::format(fmt::runtime(limit.what), 100.0 * error), limit.keys, kind, bound);
  };
  if (limit.stop > 0.0 && error > limit.stop) {
    throw SolverError(fmt::format("{}. Remedy: a smaller particles.spacing or scheme.courant, or a higher limit",
                                  describe("stop", limit.stop)));
  }
  if (limit.warning > 0.0 && error > limit.warning && !limit.has_warned) {
    limit.has_warned = true;
    warn(describe("warning", limit.warning));
  }
}

nlohmann::json ResultLimits::saved() const {
  return {{energy_.keys, energy_.has_warned}, {volume_.keys, volume_.has_warned}};
}

void ResultLimits::restore(const nlohmann::json& saved) {
  for (Limit* limit : {&energy_, &volume_}) saved.at(limit->keys).get_to(limit->has_warned);
}

template ResultLimits::ResultLimits(const LimitsTable&, const Flow<2>&);
template ResultLimits::ResultLimits(const LimitsTable&, const Flow<3>&);

}  // namespace tailwater
