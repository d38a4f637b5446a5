// Pressure on the wall itself, read from the fluid beside it: probes "wall-pressure" and "wall-pressure-mean".
//
//   p(x_w) = sum w W(x_w - x_j) (p_j + rho g . (x_w - x_j)) / sum w W
//
// The second term extrapolates each particle's pressure to the wall along the hydrostatic gradient. In still water the
// result is exactly rho g times the depth, at any distance of the particles from the wall. In a falling jet the
// gradient is not hydrostatic; there the term may not create a suction that no particle has. Where the wall is dry,
// c(x_w) <= 1/2 (water_share.h), the pressure is 0. A wall in still water is wet up to the surface; a layer one
// particle thick wets it, a single particle does not.
#pragma once

#include <optional>

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

/// The sums of this formula and of c, over particles or over some of them.
template <int Dim>
struct WallPressureSums {
  double water = 0.0;     ///< S_f
  double wall = 0.0;      ///< S_w
  double pressure = 0.0;  ///< Pa; not yet divided by S_f
  double least = 0.0;     ///< Pa; of 0 and the pressures of fluid particles

  /// Adds the particle at `x_j` with w_j W = `weight`.
  void add(const ProbeContext<Dim>& context, const Vec<Dim>& x_w, std::int32_t j, const Vec<Dim>& x_j, double weight);

  /// Adds the owned particles whose images, moved by `shift` [m], are near.
  void add_owned(const ProbeContext<Dim>& context, const Vec<Dim>& x_w, const Vec<Dim>& shift);

  /// Pressure on the wall, Pa; none where it is dry.
  std::optional<double> value() const;
};

/// Pressure on the wall at `x_w`, Pa; none where it is dry.
template <int Dim>
std::optional<double> wall_pressure(const ProbeContext<Dim>& context, const Vec<Dim>& x_w);

/// Pressure at the point of a wall nearest to `at`: column pressure_Pa. With a `diameter` the mean over a disc in the
/// wall (2D: a stretch), with the columns of a mean. Throws InputError when no wall is within a support of `at`, or of
/// a place of the disc.
template <int Dim>
Reading<Dim> wall_pressure_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

/// Mean pressure over the stretch from `from` to `to`, with a `width` over the rectangle in the wall around it, from
/// places at most dx/2 apart; dry places count as 0. Columns pressure_Pa, wet_share. Throws InputError as above, for
/// any of these places, and for a width in 2D.
template <int Dim>
Reading<Dim> wall_pressure_mean_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
