#include "geometry/outlet.h"

#include <cmath>

#include "geometry/from_spec.h"

namespace tailwater {
namespace {

/// Least sine of the angle between an outlet's plane and its direction. Below it the outer side is not clear.
constexpr double least_sine = 0.1;

std::array<Vec<2>, 1> edges_between(const Vec<2>& from, const Vec<2>& to, double, const std::string&) {
  return {to - from};
}

std::array<Vec<3>, 2> edges_between(const Vec<3>& from, const Vec<3>& to, double tolerance, const std::string& owner) {
  const Vec<3> diagonal = to - from;
  std::vector<Vec<3>> edges;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(diagonal[axis]) > tolerance) edges.push_back(diagonal[axis] * Vec<3>::Unit(axis));
  }
  if (edges.size() != 2) {
    throw InputError(
        fmt::format("{}: from {} to {} is not a flat rectangle: in 3D give two opposite corners that have exactly one "
                    "coordinate in common",
                    owner, place(from), place(to)));
  }
  return {edges[0], edges[1]};
}

Vec<2> across(const std::array<Vec<2>, 1>& edges) { return Vec<2>(-edges[0][1], edges[0][0]).normalized(); }
Vec<3> across(const std::array<Vec<3>, 2>& edges) { return edges[0].cross(edges[1]).normalized(); }

}  // namespace

template <int Dim>
bool Outlet<Dim>::spans(const Vec<Dim>& x) const {
  for (const Vec<Dim>& edge : edges) {
    const double along = edge.dot(x - corner);
    if (along < 0.0 || along > edge.squaredNorm()) return false;
  }
  return true;
}

template <int Dim>
std::vector<WallFace<Dim>> Outlet<Dim>::as_faces() const {
  if constexpr (Dim == 2) {
    return {{{corner, corner + edges[0]}, -normal, -1}};
  } else {
    const Vec<3> opposite = corner + edges[0] + edges[1];
    return {{{corner, corner + edges[0], opposite}, -normal, -1}, {{corner, opposite, corner + edges[1]}, -normal, -1}};
  }
}

template <int Dim>
std::vector<Outlet<Dim>> make_outlets(const CaseSpec& spec) {
  std::vector<Outlet<Dim>> outlets;
  for (std::size_t k = 0; k < spec.outlets.size(); ++k) {
    const OutletTable& table = spec.outlets[k];
    Outlet<Dim> outlet;
    outlet.name = name_or_number(table.name, "outlet", k);
    const std::string owner = outlet.label();
    const Vec<Dim> from = to_vec<Dim>(table.from, owner, "from");
    const Vec<Dim> to = to_vec<Dim>(table.to, owner, "to");
    const double tolerance = corner_tolerance * spec.particles.spacing;
    if ((to - from).norm() <= tolerance) {
      throw InputError(
          fmt::format("{} has no extent: from and to are both at {}; give its two ends", owner, place(from)));
    }
    outlet.corner = from;
    outlet.edges = edges_between(from, to, tolerance, owner);
    const Vec<Dim> direction = to_vec<Dim>(table.direction, owner, "direction").normalized();
    outlet.normal = across(outlet.edges);
    const double sine = outlet.normal.dot(direction);
    if (std::abs(sine) < least_sine) {
      throw InputError(fmt::format(
          "{} from {} to {} lies along its direction {}, so it has no outside: give the direction in "
          "which the water leaves, such as {} or {}",
          owner, place(from), place(to), place(direction), place(outlet.normal), place(Vec<Dim>(-outlet.normal))));
    }
    if (sine < 0.0) outlet.normal = -outlet.normal;
    outlets.push_back(outlet);
  }
  return outlets;
}

template struct Outlet<2>;
template struct Outlet<3>;
template std::vector<Outlet<2>> make_outlets(const CaseSpec&);
template std::vector<Outlet<3>> make_outlets(const CaseSpec&);

}  // namespace tailwater
