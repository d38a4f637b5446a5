#include "case/formulation.h"
#include "checks/checks.h"
#include "geometry/wall_label.h"

namespace tailwater {

template <int Dim>
Findings check_plates(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  if (boundary.plates.empty() || !traits_of(spec).walls.on_wall) return {};
  return {Finding::error(
      "plate-needs-robust",
      {"{} is a plate, and the published formulation puts particles on the wall itself: the water on both sides "
       "would interact with them",
       wall_label(boundary, boundary.plates.front().wall)},
      {"choose scheme.formulation = \"robust\", or draw a wall with two faces"})};
}

TAILWATER_IN_2D_AND_3D(check_plates);

}  // namespace tailwater
