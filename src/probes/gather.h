// Brings the particles around probes from all ranks to the root.
#pragma once

#include <vector>

#include "probes/context.h"

namespace tailwater {

template <int Dim>
struct GatheredParticles {
  Particles<Dim> particles;
  std::vector<int> felt_through;  ///< as in ProbeContext
  std::vector<Mat<Dim>> blocked;  ///< WallInertia::blocked, of the rows of these particles; empty without
  std::vector<Vec<Dim>> acceleration;

  WallInertia<Dim> wall_inertia() const { return {blocked, acceleration, {}}; }
};

/// On the root: all particles, ghosts included, within the kernel's support of one of the regions, each once and in the
/// order of ids. On other ranks: none. All count as `owned`. Each wall particle has a row of its own. Collective.
template <int Dim>
GatheredParticles<Dim> gather_near(const ProbeContext<Dim>& context, const std::vector<Region<Dim>>& regions);

}  // namespace tailwater
