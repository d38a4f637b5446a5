#include "geometry/opening.h"

#include <cmath>

#include "geometry/from_spec.h"

namespace tailwater {
namespace {

/// Least sine of the angle between an opening's plane and its direction. Below it the outer side is not clear.
constexpr double least_sine = 0.1;

std::array<Vec<2>, 1> edges_between(const Vec<2>& from, const Vec<2>& to, double, const CaseLabel&) {
  return {to - from};
}

std::array<Vec<3>, 2> edges_between(const Vec<3>& from, const Vec<3>& to, double tolerance, const CaseLabel& owner) {
  const Vec<3> diagonal = to - from;
  std::vector<Vec<3>> edges;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(diagonal[axis]) > tolerance) edges.push_back(diagonal[axis] * Vec<3>::Unit(axis));
  }
  if (edges.size() != 2) {
    throw CaseError({"{} from {} to {} is not a flat rectangle", owner, place(from), place(to)},
                    {"in 3D give two opposite corners that have exactly one coordinate in common"});
  }
  return {edges[0], edges[1]};
}

Vec<2> across(const std::array<Vec<2>, 1>& edges) { return Vec<2>(-edges[0][1], edges[0][0]).normalized(); }
Vec<3> across(const std::array<Vec<3>, 2>& edges) { return edges[0].cross(edges[1]).normalized(); }

}  // namespace

template <int Dim>
CaseLabel Opening<Dim>::label() const {
  const char* what = kind == OpeningKind::inlet ? "inlet" : kind == OpeningKind::outlet ? "outlet" : "probe";
  return CaseLabel(what, name);
}

template <int Dim>
bool Opening<Dim>::spans(const Vec<Dim>& x) const {
  for (const Vec<Dim>& edge : edges) {
    const double along = edge.dot(x - corner);
    if (along < 0.0 || along > edge.squaredNorm()) return false;
  }
  return true;
}

template <int Dim>
std::vector<WallFace<Dim>> Opening<Dim>::as_faces() const {
  if constexpr (Dim == 2) {
    return {{{corner, corner + edges[0]}, -normal, -1}};
  } else {
    const Vec<3> opposite = corner + edges[0] + edges[1];
    return {{{corner, corner + edges[0], opposite}, -normal, -1}, {{corner, opposite, corner + edges[1]}, -normal, -1}};
  }
}

namespace {

/// The opening between two places, with its normal in the rough direction.
template <int Dim>
Opening<Dim> make_opening(OpeningKind kind, std::string name, const Coordinates& from_key, const Coordinates& to_key,
                          const Coordinates& direction_key, double spacing) {
  Opening<Dim> opening;
  opening.kind = kind;
  opening.name = std::move(name);
  const CaseLabel owner = opening.label();
  const Vec<Dim> from = to_vec<Dim>(from_key, owner, "from");
  const Vec<Dim> to = to_vec<Dim>(to_key, owner, "to");
  const double tolerance = corner_tolerance * spacing;
  if ((to - from).norm() <= tolerance) {
    throw CaseError({"{} has no extent: from and to are both at {}", owner, place(from)}, {"give its two ends"});
  }
  opening.corner = from;
  opening.edges = edges_between(from, to, tolerance, owner);
  const Vec<Dim> direction = to_vec<Dim>(direction_key, owner, "direction").normalized();
  opening.normal = across(opening.edges);
  const double sine = opening.normal.dot(direction);
  if (std::abs(sine) < least_sine) {
    throw CaseError({"{} from {} to {} lies along its direction {}, so it has no outside", owner, place(from),
                     place(to), vector_text(direction)},
                    {"give the direction in which the water goes, such as {} or {}", vector_text(opening.normal),
                     vector_text(Vec<Dim>(-opening.normal))});
  }
  if (sine < 0.0) opening.normal = -opening.normal;
  return opening;
}

}  // namespace

template <int Dim>
std::vector<Opening<Dim>> make_open_ends(const CaseSpec& spec) {
  const double dx = spec.particles.spacing;
  std::vector<Opening<Dim>> openings;
  for (std::size_t k = 0; k < spec.inlets.size(); ++k) {
    const InletTable& table = spec.inlets[k];
    openings.push_back(make_opening<Dim>(OpeningKind::inlet, name_or_number(table.name, "inlet", k), table.from,
                                         table.to, table.direction, dx));
    openings.back().normal *= -1.0;  // its direction is the way in
  }
  for (std::size_t k = 0; k < spec.outlets.size(); ++k) {
    const OutletTable& table = spec.outlets[k];
    openings.push_back(make_opening<Dim>(OpeningKind::outlet, name_or_number(table.name, "outlet", k), table.from,
                                         table.to, table.direction, dx));
  }
  return openings;
}

template <int Dim>
Opening<Dim> make_section(const ProbeTable& probe, double spacing) {
  return make_opening<Dim>(OpeningKind::section, probe.name, probe.from, probe.to, probe.direction, spacing);
}

template struct Opening<2>;
template struct Opening<3>;
TAILWATER_IN_2D_AND_3D(make_open_ends);
TAILWATER_IN_2D_AND_3D(make_section);

}  // namespace tailwater
