// Small helpers for turning tables of the case file into shapes.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

#include "base/box.h"
#include "base/finding.h"
#include "base/vec.h"
#include "case/formulation.h"
#include "case/spec.h"

namespace tailwater {

/// `name`, or for the third wall, if it has no name, "wall3".
inline std::string name_or_number(const std::string& name, std::string_view what, std::size_t index) {
  return name.empty() ? fmt::format("{}{}", what, index + 1) : name;
}

inline CaseLabel fluid_label(const CaseSpec& spec, std::size_t block) {
  return CaseLabel("fluid", name_or_number(spec.fluid[block].name, "fluid", block));
}

inline CaseLabel label(const ProbeTable& probe) { return CaseLabel("probe", probe.name); }

/// Throws CaseError unless a `key` has Dim numbers.
template <int Dim>
void require_dimension(std::size_t count, const CaseLabel& key) {
  if (count == Dim) return;
  throw CaseError("wrong-dimension", {"{} has {} numbers but the case has {} dimensions", key, count, Dim},
                  {"give one number per dimension"});
}

/// The point under a `key` of the `owner` as a vector. Throws CaseError when it does not have Dim numbers.
template <int Dim>
Vec<Dim> to_vec(const Coordinates& point, const CaseLabel& owner, std::string_view key) {
  require_dimension<Dim>(point.size(), owner.with_key(key));
  return Vec<Dim>::Map(point.data());
}

template <int Dim>
Vec<Dim> gravity_of(const CaseSpec& spec) {
  return to_vec<Dim>(spec.physics.gravity, CaseLabel("physics"), "gravity");
}

/// A place that a message names and a picture marks.
template <int Dim>
MarkedPlace place(const Vec<Dim>& x) {
  MarkedPlace place{{}, Dim};
  for (int axis = 0; axis < Dim; ++axis) place.x[axis] = x[axis];
  return place;
}

/// A direction or a displacement in messages, such as "(0.5, 1.25)"; pictures do not mark it.
template <int Dim>
std::string vector_text(const Vec<Dim>& v) {
  return place(v).text();
}

/// Low and high end of periodic direction `axis`; empty where the domain is not periodic.
inline const std::vector<double>& periodic_range(const DomainTable& domain, int axis) {
  return axis == 0 ? domain.periodic_x : axis == 1 ? domain.periodic_y : domain.periodic_z;
}

template <int Dim>
PeriodicDomain<Dim> periodic_domain(const DomainTable& domain) {
  PeriodicDomain<Dim> periodic;
  for (int d = 0; d < Dim; ++d) {
    const std::vector<double>& range = periodic_range(domain, d);
    if (!range.empty()) periodic[d] = std::pair{range[0], range[1]};
  }
  return periodic;
}

/// Number of layers of dummy particles that fill the kernel's support behind a wall, including a row on the wall.
inline int dummy_layers(const CaseSpec& spec) { return static_cast<int>(std::ceil(traits_of(spec).support)); }

/// Area of a polygon, m^2; positive when its corners run counter-clockwise.
template <class Points>
double signed_area(const Points& corners) {
  double twice = 0.0;
  for (std::size_t i = 0, last = corners.size() - 1; i < corners.size(); last = i++) {
    twice += corners[last][0] * corners[i][1] - corners[i][0] * corners[last][1];
  }
  return 0.5 * twice;
}

}  // namespace tailwater
