// Images of things in the other periods of a periodic domain.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/box.h"
#include "base/vec.h"

namespace tailwater {

/// The domain, widened by `margin` (m) in its periodic directions; without ends in the others.
template <int Dim>
Box<Dim> space_around(const PeriodicDomain<Dim>& domain, double margin) {
  Box<Dim> space;
  for (int axis = 0; axis < Dim; ++axis) {
    const double infinity = std::numeric_limits<double>::infinity();
    space.min()[axis] = domain[axis] ? domain[axis]->first - margin : -infinity;
    space.max()[axis] = domain[axis] ? domain[axis]->second + margin : infinity;
  }
  return space;
}

/// The equivalent of `position` inside a periodic domain.
template <int Dim>
Vec<Dim> wrapped(const PeriodicDomain<Dim>& domain, Vec<Dim> position) {
  for (int d = 0; d < Dim; ++d) {
    if (!domain[d]) continue;
    const auto [low, high] = *domain[d];
    const double length = high - low;
    position[d] -= length * std::floor((position[d] - low) / length);
  }
  return position;
}

/// Whether `x` is within `tolerance` (m) of a plane between two periods.
template <int Dim>
bool is_in_periodic_plane(const PeriodicDomain<Dim>& domain, const Vec<Dim>& x, double tolerance) {
  for (int axis = 0; axis < Dim; ++axis) {
    if (!domain[axis]) continue;
    const auto [low, high] = *domain[axis];
    if (std::min(std::abs(x[axis] - low), std::abs(x[axis] - high)) <= tolerance) return true;
  }
  return false;
}

/// Maximum number of images along an axis. Only a wall longer than the period, or a period narrower than the kernel,
/// has more; `check` refuses both.
constexpr double max_images = 16.0;
/// Maximum displacement of an image, in periods, so that it fits an int.
constexpr double max_displacement = 1e9;

/// Calls visit(displacement) for every image of the box in another period that reaches into `space`; for none if there
/// are too many.
template <int Dim, class Visit>
void visit_images(const PeriodicDomain<Dim>& domain, const Box<Dim>& box, const Box<Dim>& space, Visit&& visit) {
  std::array<int, Dim> first{};
  std::array<int, Dim> last{};
  Vec<Dim> length = Vec<Dim>::Zero();
  for (int axis = 0; axis < Dim; ++axis) {
    if (!domain[axis]) continue;
    length[axis] = domain[axis]->second - domain[axis]->first;
    const double from = std::ceil((space.min()[axis] - box.max()[axis]) / length[axis]);
    const double to = std::floor((space.max()[axis] - box.min()[axis]) / length[axis]);
    const bool is_near = std::abs(from) <= max_displacement && std::abs(to) <= max_displacement;
    if (!is_near || from > to || to - from > max_images) return;
    first[axis] = static_cast<int>(from);
    last[axis] = static_cast<int>(to);
  }
  std::array<int, Dim> k = first;
  for (int axis = 0; axis < Dim;) {
    if (k != std::array<int, Dim>{}) {
      Vec<Dim> displacement;
      for (int d = 0; d < Dim; ++d) displacement[d] = k[d] * length[d];
      visit(displacement);
    }
    for (axis = 0; axis < Dim && ++k[axis] > last[axis]; ++axis) k[axis] = first[axis];
  }
}

}  // namespace tailwater
