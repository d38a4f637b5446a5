#include <algorithm>

#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "motion/floating_body.h"

namespace tailwater {

template <int Dim>
Findings check_moorings(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  Findings findings;
  for (const FloatingBody<Dim>& body : make_bodies<Dim>(spec)) {
    Eigen::AlignedBox<double, Dim> box;
    for (const WallFace<Dim>& face : boundary.faces) {
      if (std::ranges::find(body.walls, face.wall) != body.walls.end()) box.extend(face.box());
    }
    if (box.isEmpty()) continue;
    for (const MooringTable& mooring : spec.moorings) {
      if (mooring.body != body.name) continue;
      const Vec<Dim> at = to_vec<Dim>(mooring.at, "mooring '" + mooring.name + "'", "at");
      const double away = box.exteriorDistance(at);
      if (away <= box.diagonal().norm()) continue;
      findings.push_back(Finding::error(
          "mooring '{}' is fastened at {}, {:.4g} m from body '{}', which lies between {} and {}: `at` is a place of "
          "the body as it is drawn, `anchor` the other end",
          mooring.name, place(at), away, body.name, place<Dim>(box.min()), place<Dim>(box.max())));
    }
  }
  return findings;
}

template Findings check_moorings(const CaseSpec&, const Boundary<2>&);
template Findings check_moorings(const CaseSpec&, const Boundary<3>&);

}  // namespace tailwater
