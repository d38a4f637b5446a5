#include <algorithm>
#include <cmath>

#include "base/box.h"
#include "case/formulation.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "motion/floating_body.h"

namespace tailwater {
namespace {

/// The box around a body's walls as drawn.
template <int Dim>
Box<Dim> box_of_body(const FloatingBody<Dim>& body, const Boundary<Dim>& boundary) {
  Box<Dim> box;
  for (const WallFace<Dim>& face : boundary.faces) {
    if (std::ranges::find(body.walls, face.wall) != body.walls.end()) box.extend(face.box());
  }
  return box;
}

/// dx. With a smaller draught the pressure of a single row of particles is larger than the weight of the body. Its
/// motion and the pressure are then inconsistent (0.04 dx failed, 0.08 dx did not).
constexpr double min_draught = 0.05;

/// An error for a body that floats on the surface like a film; empty if it does not.
template <int Dim>
Findings check_mass(const CaseSpec& spec, const FloatingBody<Dim>& body, const Box<Dim>& box) {
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  if (gravity.isZero(0.0)) return {};
  int upright = 0;
  gravity.cwiseAbs().maxCoeff(&upright);
  Vec<Dim> sides = box.sizes();
  sides[upright] = 1.0;
  const double per_draught = spec.physics.density * sides.prod();  // kg/m
  const double dx = spec.particles.spacing;
  const double draught = body.mass / per_draught;
  if (draught >= min_draught * dx) return {};
  return {
      Finding::error("body-too-light",
                     {"{} = {:.4g} is so light that it floats with a draught of {:.3g} m, less than {} spacings: its "
                      "motion cannot be computed from the pressure of the particles",
                      CaseLabel("body", body.name).with_key("mass"), Amount{body.mass, "kg"}, draught, min_draught},
                     {"give a mass of at least {:.3g} kg, or a spacing of at most {:.3g} m",
                      1.01 * min_draught * dx * per_draught, 0.99 * draught / min_draught})};
}

/// A warning for each key of a body that has an effect only on degrees of freedom that the body does not have.
template <int Dim>
Findings check_freedoms(const FloatingBody<Dim>& body) {
  Findings findings;
  const auto check_key = [&](std::string_view key, const Twist<Dim>& numbers) {
    for (int entry = 0; entry < numbers.size(); ++entry) {
      if (numbers[entry] == 0.0 || std::ranges::find(body.free, entry) != body.free.end()) continue;
      const std::string_view name = freedom_names[entry < Dim ? entry : entry + 1];  // 2D has no z, 3D no "rotation"
      findings.push_back(
          Finding::warning("body-number-without-effect",
                           {"{} has {:.4g} for {}, in which the body is not free to move: this number has no effect",
                            CaseLabel("body", body.name).with_key(key), numbers[entry], name},
                           {"add \"{}\" to `free`, or give 0", name}));
    }
  };
  check_key("springs", body.springs);
  check_key("damping", body.linear_damping);
  check_key("quadratic_damping", body.quadratic_damping);
  check_key("extra_mass", body.extra_mass);
  return findings;
}

/// dx; least radius of inertia. A body with less turns faster in its own spray than the pressure can follow (at 0.01 dx
/// runs failed after two steps, at 0.03 dx they did not).
constexpr double min_radius_of_inertia = 0.05;

template <int Dim>
Findings check_inertia(const CaseSpec& spec, const FloatingBody<Dim>& body) {
  for (const int entry : body.free) {
    if (entry < Dim) continue;
    const double inertia = body.inertia[entry - Dim];
    const double radius = std::sqrt(inertia / body.mass);
    const double least = min_radius_of_inertia * spec.particles.spacing;
    if (radius >= least) continue;
    return {Finding::error("inertia-too-small",
                           {"{} = {:.4g} with a mass of {:.4g} kg means a radius of inertia of {:.3g} m, less than {} "
                            "spacings: the rotation cannot be computed from the pressure of the particles",
                            CaseLabel("body", body.name).with_key("inertia"), Amount{inertia, "kg m^2"}, body.mass,
                            radius, min_radius_of_inertia},
                           {"give an inertia of at least {:.3g} kg m^2, or leave the rotation out of `free`",
                            1.01 * body.mass * least * least})};
  }
  return {};
}

/// An error for a body that is drawn at the end of a period, or is towed there: the walls of bodies have no image in
/// the next period. A body from end to end needs none.
template <int Dim>
Findings check_place_in_period(const CaseSpec& spec, const FloatingBody<Dim>& body, const Box<Dim>& box) {
  Findings findings;
  const double support = traits_of(spec).support * spec.particles.spacing;
  for (int axis = 0; axis < Dim; ++axis) {
    const std::vector<double>& range = periodic_range(spec.domain, axis);
    if (range.size() != 2 || box.sizes()[axis] > range[1] - range[0] - 0.5 * spec.particles.spacing) continue;
    const bool is_free = std::ranges::find(body.free, axis) != body.free.end();
    const double towed = is_free ? 0.0 : body.drawn.velocity[axis] * spec.time.end;
    const double low = box.min()[axis] + std::min(0.0, towed);
    const double high = box.max()[axis] + std::max(0.0, towed);
    if (low >= range[0] + support && high <= range[1] - support) continue;
    findings.push_back(Finding::error(
        "body-at-end-of-period",
        {"{} comes to {} = {:.4g}, less than {:.3g} from the end of the period at {:g} (domain.periodic_{}): the water "
         "beyond the end would not see the body",
         CaseLabel("body", body.name), "xyz"[axis], low < range[0] + support ? low : high, Amount{support, "m"},
         low < range[0] + support ? range[0] : range[1], "xyz"[axis]},
        {"draw it farther from the ends{}", towed != 0.0 ? ", and let the run end before it comes there" : ""}));
  }
  return findings;
}

}  // namespace

template <int Dim>
Findings check_bodies(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  Findings findings;
  for (const FloatingBody<Dim>& body : make_bodies<Dim>(spec)) {
    const Box<Dim> box = box_of_body(body, boundary);
    if (box.isEmpty()) continue;
    append(findings, check_mass(spec, body, box));
    append(findings, check_freedoms(body));
    append(findings, check_inertia(spec, body));
    append(findings, check_place_in_period(spec, body, box));
    const Vec<Dim>& centre = body.drawn.centre;
    const CaseLabel label("body", body.name);
    if (box.exteriorDistance(centre) > corner_tolerance * spec.particles.spacing) {
      findings.push_back(
          Finding::warning("centre-outside-body",
                           {"{} has its centre of mass at {}, outside of its walls, which lie between {} and {}", label,
                            place(centre), place<Dim>(box.min()), place<Dim>(box.max())},
                           {"give `centre` in coordinates of the case, where the body is drawn"}));
      continue;
    }
    const bool turns_freely = std::ranges::any_of(body.free, [](int entry) { return entry >= Dim; });
    const double radius = std::sqrt(body.inertia.maxCoeff() / body.mass);
    const double farthest = (centre - box.min()).cwiseMax(box.max() - centre).norm();
    if (turns_freely && radius > farthest) {
      findings.push_back(Finding::warning(
          "inertia-too-large",
          {"{} has an inertia of {:.4g}, as if its {:.4g} kg were {:.4g} m away from their centre, but the farthest "
           "point of its walls is {:.4g} m away",
           label, Amount{body.inertia.maxCoeff(), "kg m^2"}, body.mass, radius, farthest},
          {"give the moment of inertia about the centre, in kg m^2{}", Dim == 2 ? " per metre of width" : ""}));
    }
  }
  return findings;
}

/// Initial tension of a line over the weight of its body, above which it is most likely a mistake.
constexpr double most_tension = 10.0;

template <int Dim>
Findings check_moorings(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  Findings findings;
  const std::vector<FloatingBody<Dim>> bodies = make_bodies<Dim>(spec);
  const auto check_end = [&](const std::string& name, int of_body, const Vec<Dim>& x) {
    const FloatingBody<Dim>& body = bodies[of_body];
    const Box<Dim> box = box_of_body(body, boundary);
    const double away = box.isEmpty() ? 0.0 : box.exteriorDistance(x);
    if (away <= box.diagonal().norm()) return;
    findings.push_back(Finding::error(
        "mooring-far-from-body",
        {"{} is fastened at {}, {:.4g} from {}, which lies between {} and {}", CaseLabel("mooring", name), place(x),
         Amount{away, "m"}, CaseLabel("body", body.name), place<Dim>(box.min()), place<Dim>(box.max())},
        {"give `at` as a place on the first body as drawn, and `anchor` as the other end of the line, on the second "
         "body if there is one; for a hinge away from the body, name a small box there among the body's `walls`"}));
  };
  const double gravity = gravity_of<Dim>(spec).norm();
  const auto check_tension = [&](const std::string& name, const Mooring<Dim>& line) {
    const double distance = (line.anchor - line.at).norm();
    const double weight = gravity * bodies[line.body].mass;
    const double times = weight > 0.0 ? line.stiffness * (distance - line.length) / weight : 0.0;
    if (times <= most_tension) return;
    findings.push_back(Finding::warning(
        "mooring-taut-at-start",
        {"{} is {:.4g} long and spans {:.4g} at the start: it pulls with {:.2g} times the weight of {}",
         CaseLabel("mooring", name), Amount{line.length, "m"}, Amount{distance, "m"}, times,
         CaseLabel("body", bodies[line.body].name)},
        {"give a length near {:.4g} m, or less stiffness", distance}));
  };
  const std::vector<Mooring<Dim>> moorings = make_moorings<Dim>(spec);
  for (std::size_t m = 0; m < moorings.size(); ++m) {
    check_tension(spec.moorings[m].name, moorings[m]);
    check_end(spec.moorings[m].name, moorings[m].body, moorings[m].at);
    if (moorings[m].to_body >= 0) check_end(spec.moorings[m].name, moorings[m].to_body, moorings[m].anchor);
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_bodies);
TAILWATER_IN_2D_AND_3D(check_moorings);

}  // namespace tailwater
