// Parameters of the friction of walls (wall_friction.h).
#pragma once

namespace tailwater {

struct FrictionLaw {
  double viscosity = 0.0;  ///< m^2/s; molecular
  double spacing = 0.0;    ///< m; dx of the case
  double exchange_length =
      0.0;  ///< m; at that spacing: water with slip velocity u gets the stress k u/exchange_length from k_i
  bool knows_layers = false;  ///< whether particles carry the eddy viscosity of their layer
};

}  // namespace tailwater
