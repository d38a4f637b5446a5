// Amounts of water that have entered or left a flow.
#pragma once

#include <cstdint>

#include "base/json.h"

namespace tailwater {

/// An amount of water.
struct WaterAmount {
  std::int64_t particles = 0;
  double volume = 0.0;  ///< m^Dim
  double mass = 0.0;    ///< kg
  double energy = 0.0;  ///< J; kinetic and potential, of water that entered or left the flow, at that instant

  WaterAmount& operator+=(const WaterAmount& other);
  WaterAmount& operator-=(const WaterAmount& other);
};

/// Its members by name, for checkpoints.
void to_json(Json& json, const WaterAmount& all);
/// Throws Json::exception if one is missing or of another type.
void from_json(const Json& json, WaterAmount& all);

/// Number, volume and mass, for the summary.
Json summary_of(const WaterAmount& water);

}  // namespace tailwater
