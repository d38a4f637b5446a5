// Brings the particles around probes from all ranks to the root.
#pragma once

#include <vector>

#include "probes/context.h"

namespace tailwater {

template <int Dim>
struct GatheredParticles {
  Particles<Dim> particles;
  std::vector<int> felt_through;  ///< as in ProbeContext
};

/// On the root: all particles, ghosts included, within the kernel's support of one of the regions, each once and in the
/// order of ids. On other ranks: none. All count as `owned`. Rows of walls are left out. Collective.
template <int Dim>
GatheredParticles<Dim> gather_near(const ProbeContext<Dim>& context, const std::vector<Region<Dim>>& regions);

}  // namespace tailwater
