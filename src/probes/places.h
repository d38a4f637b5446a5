// The places that represent a stretch.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/from_spec.h"

namespace tailwater {

/// The key `step`; 0 means dx. Throws CaseError where it is so small that particles cannot resolve its places.
inline double step_of(const ProbeTable& probe, double spacing) {
  constexpr double least = 0.1;  // dx
  if (probe.step > 0.0 && probe.step < least * spacing) {
    throw CaseError("probe-step-too-small",
                    {"{} = {} is below {} dx = {:.4g} m, which particles cannot resolve", label(probe).with_key("step"),
                     Amount{probe.step, "m"}, least, least * spacing},
                    {"make it larger"});
  }
  return probe.step > 0.0 ? probe.step : spacing;
}

/// Maximum number of places of a probe; each of them is read separately.
inline constexpr double max_places = 1e6;

/// Throws CaseError if there are too many places, before memory is requested for them.
inline void require_few_places(const ProbeTable& probe, double places) {
  if (places <= max_places) return;
  throw CaseError("probe-too-many-places",
                  {"{} has {:.3g} places, and at most {:.3g} are possible", label(probe), places, max_places},
                  {"give a larger step, or a smaller part of the channel"});
}

/// The number of equal pieces of at most `step` [m]. A whole number of steps keeps that number despite rounding.
inline int pieces_of_at_most(double step, double length) {
  return std::max(1, static_cast<int>(std::ceil(length / step - 1e-6)));
}

/// Places from `from` to `to` at equal distances of at most `step` [m]. They are the midpoints of equal pieces, so that
/// their mean is the mean over the stretch.
template <int Dim>
std::vector<Vec<Dim>> places_between(const ProbeTable& probe, double step) {
  const Vec<Dim> from = to_vec<Dim>(probe.from, label(probe), "from");
  const Vec<Dim> to = to_vec<Dim>(probe.to, label(probe), "to");
  require_few_places(probe, (to - from).norm() / step);
  const int count = pieces_of_at_most(step, (to - from).norm());
  std::vector<Vec<Dim>> places;
  for (int k = 0; k < count; ++k) places.push_back(from + (k + 0.5) / count * (to - from));
  return places;
}

}  // namespace tailwater
