#include "geometry/opening.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/box.h"
#include "geometry/boundary.h"
#include "geometry/from_spec.h"
#include "geometry/plane_section.h"

namespace tailwater {
namespace {

/// Least sine of the angle between an opening's plane and its direction. Below it the outer side is not clear.
constexpr double min_sine = 0.1;
constexpr double flat_within = 0.1;  // dx, of the corners of a polygon from its plane

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
    throw CaseError("opening-not-flat", {"{} from {} to {} is not a flat rectangle", owner, place(from), place(to)},
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
  if constexpr (Dim == 3) {
    if (outline.corners().empty()) return true;
    const Vec<2> along(edges[0].normalized().dot(x - corner), edges[1].normalized().dot(x - corner));
    return outline.where(along) != Where::outside;
  }
  return true;
}

template <int Dim>
double Opening<Dim>::aside(const Vec<Dim>& x) const {
  double farthest = -std::numeric_limits<double>::infinity();
  for (const Vec<Dim>& edge : edges) {
    const double length = edge.norm();
    const double along = edge.dot(x - corner) / length;
    farthest = std::max({farthest, -along, along - length});
  }
  return farthest;
}

template <int Dim>
std::vector<Vec<Dim>> Opening<Dim>::rim() const {
  if constexpr (Dim == 2) {
    return {corner, corner + edges[0]};
  } else {
    if (outline.corners().empty()) {
      return {corner, corner + edges[0], corner + edges[0] + edges[1], corner + edges[1]};
    }
    std::vector<Vec<3>> rim;
    for (const Vec<2>& x : outline.corners()) {
      rim.push_back(corner + x[0] * edges[0].normalized() + x[1] * edges[1].normalized());
    }
    return rim;
  }
}

template <int Dim>
Opening<Dim> Opening<Dim>::moved_out(double distance) const {
  Opening moved = *this;
  moved.corner += distance * normal;
  return moved;
}

template <int Dim>
std::vector<WallFace<Dim>> Opening<Dim>::as_faces() const {
  if constexpr (Dim == 2) {
    return {{{corner, corner + edges[0]}, -normal, -1}};
  } else {
    const std::vector<Vec<3>> corners = rim();
    if (corners.size() == 4) {
      return {{{corners[0], corners[1], corners[2]}, -normal, -1}, {{corners[0], corners[2], corners[3]}, -normal, -1}};
    }
    std::vector<WallFace<3>> faces;
    for (const std::array<int, 3>& t : triangles_in(outline.corners())) {
      faces.push_back({{corners[t[0]], corners[t[1]], corners[t[2]]}, -normal, -1});
    }
    return faces;
  }
}

namespace {

/// Gives the opening its normal, with the direction in which water is meant to pass.
template <int Dim>
void turn_to(const Vec<Dim>& direction, Opening<Dim>& opening) {
  opening.normal = across(opening.edges);
  const double sine = opening.normal.dot(direction);
  if (std::abs(sine) < min_sine) {
    throw CaseError("opening-along-direction",
                    {"{} at {} lies along its direction {}, so it has no outside", opening.label(),
                     place(opening.corner), vector_text(direction)},
                    {"give the direction in which the water goes, such as {} or {}", vector_text(opening.normal),
                     vector_text(Vec<Dim>(-opening.normal))});
  }
  if (sine < 0.0) opening.normal = -opening.normal;
}

/// The segment or rectangle between two places.
template <int Dim>
void span(const Coordinates& from_key, const Coordinates& to_key, double spacing, Opening<Dim>& opening) {
  const CaseLabel owner = opening.label();
  const Vec<Dim> from = to_vec<Dim>(from_key, owner, "from");
  const Vec<Dim> to = to_vec<Dim>(to_key, owner, "to");
  const double tolerance = corner_tolerance * spacing;
  if ((to - from).norm() <= tolerance) {
    throw CaseError("opening-without-extent", {"{} has no extent: from and to are both at {}", owner, place(from)},
                    {"give its two ends"});
  }
  opening.corner = from;
  opening.edges = edges_between(from, to, tolerance, owner);
}

/// Unit vector up in the plane at right angles to `normal`; any in a level plane.
Vec<3> upright_in_plane(const Vec<3>& normal, const Vec<3>& gravity) {
  const Vec<3> rise = normal.dot(gravity) * normal - gravity;
  if (rise.norm() > min_sine * gravity.norm()) return rise.normalized();
  int axis = 0;
  normal.cwiseAbs().minCoeff(&axis);
  return (Vec<3>::Unit(axis) - normal[axis] * normal).normalized();
}

/// The polygon with these corners, all of them in the plane at right angles to `normal`. The second edge of the
/// rectangle around it is upright if the plane has a slope.
void outline(const std::vector<Vec<3>>& corners, const Vec<3>& normal, const Vec<3>& gravity, double spacing,
             Opening<3>& opening) {
  const Vec<3> rise = upright_in_plane(normal, gravity);
  const Vec<3> aside = rise.cross(normal);
  Box<2> box;
  std::vector<Vec<2>> flat;
  for (const Vec<3>& x : corners) {
    flat.emplace_back(aside.dot(x - corners[0]), rise.dot(x - corners[0]));
    box.extend(flat.back());
  }
  for (Vec<2>& x : flat) x -= box.min();
  opening.corner = corners[0] + box.min()[0] * aside + box.min()[1] * rise;
  opening.edges = {box.sizes()[0] * aside, box.sizes()[1] * rise};
  opening.normal = normal;
  opening.outline = Polygon(std::move(flat), corner_tolerance * spacing);
}

/// A polygon that has as many corners as a disc has spacings around it, and its area.
std::vector<Vec<3>> corners_of_disc(const Vec<3>& centre, double radius, const Vec<3>& normal, double spacing) {
  const double around = 2.0 * std::numbers::pi;
  const int count = std::max(16, static_cast<int>(std::ceil(around * radius / spacing)));
  const double corner_radius = radius * std::sqrt(around / (count * std::sin(around / count)));
  const Vec<3> first = upright_in_plane(normal, Vec<3>::Zero());
  const Vec<3> second = normal.cross(first);
  std::vector<Vec<3>> corners;
  for (int k = 0; k < count; ++k) {
    const double angle = around * k / count;
    corners.push_back(centre + corner_radius * (std::cos(angle) * first + std::sin(angle) * second));
  }
  return corners;
}

/// The corners that the case gives, if they lie in a plane.
std::vector<Vec<3>> corners_of_polygon(const Section& section, const CaseLabel& owner, double spacing, Vec<3>& normal) {
  std::vector<Vec<3>> corners;
  for (std::size_t k = 0; k < section.polygon.size(); ++k) {
    corners.push_back(to_vec<3>(section.polygon[k], owner, fmt::format("polygon[{}]", k)));
  }
  normal.setZero();
  for (std::size_t k = 0; k < corners.size(); ++k) normal += corners[k].cross(corners[(k + 1) % corners.size()]);
  if (normal.norm() <= spacing * spacing) {
    throw CaseError("opening-without-area", {"{}: its polygon encloses no area", owner},
                    {"give the corners of a flat polygon in order"});
  }
  normal.normalize();
  for (const Vec<3>& x : corners) {
    const double off = std::abs(normal.dot(x - corners[0]));
    if (off <= flat_within * spacing) continue;
    throw CaseError("opening-corners-off-plane",
                    {"{}: the corner {} of its polygon is {:.3g} out of the plane of the others", owner, place(x),
                     Amount{off, "m"}},
                    {"give corners that lie in a plane"});
  }
  return corners;
}

/// The corners of the part of a plane between the walls.
std::vector<Vec<3>> corners_through_point(const Section& section, OpeningKind kind, const CaseLabel& owner,
                                          const Vec<3>& direction, const CaseSpec& spec) {
  std::vector<Vec<3>> corners;
  for (const Coordinates& x : section.found) corners.push_back(to_vec<3>(x, owner, "through"));
  if (!corners.empty()) return corners;
  const Vec<3> point = to_vec<3>(section.through, owner, "through");
  const Vec<3> outwards = kind == OpeningKind::inlet ? Vec<3>(-direction) : direction;
  CaseSpec walls_alone = spec;  // whose free ends depend on the openings
  walls_alone.inlets.clear();
  walls_alone.outlets.clear();
  corners = section_around(make_boundary<3>(walls_alone), point, outwards,
                           upright_in_plane(direction, gravity_of<3>(spec)), spec.particles.spacing);
  if (corners.empty()) {
    throw CaseError("opening-finds-no-walls",
                    {"{}: no walls hold water in the plane through {} at right angles to {}", owner, place(point),
                     vector_text(direction)},
                    {"put the point between walls that reach its height, above the bed"});
  }
  return corners;
}

template <int Dim>
Opening<Dim> make_opening(OpeningKind kind, std::string name, const Section& section, const CaseSpec& spec) {
  Opening<Dim> opening;
  opening.kind = kind;
  opening.name = std::move(name);
  const double dx = spec.particles.spacing;
  const Vec<Dim> direction = to_vec<Dim>(section.direction, opening.label(), "direction").normalized();
  if constexpr (Dim == 3) {
    const Vec<3> gravity = gravity_of<3>(spec);
    if (!section.polygon.empty()) {
      Vec<3> normal;
      const std::vector<Vec<3>> corners = corners_of_polygon(section, opening.label(), dx, normal);
      outline(corners, normal.dot(direction) < 0.0 ? Vec<3>(-normal) : normal, gravity, dx, opening);
      turn_to<3>(direction, opening);
      return opening;
    }
    if (!section.centre.empty()) {
      const Vec<3> centre = to_vec<3>(section.centre, opening.label(), "centre");
      outline(corners_of_disc(centre, section.radius, direction, dx), direction, gravity, dx, opening);
      return opening;
    }
    if (!section.through.empty()) {
      outline(corners_through_point(section, kind, opening.label(), direction, spec), direction, gravity, dx, opening);
      return opening;
    }
  }
  span(section.from, section.to, dx, opening);
  turn_to<Dim>(direction, opening);
  return opening;
}

}  // namespace

template <int Dim>
std::vector<Opening<Dim>> make_open_ends(const CaseSpec& spec) {
  std::vector<Opening<Dim>> openings;
  for (std::size_t k = 0; k < spec.inlets.size(); ++k) {
    const InletTable& table = spec.inlets[k];
    openings.push_back(make_opening<Dim>(OpeningKind::inlet, name_or_number(table.name, "inlet", k), table, spec));
    openings.back().normal *= -1.0;  // its direction is the way in
  }
  for (std::size_t k = 0; k < spec.outlets.size(); ++k) {
    const OutletTable& table = spec.outlets[k];
    openings.push_back(make_opening<Dim>(OpeningKind::outlet, name_or_number(table.name, "outlet", k), table, spec));
    openings.back().meets_air = table.beyond == Beyond::air;
  }
  return openings;
}

CaseSpec with_sections_found(const CaseSpec& spec) {
  CaseSpec complete = spec;
  if (spec.general.dimension == 2) return complete;
  const auto find = [&](OpeningKind kind, const std::string& name, Section& section) {
    if (section.through.empty()) return;
    Opening<3> opening;
    opening.kind = kind;
    opening.name = name;
    const Vec<3> direction = to_vec<3>(section.direction, opening.label(), "direction").normalized();
    for (const Vec<3>& x : corners_through_point(section, kind, opening.label(), direction, spec)) {
      section.found.push_back({x[0], x[1], x[2]});
    }
  };
  for (std::size_t k = 0; k < complete.inlets.size(); ++k) {
    find(OpeningKind::inlet, name_or_number(spec.inlets[k].name, "inlet", k), complete.inlets[k]);
  }
  for (std::size_t k = 0; k < complete.outlets.size(); ++k) {
    find(OpeningKind::outlet, name_or_number(spec.outlets[k].name, "outlet", k), complete.outlets[k]);
  }
  return complete;
}

template <int Dim>
Opening<Dim> make_section(const ProbeTable& probe, double spacing) {
  Opening<Dim> opening;
  opening.kind = OpeningKind::section;
  opening.name = probe.name;
  span(probe.from, probe.to, spacing, opening);
  turn_to<Dim>(to_vec<Dim>(probe.direction, opening.label(), "direction").normalized(), opening);
  return opening;
}

template struct Opening<2>;
template struct Opening<3>;
TAILWATER_IN_2D_AND_3D(make_open_ends);
TAILWATER_IN_2D_AND_3D(make_section);

}  // namespace tailwater
