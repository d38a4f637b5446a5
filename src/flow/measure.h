// Measures of the whole flow.
#pragma once

#include <span>

#include "flow/flow.h"
#include "flow/water_amount.h"

namespace tailwater {

/// Sums over this rank's fluid.
struct FluidSums {
  double mass = 0.0;            ///< kg (per metre of width in 2D)
  double kinetic_energy = 0.0;  ///< J
  double energy = 0.0;          ///< J; kinetic and potential
  double fall_power = 0.0;      ///< W; of the weight

  FluidSums& operator+=(const FluidSums& other);
};

template <int Dim>
FluidSums fluid_sums_of_rank(const Flow<Dim>& flow);

/// m g L/2 plus a kinetic energy [J]: a scale for errors of the energy that does not depend on the origin.
template <int Dim>
double energy_scale(const Setup<Dim>& setup, double mass, double kinetic_energy);
/// This scale of the water at present. Collective.
template <int Dim>
double energy_scale(const Flow<Dim>& flow);

/// The fluid's largest speed [m/s]. Collective.
template <int Dim>
double largest_speed(const Flow<Dim>& flow);

/// The water of these owned particles, over all ranks. Collective.
template <int Dim>
WaterAmount amount_of(const Flow<Dim>& flow, std::span<const std::size_t> water);

/// The measures at the end of a step.
struct FlowMeasures {
  double largest_speed = 0.0;       ///< m/s
  double kinetic_energy = 0.0;      ///< J (per metre of width in 2D)
  double potential_energy = 0.0;    ///< J, relative to the origin
  double density_error_mean = 0.0;  ///< of C/C_0 - 1 in the bulk (away from the surface)
  double density_error_rms = 0.0;
  double density_error_largest = 0.0;
  WaterAmount departed;              ///< all water that parts took out since the start
  WaterAmount arrived;               ///< all water that parts brought in since the start
  std::vector<StepColumn> of_parts;  ///< columns of steps.csv

  double energy() const { return kinetic_energy + potential_energy; }
};

/// Collective.
template <int Dim>
FlowMeasures measure(const Flow<Dim>& flow);

/// The densest water of the bulk.
template <int Dim>
struct DensestWater {
  Vec<Dim> position = Vec<Dim>::Zero();  ///< m
  double error = 0.0;                    ///< C/C_0 - 1
  bool is_prescribed = false;            ///< whether a part prescribes its velocity, as in the buffer of an opening
};

/// Collective.
template <int Dim>
DensestWater<Dim> densest_water(const Flow<Dim>& flow);

}  // namespace tailwater
