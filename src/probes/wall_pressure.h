// Pressure on the wall itself, read from the fluid beside it: probes "wall-pressure" and "wall-pressure-mean".
//
//   p(x_w) = sum w W(x_w - x_j) (p_j + rho (g - a) . (x_w - x_j)) / sum w W
//
// The second term extrapolates each particle's pressure to the wall along the hydrostatic gradient in the frame of the
// wall. a is the acceleration that walls impose on the water in the directions M that they block:
//
//   a = (sum w W (M + e I))^-1 sum w W M a_w
//
// over the wall particles in reach, with the accelerations M a_w of their rows: those of moving walls and of water that
// turns along curved or rotating walls. In still water, and in water that moves with a tank, the result is exact, at
// any distance of the particles from the wall. In a falling jet the gradient is not hydrostatic; there the term may not
// create a tension that no particle has. Where the wall is dry,
// c(x_w) <= 1/2 (water_share.h), the pressure is that of the air: 0, or that of a pocket. A wall in still water is wet
// up to the surface; a layer one particle thick wets it, a single particle does not.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "case/spec.h"
#include "geometry/wall_patches.h"
#include "probes/context.h"

namespace tailwater {

/// Time [s] over which the largest pressures of a probe are means: the key of the probe, with the dx, the speed [m/s]
/// and the gravity [m/s^2] of the case. If the key is 0, it is the time in which water crosses the kernel's radius, so
/// that rows of particles that arrive at a wall are averaged, or a tenth of the depth, whichever is longer: the time
/// must not vanish with dx (docs/theory/probes.md). 0 without gravity.
double averaging_time(double key, double spacing, double speed, double gravity);

/// The sums of this formula and of c, over all or some particles.
template <int Dim>
struct WallPressureSums {
  double water = 0.0;     ///< S_f
  double wall = 0.0;      ///< S_w
  double pressure = 0.0;  ///< Pa; not yet divided by S_f
  double least = 0.0;     ///< Pa; smallest of 0 and the pressures of fluid particles
  // With WallInertia:
  Vec<Dim> offset = Vec<Dim>::Zero();        ///< kg/m^2; sum of w W rho (x_w - x_j) over the water
  Mat<Dim> blocked = Mat<Dim>::Zero();       ///< sum of w W M
  Vec<Dim> acceleration = Vec<Dim>::Zero();  ///< m/s^2; sum of w W M a_w

  /// Calls body with each sum but `least`.
  template <class Body>
  void for_each_sum(bool has_inertia, Body&& body) {
    body(water);
    body(wall);
    body(pressure);
    if (!has_inertia) return;
    for (double& entry : offset) body(entry);
    for (int k = 0; k < Mat<Dim>::count; ++k) body(blocked.data()[k]);
    for (double& entry : acceleration) body(entry);
  }

  /// Adds the particle at `x_j` with w_j W = `weight`.
  void add(const ProbeContext<Dim>& context, const Vec<Dim>& x_w, std::int32_t j, const Vec<Dim>& x_j, double weight);

  /// Adds the owned particles whose images, moved by `shift` [m], are near.
  void add_owned(const ProbeContext<Dim>& context, const Vec<Dim>& x_w, const Vec<Dim>& shift);

  /// Pressure on the wall, Pa; empty where the wall is dry.
  std::optional<double> value() const;

 private:
  Vec<Dim> acceleration_of_water() const;
};

/// Pressure at a place of a wall.
struct PressureOnWall {
  double value = 0.0;  ///< Pa; of the water, or of the air where the wall is dry
  bool is_wet = false;
};

template <int Dim>
PressureOnWall wall_pressure(const ProbeContext<Dim>& context, const Vec<Dim>& x_w);

/// The pressure from the sums at a place of a wall with this normal.
template <int Dim>
PressureOnWall wall_pressure(const ProbeContext<Dim>& context, const Vec<Dim>& x_w, const Vec<Dim>& normal,
                             const WallPressureSums<Dim>& sums);

/// The force of the air on a patch of a wall.
template <int Dim>
struct AirPush {
  int wall;  ///< index into Boundary::walls
  Vec<Dim> centre;
  Vec<Dim> place;  ///< at the centre, on the side of the patch
  Vec<Dim> force;  ///< N; in 2D per metre of width
};

/// The forces of pockets of air on the selected fractions of the patches beside them, each in proportion to its dry
/// fraction 1 - c; the same on all ranks. Collective.
template <int Dim>
std::vector<AirPush<Dim>> pushes_of_air(const ProbeContext<Dim>& context, std::span<const WallPatch<Dim>> patches,
                                        std::span<const double> chosen);

/// Pressure at the point of a wall nearest to `at`; with a `diameter` the mean over a disc in the wall (2D: a stretch).
/// Throws InputError when no wall is within a support of `at`, or of a place of the disc.
template <int Dim>
Reading<Dim> wall_pressure_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

/// Mean pressure over the stretch from `from` to `to`, with a `width` over the rectangle in the wall around it, from
/// places at most dx/2 apart; dry places count with the air's pressure. Throws InputError as above, for any of these
/// places, and for a width in 2D.
template <int Dim>
Reading<Dim> wall_pressure_mean_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
