#include <algorithm>
#include <cmath>

#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "motion/floating_body.h"

namespace tailwater {
namespace {

/// Around a body's walls as they are drawn.
template <int Dim>
Eigen::AlignedBox<double, Dim> box_of_body(const FloatingBody<Dim>& body, const Boundary<Dim>& boundary) {
  Eigen::AlignedBox<double, Dim> box;
  for (const WallFace<Dim>& face : boundary.faces) {
    if (std::ranges::find(body.walls, face.wall) != body.walls.end()) box.extend(face.box());
  }
  return box;
}

}  // namespace

template <int Dim>
Findings check_bodies(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  Findings findings;
  for (const FloatingBody<Dim>& body : make_bodies<Dim>(spec)) {
    const Eigen::AlignedBox<double, Dim> box = box_of_body(body, boundary);
    if (box.isEmpty()) continue;
    const Vec<Dim>& centre = body.drawn.centre;
    if (box.exteriorDistance(centre) > corner_tolerance * spec.particles.spacing) {
      findings.push_back(Finding::warning(
          "body '{}' has its centre of mass at {}, outside of its walls, which lie between {} and {}: `centre` is a "
          "place of the case, where the body is drawn, not one on the body",
          body.name, place(centre), place<Dim>(box.min()), place<Dim>(box.max())));
      continue;
    }
    const bool turns_freely = std::ranges::any_of(body.free, [](int entry) { return entry >= Dim; });
    const double radius = std::sqrt(body.inertia.maxCoeff() / body.mass);
    const double farthest = (centre - box.min()).cwiseMax(box.max() - centre).norm();
    if (turns_freely && radius > farthest) {
      findings.push_back(Finding::warning(
          "body '{}' has an inertia of {:.4g} kg m^2, as if its {:.4g} kg were {:.4g} m away from their centre, but "
          "the farthest point of its walls is {:.4g} m away: give the moment of inertia about the centre, in kg m^2{}",
          body.name, body.inertia.maxCoeff(), body.mass, radius, farthest, Dim == 2 ? " per metre of width" : ""));
    }
  }
  return findings;
}

template <int Dim>
Findings check_moorings(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  Findings findings;
  const std::vector<FloatingBody<Dim>> bodies = make_bodies<Dim>(spec);
  const auto check_end = [&](const std::string& name, int of_body, const Vec<Dim>& x) {
    const FloatingBody<Dim>& body = bodies[of_body];
    const Eigen::AlignedBox<double, Dim> box = box_of_body(body, boundary);
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

TAILWATER_IN_2D_AND_3D(check_bodies);
TAILWATER_IN_2D_AND_3D(check_moorings);

}  // namespace tailwater
