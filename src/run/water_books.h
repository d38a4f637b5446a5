// Where the water of a run is: what there was at the start, what is inside, what left through outlets.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "flow/flow.h"

namespace tailwater {

struct Water {
  std::int64_t particles = 0;
  double volume = 0.0;  ///< m^3; in 2D per metre of width

  Water& operator+=(const Water& other);
  std::string text() const;  ///< "50 particles (0.5 m^3)"
};

/// Inside, on all ranks; collective.
template <int Dim>
Water water_in(const Flow<Dim>& flow);

/// What left through all outlets since the start.
template <int Dim>
Water water_out(const Flow<Dim>& flow);

/// Block "water_balance" of the summary; collective.
template <int Dim>
nlohmann::ordered_json water_balance(const Water& at_start, const Flow<Dim>& flow);

/// Number of fluid particles, of all ranks, beyond the box around all walls: they are still computed, but left the case
/// over its rim. What is on its way out through an outlet did not. Collective.
template <int Dim>
std::size_t count_outside(const Flow<Dim>& flow);

}  // namespace tailwater
