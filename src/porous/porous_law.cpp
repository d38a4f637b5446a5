#include "porous/porous_law.h"

namespace tailwater {

PorousMedium make_medium(const PorousTable& table, double viscosity, double gravity) {
  const double n = table.porosity;
  PorousMedium medium{.solid = 1.0 - n, .added_mass = table.added_mass};
  if (table.resistance == PorousResistance::coefficients) {
    medium.linear = gravity * table.linear;
    medium.quadratic = gravity * table.quadratic;
    return medium;
  }
  const double cubed = n * n * n;
  const double in_waves = table.keulegan_carpenter > 0.0 ? 1.0 + 7.5 / table.keulegan_carpenter : 1.0;
  medium.linear = table.alpha * (1.0 - n) * (1.0 - n) / cubed * viscosity / (table.grain_size * table.grain_size);
  medium.quadratic = table.beta * in_waves * (1.0 - n) / cubed / table.grain_size;
  return medium;
}

}  // namespace tailwater
