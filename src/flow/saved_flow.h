// A flow in a checkpoint.
#pragma once

#include <nlohmann/json.hpp>

#include "base/json.h"
#include "flow/state.h"

namespace tailwater {

template <int Dim>
struct SavedFlow {
  State<Dim> state;
  Json parts;  ///< saved state of each part, by its name
};

}  // namespace tailwater
