// The water balance of a run: start + in = inside + outside + out. What is outside has left the walls over a rim; what
// is out has left through an open end, and what is in has come through one.
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
  Water& operator-=(const Water& other);
  std::string text() const;  ///< "50 particles (0.5 m^3)"
};

/// All water that is computed, over all ranks; collective.
template <int Dim>
Water water_in(const Flow<Dim>& flow);

/// The water that has left the walls for good, over all ranks: it is beyond the box around walls and open ends, and
/// straight below it along gravity there is no wall that would catch it, or it has fallen below all walls already and
/// is no longer computed. Spray above an open tank is not lost. Nor does water on its way out through an open end
/// belong to it. Collective.
template <int Dim>
Water water_outside(const Flow<Dim>& flow);

/// The water that is computed and not outside; collective.
template <int Dim>
Water water_inside(const Flow<Dim>& flow);

/// The water that left through all open ends since the start.
template <int Dim>
Water water_out(const Flow<Dim>& flow);

/// The water that came through all open ends since the start.
template <int Dim>
Water water_came(const Flow<Dim>& flow);

/// Block "water_balance" of the summary; collective.
template <int Dim>
nlohmann::ordered_json water_balance(const Water& at_start, const Flow<Dim>& flow);

}  // namespace tailwater
