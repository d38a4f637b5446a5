#include "base/box.h"
#include "case/formulation.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"

namespace tailwater {
namespace {

/// The walls that are longer along `axis` than the `period` (m) after which they would be repeated.
template <int Dim>
Findings walls_longer_than(double period, int axis, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  std::vector<Box<Dim>> boxes(boundary.walls.size());
  for (const WallFace<Dim>& face : boundary.faces) boxes[face.wall].extend(face.box());
  Findings findings;
  for (std::size_t w = 0; w < boxes.size(); ++w) {
    const double length = boxes[w].isEmpty() ? 0.0 : boxes[w].sizes()[axis];
    if (length <= period + 0.5 * spec.particles.spacing) continue;
    findings.push_back(Finding::error(
        "wall-longer-than-period",
        {"{} is {:.6g} long in {}, in which the case repeats itself every {:.6g} m (domain.periodic_{}), "
         "so it would overlap itself",
         wall_label(boundary, static_cast<int>(w)), Amount{length, "m"}, "xyz"[axis], period, "xyz"[axis]},
        {"draw one period of it"}));
  }
  return findings;
}

}  // namespace

template <int Dim>
Findings check_periodic_width(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  Findings findings;
  const double support = traits_of(spec).support * spec.particles.spacing;
  for (int axis = 0; axis < Dim; ++axis) {
    const std::vector<double>& range = periodic_range(spec.domain, axis);
    if (range.size() != 2) continue;
    const double width = range[1] - range[0];
    append(findings, walls_longer_than(width, axis, spec, boundary));
    if (width >= (4.0 - corner_tolerance) * support) continue;
    findings.push_back(Finding::error("period-too-narrow",
                                      {"{} from {:.6g} to {:.6g} is {:.6g} wide, less than four kernel supports of "
                                       "{:.6g} m, so a particle would meet "
                                       "its own image",
                                       CaseLabel("domain").with_key(fmt::format("periodic_{}", "xyz"[axis])), range[0],
                                       range[1], Amount{width, "m"}, support},
                                      {"make it at least {:.6g} m wide, or the spacing at most {:.6g} m", 4.0 * support,
                                       width / (4.0 * traits_of(spec).support)}));
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_periodic_width);

}  // namespace tailwater
