// Brings the particles around probes from all ranks to the root.
#pragma once

#include <vector>

#include "probes/context.h"

namespace tailwater {

/// On the root: all particles, ghosts included, within the kernel's support of one of the regions, each once and in the
/// order of ids. On other ranks: none. All count as `owned`. Collective.
template <int Dim>
Particles<Dim> gather_near(const ProbeContext<Dim>& context, const std::vector<Region<Dim>>& regions);

}  // namespace tailwater
