#include "flow/water_amount.h"

#include "base/saved.h"

namespace tailwater {

WaterAmount& WaterAmount::operator+=(const WaterAmount& other) {
  particles += other.particles;
  volume += other.volume;
  mass += other.mass;
  energy += other.energy;
  return *this;
}

WaterAmount& WaterAmount::operator-=(const WaterAmount& other) {
  particles -= other.particles;
  volume -= other.volume;
  mass -= other.mass;
  energy -= other.energy;
  return *this;
}

TAILWATER_SAVED(, WaterAmount, particles, volume, mass, energy)

Json summary_of(const WaterAmount& water) {
  return {{"particles", water.particles}, {"volume_m3", water.volume}, {"mass_kg", water.mass}};
}

}  // namespace tailwater
