// The part of the walls that a probe asks for.
#pragma once

#include <span>
#include <vector>

#include "case/spec.h"
#include "geometry/wall_patches.h"

namespace tailwater {

/// The share of each patch, 0 to 1, that is of the walls that the probe names (all, if it names none) and inside its
/// region, if it has one. `boundary` is as drawn. Throws InputError for an unknown wall, which lists the known ones,
/// and if nothing is chosen.
template <int Dim>
std::vector<double> chosen_shares(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary,
                                  std::span<const WallPatch<Dim>> patches);

}  // namespace tailwater
