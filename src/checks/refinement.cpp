#include "refinement/spacing_field.h"

#include "checks/checks.h"
#include "geometry/from_spec.h"

namespace tailwater {
namespace {

/// dx; from a zone to what particles of several spacings do not work with.
constexpr double clearance = 4.0;

Finding refused(const CaseLabel& owner, const std::string& what, Clause remedy) {
  return Finding::error({"{}: zones of refinement do not work with {}", owner, what}, std::move(remedy));
}

/// Features of the case that no zone works with, wherever it is.
Findings check_features(const CaseSpec& spec, const CaseLabel& owner) {
  Findings findings;
  const auto refuse = [&](bool is_given, const std::string& what, Clause remedy) {
    if (is_given) findings.push_back(refused(owner, what, std::move(remedy)));
  };
  const SchemeTable& scheme = spec.scheme;
  refuse(spec.general.dimension == 3, "three dimensions", {"remove the zone, or compute a section in 2D"});
  refuse(scheme.formulation == Formulation::published, "published formulations", {"give formulation = \"robust\""});
  refuse(scheme.name == SchemeName::farmani2020, "the two-step scheme", {"give name = \"farzin2014\" in [scheme]"});
  refuse(scheme.integrator == Integrator::implicit_projection, "the implicit integrator",
         {"give integrator = \"explicit\" in [scheme]"});
  refuse(scheme.pair_vectors != PairVectors::corrected, "other pair vectors than the default",
         {"give pair_vectors = \"corrected\" in [scheme]"});
  refuse(spec.air.pockets != AirPockets::none, "enclosed air", {"give pockets = \"none\" in [air]"});
  refuse(!spec.porous.empty(), "porous layers", {"remove the zone or the layers"});
  refuse(!spec.inlets.empty() || !spec.outlets.empty(), "inlets and outlets", {"remove the zone or the open ends"});
  refuse(!spec.bodies.empty(), "floating bodies", {"remove the zone or the bodies"});
  return findings;
}

/// Whether a zone ends or fades within the repeated stretch on one side of a period and not on the other.
template <int Dim>
Findings check_period(const CaseSpec& spec, const RefinementTable& table, const CaseLabel& owner) {
  Findings findings;
  int periodic = 0;
  for (int axis = 0; axis < Dim; ++axis) {
    const std::vector<double>& range = periodic_range(spec.domain, axis);
    if (range.empty()) continue;
    ++periodic;
    const bool is_below = table.min[axis] <= range[0];
    const bool is_above = table.max[axis] >= range[1];
    if (is_below == is_above) continue;
    findings.push_back(Finding::error(
        {"{} reaches over one end of the periodic direction {}, which goes from {:g} to {:g}, and not over the other: "
         "the spacing would jump there",
         owner, "xyz"[axis], range[0], range[1]},
        {"let it reach over both ends, or end it between them"}));
  }
  if (periodic == Dim) findings.push_back(refused(owner, "a domain that is periodic in all directions", {"add walls"}));
  return findings;
}

/// A zone that is narrower than its borders.
template <int Dim>
Findings check_width(const CaseSpec& spec, const Eigen::AlignedBox<double, Dim>& all,
                     const typename SpacingField<Dim>::Zone& zone, const CaseLabel& owner) {
  for (int axis = 0; axis < Dim; ++axis) {
    const bool has_low = std::isfinite(zone.box.min()[axis]);
    const bool has_high = std::isfinite(zone.box.max()[axis]);
    const double low = has_low ? zone.box.min()[axis] : all.min()[axis];
    const double high = has_high ? zone.box.max()[axis] : all.max()[axis];
    const double needed = zone.border * (static_cast<int>(has_low) + static_cast<int>(has_high));
    if (high - low >= needed - corner_tolerance * spec.particles.spacing) continue;
    return {Finding::error(
        {"{} is {:.4g} long in {}, but the spacing needs {:.4g} m to fall by its level behind each face: nowhere would "
         "it be as fine as asked",
         owner, Amount{high - low, "m"}, "xyz"[axis], zone.border},
        {"make the zone at least {:.4g} m long, let it reach to the outermost walls, or use a lower level", needed})};
  }
  return {};
}

/// Walls near a zone whose particles it cannot divide.
template <int Dim>
Findings check_walls(const CaseSpec& spec, const Boundary<Dim>& boundary, const typename SpacingField<Dim>::Zone& zone,
                     const CaseLabel& owner) {
  const double margin = clearance * spec.particles.spacing;
  Findings findings;
  for (const Screen<Dim>& screen : boundary.screens) {
    Eigen::AlignedBox<double, Dim> around = screen.box();
    around.min().array() -= margin;
    around.max().array() += margin;
    if (!boundary.walls[screen.wall].is_plate || !zone.box.intersects(around)) continue;
    findings.push_back(refused(
        owner, fmt::format("plates within {:g} spacings, as at {}", clearance, place<Dim>(screen.corner).text()),
        {"keep the zone away from {}", wall_label(boundary, screen.wall)}));
    return findings;
  }
  for (const WallFace<Dim>& face : boundary.faces) {
    if (!boundary.walls[face.wall].moves()) continue;
    findings.push_back(
        refused(owner, "walls that move", {"remove the zone, or the motion of {}", wall_label(boundary, face.wall)}));
    return findings;
  }
  return findings;
}

}  // namespace

template <int Dim>
Findings check_refinement(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid) {
  Findings findings;
  const SpacingField<Dim> field(spec, drawn);
  const Eigen::AlignedBox<double, Dim> box = fluid.box().merged(box_around(drawn.faces));
  for (std::size_t n = 0; n < spec.refinement.size(); ++n) {
    const RefinementTable& table = spec.refinement[n];
    const CaseLabel owner("refinement", table.name);
    const auto& zone = field.zones()[n];
    append(findings, check_features(spec, owner));
    if (!box.intersects(zone.box)) {
      findings.push_back(Finding::error({"{} is outside of the case, whose walls and water lie between {} and {}: it "
                                         "would refine nothing",
                                         owner, place<Dim>(box.min()), place<Dim>(box.max())},
                                        {"move it to where the water is to be finer"}));
      continue;
    }
    append(findings, check_period<Dim>(spec, table, owner));
    append(findings, check_width<Dim>(spec, box, zone, owner));
    append(findings, check_walls(spec, drawn, zone, owner));
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_refinement);

}  // namespace tailwater
