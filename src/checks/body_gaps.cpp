#include <algorithm>
#include <array>
#include <optional>

#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"
#include "motion/body_contact.h"

namespace tailwater {
namespace {

/// dx; minimum sum of the gaps on both sides of a body. Water does not pass smaller gaps: trapped water can neither
/// leave nor be compressed, and its pressure moves the body arbitrarily. A box that falls into a tank failed with a sum
/// of up to 2, and with 3 at no spacing.
constexpr double min_sum = 3.0;

/// Minimum cosine: a wall is on a side of a body if it faces that side within 45 degrees.
constexpr double min_facing_side = 0.7;

/// The nearest wall at rest on one side of a body.
template <int Dim>
struct SideGap {
  double width;  ///< m
  int wall;
  Vec<Dim> where;
};

template <int Dim>
using SideGaps = std::array<std::optional<SideGap<Dim>>, 2 * Dim>;  ///< by axis, the lower side first

/// The walls at rest nearer than `reach` [m] to a body, as drawn.
template <int Dim>
SideGaps<Dim> side_gaps_of(const std::vector<Vec<Dim>>& points, const Boundary<Dim>& resting, double reach) {
  SideGaps<Dim> gaps;
  for (const Vec<Dim>& x : points) {
    const NearestWall<Dim> near = resting.nearest(x, reach);
    if (near.face < 0 || std::abs(near.signed_distance) >= reach) continue;
    const WallFace<Dim>& face = resting.faces[near.face];
    for (int axis = 0; axis < Dim; ++axis) {
      if (std::abs(face.normal[axis]) < min_facing_side) continue;
      auto& gap = gaps[2 * axis + (face.normal[axis] > 0.0 ? 0 : 1)];
      const double width = std::max(0.0, near.signed_distance);
      if (!gap || width < gap->width) gap = SideGap<Dim>{width, face.wall, x};
    }
  }
  return gaps;
}

/// The gap on the narrower side of a body along an axis, with the width of both; none if water can pass there.
template <int Dim>
std::optional<SideGap<Dim>> both_gaps(const SideGaps<Dim>& gaps, int axis, double least) {
  const auto& low = gaps[2 * axis];
  const auto& high = gaps[2 * axis + 1];
  if (!low || !high || low->width + high->width >= least) return std::nullopt;
  SideGap<Dim> both = low->width < high->width ? *low : *high;
  both.width = low->width + high->width;
  return both;
}

/// Whether a body spans a periodic direction.
template <int Dim>
bool spans_period(const CaseSpec& spec, const std::vector<Vec<Dim>>& points, int axis) {
  const std::vector<double>& range = periodic_range(spec.domain, axis);
  if (range.size() != 2 || points.empty()) return false;
  const auto along = [axis](const Vec<Dim>& a, const Vec<Dim>& b) { return a[axis] < b[axis]; };
  const auto [least, most] = std::ranges::minmax(points, along);
  return most[axis] - least[axis] > range[1] - range[0] - min_sum * spec.particles.spacing;
}

template <int Dim>
Finding body_gap_finding(const CaseSpec& spec, const Boundary<Dim>& boundary, const std::string& body,
                         const SideGap<Dim>& gap) {
  const double dx = spec.particles.spacing;
  const Clause finer =
      gap.width > 0.1 * dx ? Clause(", or use a spacing of at most {:.3g} m", 0.99 * gap.width / min_sum) : Clause();
  return Finding::error(
      "body-gaps-too-narrow",
      {"the gaps on both sides of {}, such as the gap to {} at {}, are together {:.3g} wide, {:.2g} spacings: "
       "water cannot pass the body",
       CaseLabel("body", body), wall_label(boundary, gap.wall), place(gap.where), Amount{gap.width, "m"},
       gap.width / dx},
      {"leave {:.3g} m or more on one side of the body{}", 1.01 * min_sum * dx, finer});
}

/// The gap that prevents water from passing a body; none if it can pass.
template <int Dim>
std::optional<SideGap<Dim>> closing_gap(const CaseSpec& spec, const std::vector<Vec<Dim>>& points,
                                        const Boundary<Dim>& resting, int upright) {
  const double least = min_sum * spec.particles.spacing;
  const SideGaps<Dim> gaps = side_gaps_of(points, resting, least);
  std::optional<SideGap<Dim>> widest;
  for (int axis = 0; axis < Dim; ++axis) {
    if (axis == upright || spans_period(spec, points, axis)) continue;
    const auto gap = both_gaps(gaps, axis, least);
    if (!gap) return std::nullopt;
    if (!widest || gap->width > widest->width) widest = gap;
  }
  return widest;
}

}  // namespace

template <int Dim>
Findings check_body_gaps(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const std::vector<FloatingBody<Dim>> bodies = make_bodies<Dim>(spec);
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  // Enclosed air yields to a body that closes its space.
  if (bodies.empty() || gravity.isZero(0.0) || spec.air.pockets != AirPockets::none) return {};
  int upright = 0;
  gravity.cwiseAbs().maxCoeff(&upright);
  const ContactSurfaces<Dim> contact = make_contact_surfaces(boundary, bodies, spec.particles.spacing);
  Findings findings;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (std::ranges::find(bodies[b].free, upright) == bodies[b].free.end()) continue;
    const auto gap = closing_gap(spec, contact.points[b], contact.each.front().boundary, upright);
    if (gap) findings.push_back(body_gap_finding(spec, boundary, bodies[b].name, *gap));
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_body_gaps);

}  // namespace tailwater
