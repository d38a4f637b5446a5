// Reference sums where particles have several spacings (refinement/spacing_field.h). The concentration of a particle is
// compared with
//
//   C_0(h, V) C*(x),    C*(x) = int W(|y - x|, R (h(x) + h(y))/2) dy
//
// C_0 is the sum over a full lattice of particles of its volume and support; C* is the concentration of a continuum
// with the supports of this field, from 0.96 to 1.04 across a border. Without it the density source would push the
// water out of one side of a border and draw it to the other. Likewise a continuum has a gradient of C where supports
// vary, which is no crowding.
#pragma once

#include <vector>

#include "kernel/kernel.h"
#include "operators/lattice.h"
#include "operators/symmetric.h"
#include "refinement/spacing_field.h"

namespace tailwater {

/// Sums over a continuum.
template <int Dim>
struct ContinuumSums {
  double concentration = 1.0;                         ///< C*
  Vec<Dim> gradient = Vec<Dim>::Zero();               ///< 1/m; int grad_x W dy at a fixed support
  Packed<Dim> first_moment = packed_identity<Dim>();  ///< M*; int F s s dy with s = y - x
};

template <int Dim>
class GradedSums {
 public:
  GradedSums(const Kernel<Dim>& kernel, double spacing, SpacingField<Dim> field);

  const Kernel<Dim>& kernel() const { return kernel_; }
  const SpacingField<Dim>& field() const { return field_; }
  double spacing() const { return spacing_; }  ///< m; of the case
  /// Sums over a full lattice of particles of this volume [m^Dim] with the support of a relative spacing h.
  LatticeSums lattice(double relative_spacing, double volume) const;
  /// Their concentration alone, C_0.
  double lattice_concentration(double relative_spacing, double volume) const;
  /// d ln C_0/d ln h of such a lattice, at its volume.
  double lattice_slope(double relative_spacing, double volume) const;
  /// -dg/d ln h at a fixed depth below the plane surface of a continuum, of which this fraction g of the support is
  /// filled there. 0 inside, and where less than half is filled.
  double change_at_surface(double filled) const;
  /// At a place of the field as drawn, by quadrature.
  ContinuumSums<Dim> continuum(const Vec<Dim>& x) const;

 private:
  /// The entries around a volume.
  struct Entry {
    const LatticeSums& low;
    const LatticeSums& high;
    double share;            ///< of the way to the higher one
    double relative_volume;  ///< over (h dx)^Dim
  };
  Entry entry(double relative_spacing, double volume) const;

  /// A place in a continuum behind a plane surface.
  struct BehindSurface {
    double filled;  ///< g
    double change;  ///< -dg/d ln h
  };
  static std::vector<BehindSurface> sums_behind_surface(const Kernel<Dim>& kernel);

  Kernel<Dim> kernel_;
  double spacing_;
  SpacingField<Dim> field_;
  std::vector<LatticeSums> lattices_;          ///< with the support of the case, in equal steps of the volume
  std::vector<BehindSurface> behind_surface_;  ///< from the surface to the depth of the radius of the support
};

}  // namespace tailwater
