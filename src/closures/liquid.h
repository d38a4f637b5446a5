// The liquid of a flow.
#pragma once

namespace tailwater {

struct ViscosityLaw {
  double molecular = 0.0;   ///< m^2/s; nu_0
  double artificial = 0.0;  ///< m; c_a dx, times |u| gives nu_a (viscosity.h)

  double at_speed(double speed) const { return molecular + artificial * speed; }
};

struct Liquid {
  double density;          ///< kg/m^3
  ViscosityLaw viscosity;  ///< m^2/s
  double tension = 0.0;    ///< Pa; up to which walls hold it where no air is near
};

}  // namespace tailwater
