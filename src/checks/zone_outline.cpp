#include "checks/zone_outline.h"

#include <algorithm>
#include <limits>

namespace tailwater {
namespace {

constexpr int cells = 150;  // along each side of the picture
constexpr int behind = 24;  // places across the picture in 3D

/// Largest depth in the zone at a place of the picture.
template <int Dim>
double deepest_behind(const SpacingField<Dim>& field, const typename SpacingField<Dim>::Zone& zone, const Box<Dim>& box,
                      const Vec<2>& place) {
  if constexpr (Dim == 2) {
    return field.depth_in(zone, place);
  } else {
    double deepest = std::numeric_limits<double>::lowest();
    for (int k = 0; k <= behind; ++k) {
      const double y = box.min()[1] + box.sizes()[1] * k / behind;
      deepest = std::max(deepest, field.depth_in(zone, Vec<3>(place[0], y, place[1])));
    }
    return deepest;
  }
}

}  // namespace

template <int Dim>
std::vector<std::array<Vec<2>, 2>> outline_of_zone(const SpacingField<Dim>& field,
                                                   const typename SpacingField<Dim>::Zone& zone, const Box<Dim>& box,
                                                   const View& view) {
  const Vec<2> step = (view.high - view.low) / cells;
  const auto node = [&](int a, int b) { return Vec<2>(view.low[0] + step[0] * a, view.low[1] + step[1] * b); };
  std::vector<double> depth;
  for (int b = 0; b <= cells; ++b) {
    for (int a = 0; a <= cells; ++a) depth.push_back(deepest_behind<Dim>(field, zone, box, node(a, b)));
  }
  const auto at = [&](int a, int b) { return depth[static_cast<std::size_t>(b) * (cells + 1) + a]; };
  std::vector<std::array<Vec<2>, 2>> lines;
  // The line through each triangle, two to a cell, between the places on its edges where the depth is 0.
  const auto add_triangle = [&](const std::array<std::array<int, 2>, 3>& corners) {
    std::vector<Vec<2>> ends;
    for (int k = 0; k < 3; ++k) {
      const auto [a, b] = corners[k];
      const auto [c, d] = corners[(k + 1) % 3];
      if ((at(a, b) > 0.0) == (at(c, d) > 0.0)) continue;
      const double share = at(a, b) / (at(a, b) - at(c, d));
      ends.push_back(node(a, b) + share * (node(c, d) - node(a, b)));
    }
    if (ends.size() == 2) lines.push_back({ends[0], ends[1]});
  };
  for (int b = 0; b < cells; ++b) {
    for (int a = 0; a < cells; ++a) {
      add_triangle({{{a, b}, {a + 1, b}, {a + 1, b + 1}}});
      add_triangle({{{a, b}, {a + 1, b + 1}, {a, b + 1}}});
    }
  }
  return lines;
}

template std::vector<std::array<Vec<2>, 2>> outline_of_zone(const SpacingField<2>&, const SpacingField<2>::Zone&,
                                                            const Box<2>&, const View&);
template std::vector<std::array<Vec<2>, 2>> outline_of_zone(const SpacingField<3>&, const SpacingField<3>::Zone&,
                                                            const Box<3>&, const View&);

}  // namespace tailwater
