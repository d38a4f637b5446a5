// Pressure on the wall itself, read from the fluid beside it: probes "wall-pressure" and "wall-pressure-mean".
//
//   p(x_w) = sum w W(x_w - x_j) (p_j + rho g . (x_w - x_j)) / sum w W
//
// The second term carries each particle's pressure to the wall along the hydrostatic gradient, so still water reads
// exactly rho g times the depth at any distance of the particles from the wall. In a falling jet, where it does not
// hold, it may not make a suction that none of the particles has. Where the wall is dry, c(x_w) <= 1/2 (water_share.h),
// it reads 0: a wall below still water is wet up to the surface, a layer one particle thick wets it, a single particle
// does not.
#pragma once

#include <optional>

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

/// Pressure on the wall at `x_w`, Pa; none where it is dry.
template <int Dim>
std::optional<double> wall_pressure(const ProbeContext<Dim>& context, const Vec<Dim>& x_w);

/// At the place of a wall nearest to `at`: column pressure_Pa. Throws InputError when no wall is within a support of
/// it.
template <int Dim>
Reading<Dim> wall_pressure_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

/// Mean over the stretch from `from` to `to`, read at most dx/2 apart, dry places counting as 0: columns pressure_Pa,
/// wet_share. Throws InputError as above, for any place of the stretch.
template <int Dim>
Reading<Dim> wall_pressure_mean_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
