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
  /// Sums over a full lattice of particles that occupy this volume each [m^Dim].
  virtual LatticeSums lattice_of(double volume) const = 0;
};

}  // namespace tailwater
