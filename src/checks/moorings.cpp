#include <algorithm>

#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "motion/floating_body.h"

namespace tailwater {

template <int Dim>
Findings check_moorings(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  Findings findings;
  const std::vector<FloatingBody<Dim>> bodies = make_bodies<Dim>(spec);
  const auto check_end = [&](const std::string& name, int of_body, const Vec<Dim>& x) {
    const FloatingBody<Dim>& body = bodies[of_body];
    Eigen::AlignedBox<double, Dim> box;
    for (const WallFace<Dim>& face : boundary.faces) {
      if (std::ranges::find(body.walls, face.wall) != body.walls.end()) box.extend(face.box());
    }
    const double away = box.isEmpty() ? 0.0 : box.exteriorDistance(x);
    if (away <= box.diagonal().norm()) return;
    findings.push_back(Finding::error(
        "mooring '{}' is fastened at {}, {:.4g} m from body '{}', which lies between {} and {}: `at` is a place of the "
        "first of its bodies as that is drawn, `anchor` the other end, on the second body if there is one",
        name, place(x), away, body.name, place<Dim>(box.min()), place<Dim>(box.max())));
  };
  const std::vector<Mooring<Dim>> moorings = make_moorings<Dim>(spec);
  for (std::size_t m = 0; m < moorings.size(); ++m) {
    check_end(spec.moorings[m].name, moorings[m].body, moorings[m].at);
    if (moorings[m].to_body >= 0) check_end(spec.moorings[m].name, moorings[m].to_body, moorings[m].anchor);
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_moorings);

}  // namespace tailwater
