// Pressures of enclosed air.
#pragma once

#include <functional>

#include "flow/flow.h"

namespace tailwater {

/// Pa; of the gas in a pocket, above the atmosphere's.
template <int Dim>
double pressure_of(const Flow<Dim>& flow, const AirPocket& pocket) {
  return flow.air.law().pressure(pocket.gas, pocket.volume);
}

/// The pressure [Pa] of the air at a place, above the atmosphere's; empty without pockets. Borrows the flow.
template <int Dim>
std::function<double(const Vec<Dim>&)> air_pressure_of(const Flow<Dim>& flow) {
  if (flow.state.air.pockets.empty()) return {};
  return [&flow](const Vec<Dim>& x) {
    double sum = 0.0;
    for (const PocketShare& share : flow.air.shares_at(x)) {
      sum += share.share * pressure_of(flow, flow.state.air.pockets[share.pocket]);
    }
    return sum;
  };
}

}  // namespace tailwater
