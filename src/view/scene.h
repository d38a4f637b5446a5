// The static objects in the pictures of a run, for a viewer: walls, bodies, open ends, probes and the texts of the page
// around them (docs/reference/view.md).
#pragma once

#include <string_view>
#include <vector>

#include "base/json.h"
#include "case/spec.h"
#include "geometry/boundary.h"

namespace tailwater {

/// A quantity of the particles in frames.
struct FrameScalar {
  std::string_view name;
  std::string_view unit;
};
/// The scalars of the frames of a case: pressure, speed, the size of particles with zones of refinement, and their
/// liquid with several liquids.
std::vector<FrameScalar> frame_scalars(const CaseSpec& spec);

/// For each wall the number of its pose, in the order of their first walls; -1 for walls at rest.
template <int Dim>
std::vector<int> pose_of_walls(const Boundary<Dim>& boundary);

/// The scene of a case whose walls are where they are drawn.
template <int Dim>
Json scene_json(const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
