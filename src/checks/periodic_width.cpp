#include <algorithm>
#include <cmath>

#include "base/box.h"
#include "case/formulation.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"

namespace tailwater {
namespace {

/// The walls that are longer along `axis` than the period `low` to `high` (m), after which they would be repeated, and
/// those that are drawn beyond it. Their particles repeat themselves, but their faces, by which probes and the last
/// guard know them, do not.
template <int Dim>
Findings walls_beyond(double low, double high, int axis, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  std::vector<Box<Dim>> boxes(boundary.walls.size());
  for (const WallFace<Dim>& face : boundary.faces) boxes[face.wall].extend(face.box());
  const double tolerance = 0.5 * spec.particles.spacing;
  Findings findings;
  for (std::size_t w = 0; w < boxes.size(); ++w) {
    if (boxes[w].isEmpty()) continue;
    const CaseLabel owner = wall_label(boundary, static_cast<int>(w));
    const double length = boxes[w].sizes()[axis];
    const double from = boxes[w].min()[axis];
    const double to = boxes[w].max()[axis];
    if (length > high - low + tolerance) {
      findings.push_back(Finding::error(
          "wall-longer-than-period",
          {"{} is {:.6g} long in {}, in which the case repeats itself every {:.6g} m (domain.periodic_{}), "
           "so it would overlap itself",
           owner, Amount{length, "m"}, "xyz"[axis], high - low, "xyz"[axis]},
          {"draw one period of it"}));
    } else if (from < low - tolerance || to > high + tolerance) {
      findings.push_back(Finding::error(
          "wall-beyond-period",
          {"{} reaches from {} = {:.6g} to {:.6g} m, beyond the period from {:.6g} to {:.6g} m (domain.periodic_{})",
           owner, "xyz"[axis], from, to, low, high, "xyz"[axis]},
          {"draw it in two parts, each within the period, or move the period"}));
    } else if (length <= tolerance && boundary.walls[w].is_plate &&
               std::min(std::abs(from - low), std::abs(to - high)) <= tolerance) {
      findings.push_back(Finding::error(
          "plate-between-periods",
          {"{} lies between two periods, at {} = {:.6g} m (domain.periodic_{}), where only one of its sides is known",
           owner, "xyz"[axis], from, "xyz"[axis]},
          {"move it into the period by a spacing or more, or move the period"}));
    }
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
    append(findings, walls_beyond(range[0], range[1], axis, spec, boundary));
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
