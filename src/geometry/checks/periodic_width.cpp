#include "geometry/checks/checks.h"
#include "geometry/from_spec.h"

namespace tailwater {

template <int Dim>
Findings check_periodic_width(const CaseSpec& spec) {
  Findings findings;
  const double support = spec.scheme.support * spec.particles.spacing;
  for (int axis = 0; axis < Dim; ++axis) {
    const std::vector<double>& range = periodic_range(spec.domain, axis);
    if (range.size() != 2) continue;
    const double width = range[1] - range[0];
    if (width >= (4.0 - corner_tolerance) * support) continue;
    findings.push_back(Finding::error(
        "domain.periodic_{} from {:.6g} to {:.6g} is {:.6g} m wide, less than four kernel supports of {:.6g} m, so a "
        "particle "
        "would meet its own image: make it at least {:.6g} m wide, or the spacing at most {:.6g} m",
        "xyz"[axis], range[0], range[1], width, support, 4.0 * support, width / (4.0 * spec.scheme.support)));
  }
  return findings;
}

template Findings check_periodic_width<2>(const CaseSpec&);
template Findings check_periodic_width<3>(const CaseSpec&);

}  // namespace tailwater
