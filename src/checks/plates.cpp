#include "checks/checks.h"
#include "sampling/wall_particles.h"

namespace tailwater {

template <int Dim>
Findings check_plates(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  if (boundary.plates.empty() || !placement_of(spec.scheme.walls).on_wall) return {};
  return {Finding::error(
      "{} is a plate, and scheme.walls = \"{}\" puts particles on the wall itself, which both sides would feel: set "
      "scheme.walls = \"dummies\", or draw a wall with two faces",
      wall_label(boundary, boundary.plates.front().wall), name_of(spec.scheme.walls))};
}

template Findings check_plates(const CaseSpec&, const Boundary<2>&);
template Findings check_plates(const CaseSpec&, const Boundary<3>&);

}  // namespace tailwater
