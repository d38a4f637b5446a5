// The liquid of a flow.
#pragma once

#include "closures/viscosity.h"

namespace tailwater {

struct Liquid {
  double density;          ///< kg/m^3
  ViscosityLaw viscosity;  ///< m^2/s
  double tension = 0.0;    ///< Pa; up to which walls hold it where no air is near
};

}  // namespace tailwater
