// Ducts: the conditions of an inlet or outlet hold outside of the case, at the end of a duct with which the walls
// beside the opening go on along its normal. Water in its first part, the lead, is solved for like that of the case;
// the last part is the buffer zone (open_ends). An opening into air has no duct: water that has left it falls freely.
#pragma once

#include "case/spec.h"
#include "geometry/boundary.h"

namespace tailwater {

/// [dx]; along a duct before its buffer zone, if the walls of the case do not lead to the opening straight for as long:
/// a flow that turns into a hole contracts there. Free jets are removed so far beyond their opening.
inline constexpr double lead_over_spacing = 6.0;

/// m; of a duct with a lead, a whole number of spacings
double duct_length(const CaseSpec& spec);

/// Whether the duct begins with a lead.
template <int Dim>
bool has_lead(const CaseSpec& spec, const Duct<Dim>& duct) {
  return duct.length > duct_length(spec) - 0.5 * lead_over_spacing * spec.particles.spacing;
}

/// [dx]; walls at most so far from the rim of an opening are beside it. A polygon may stand for a curve.
template <int Dim>
double rim_tolerance(const Opening<Dim>& opening);

/// The ducts of a case whose walls are in `boundary`, without walls of their own.
template <int Dim>
std::vector<Duct<Dim>> find_ducts(const CaseSpec& spec, const Boundary<Dim>& boundary);

/// Adds the ducts and their walls, one wall for each opening that has some: without friction, facing the inside, joined
/// to the walls on which the rim of the opening lies. Parts of the rim that are on no wall, or in a periodic plane,
/// stay open. Where walls of the case lead on along the normal, those of the duct begin at their end.
template <int Dim>
void append_ducts(const CaseSpec& spec, Boundary<Dim>& boundary);

}  // namespace tailwater
