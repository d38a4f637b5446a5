// Space that water fills only in part: how particles are counted where a part of the flow has pores.
#pragma once

#include "base/vec.h"
#include "operators/lattice.h"

namespace tailwater {

/// Space at a place.
struct PoreSpace {
  double fraction = 1.0;  ///< of it that water can fill
  double inertia = 1.0;   ///< mass that accelerates with the water over that of the water
};

template <int Dim>
class Pores {
 public:
  virtual ~Pores() = default;
  virtual PoreSpace at(const Vec<Dim>& x) const = 0;
  /// 1/s; deceleration of the water over its filter velocity, whose magnitude is `speed` [m/s].
  virtual double resistance_at(const Vec<Dim>& x, double speed) const = 0;
  /// Sums over a full lattice of particles that occupy this volume each [m^Dim].
  virtual LatticeSums lattice_of(double volume) const = 0;
};

/// Fraction of the space at a place that water can fill: all of it if there are no pores (null).
template <int Dim>
double filled_fraction(const Pores<Dim>* pores, const Vec<Dim>& x) {
  return pores == nullptr ? 1.0 : pores->at(x).fraction;
}

/// Deceleration [m/s^2] of water with this filter velocity [m/s] by the pores.
template <int Dim>
Vec<Dim> deceleration(const Pores<Dim>* pores, const Vec<Dim>& x, const Vec<Dim>& filter_velocity) {
  if (pores == nullptr) return Vec<Dim>::Zero();
  return pores->resistance_at(x, filter_velocity.norm()) * filter_velocity;
}

}  // namespace tailwater
