// What probes ask of enclosed air.
#pragma once

#include <functional>

#include "flow/flow.h"

namespace tailwater {

/// The pressure [Pa] of the air at a place, above the atmosphere's; empty without pockets. Borrows the flow.
template <int Dim>
std::function<double(const Vec<Dim>&)> air_pressure_of(const Flow<Dim>& flow) {
  if (flow.state.air.pockets.empty()) return {};
  return [&flow](const Vec<Dim>& x) {
    double sum = 0.0;
    for (const PocketShare& share : flow.air.shares_at(x)) {
      const AirPocket& pocket = flow.state.air.pockets[share.pocket];
      sum += share.share * flow.air.law().pressure(pocket.gas, pocket.volume);
    }
    return sum;
  };
}

}  // namespace tailwater
