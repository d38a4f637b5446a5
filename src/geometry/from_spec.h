// Small helpers for turning tables of the case file into shapes.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/vec.h"
#include "case/formulation.h"
#include "case/spec.h"

namespace tailwater {

/// `name`, or for the third wall, if it has no name, "wall3".
inline std::string name_or_number(const std::string& name, std::string_view what, std::size_t index) {
  return name.empty() ? fmt::format("{}{}", what, index + 1) : name;
}

/// "fluid 'column'": the name of a block in messages.
inline std::string fluid_label(const CaseSpec& spec, std::size_t block) {
  return fmt::format("fluid '{}'", name_or_number(spec.fluid[block].name, "fluid", block));
}

/// The point as a vector. Throws InputError, which names the `owner` ("wall 'bed'") and the `key` ("points[2]"), when
/// it does not have Dim numbers.
template <int Dim>
Vec<Dim> to_vec(const Coordinates& point, std::string_view owner, std::string_view key) {
  if (point.size() != Dim) {
    throw InputError("{}: {} has {} numbers but the case has {} dimensions: give one number per dimension", owner, key,
                     point.size(), Dim);
  }
  return Eigen::Map<const Vec<Dim>>(point.data());
}

template <int Dim>
Vec<Dim> gravity_of(const CaseSpec& spec) {
  return to_vec<Dim>(spec.physics.gravity, "[physics]", "gravity");
}

/// "(0.5, 1.25)": a place in messages, to the picometre, so that round-off is not shown.
template <int Dim>
std::string place(Vec<Dim> x) {
  for (double& coordinate : x) coordinate = std::abs(coordinate) < 1e-12 ? 0.0 : coordinate;
  return Dim == 2 ? fmt::format("({:.6g}, {:.6g})", x[0], x[1])
                  : fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[Dim - 1]);
}

/// Low and high end of periodic direction `axis`; empty where the domain is not periodic.
inline const std::vector<double>& periodic_range(const DomainTable& domain, int axis) {
  return axis == 0 ? domain.periodic_x : axis == 1 ? domain.periodic_y : domain.periodic_z;
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
