#include "geometry/rim_ends.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/mesh_surface.h"

namespace tailwater {
namespace {

constexpr double min_bend = 0.4;  // sine of the angle between faces that make a corner

/// Cosine of the angle between the normal of a wall and the direction in which an edge points at the wall.
constexpr double faces_edge = -0.5;

/// Sine of the angle between two plates with a smaller angle, which are not drawn on to each other.
constexpr double min_closing = 0.25;

template <int Dim>
bool is_near(const WallFace<Dim>& face, const Vec<Dim>& x, double distance) {
  return (closest_point(face, x) - x).norm() <= distance;
}

/// Whether an opening or a periodic plane is at `x`.
template <int Dim>
bool is_at_opening(const Boundary<Dim>& boundary, const Vec<Dim>& x, const Lengths& lengths) {
  return std::ranges::any_of(boundary.continued, [&](const auto& face) { return is_near(face, x, lengths.gap()); });
}

/// Whether another plate, or another piece of plate `own` than `piece`, is at an end of wall `own`.
template <int Dim>
bool is_at_plate(const Boundary<Dim>& boundary, const Vec<Dim>& x, int own, int piece, const Lengths& lengths) {
  for (const WallPlate& plate : boundary.plates) {
    for (int f = plate.first_face; f < plate.first_face + plate.pieces; ++f) {
      if (plate.wall == own && (piece < 0 || f == piece)) continue;
      if (is_near(boundary.faces[f], x, plate.wall == own ? lengths.tolerance() : lengths.gap())) return true;
    }
  }
  return false;
}

/// Whether another wall, other than a plate, lies along an edge of a mesh: the two meet in a corner, whatever its
/// angle.
bool goes_on_in_wall(const Boundary<3>& boundary, const Vec<3>& from, const Vec<3>& to, int own,
                     const Lengths& lengths) {
  return std::ranges::all_of(std::array{0.0, 0.5, 1.0}, [&](double share) {
    return wall_beside_plate(boundary, Vec<3>(from + share * (to - from)), own).distance <= lengths.gap();
  });
}

}  // namespace

template <int Dim>
WallBesidePlate closing_wall(const Boundary<Dim>& boundary, const Vec<Dim>& x, const Vec<Dim>& out, double gap,
                             int own) {
  const WallBesidePlate beside = wall_beside_plate(boundary, x, own);
  if (beside.distance > gap) return {};
  const auto closes = [&](const WallFace<Dim>& face) { return face.normal.dot(out) <= corner_tolerance; };
  if (closes(boundary.faces[beside.face])) return beside;
  // At a corner another face is as near.
  WallBesidePlate closing;
  const double nearest = std::abs(beside.distance) + corner_tolerance * gap;
  boundary.visit_plain_faces([&](int f) {
    const WallFace<Dim>& face = boundary.faces[f];
    if (boundary.walls[face.wall].is_plate || face.wall == own || !closes(face)) return;
    if (is_near(face, x, nearest)) closing = {f, beside.distance};
  });
  return closing;
}

template <int Dim>
bool is_continued(const Boundary<Dim>& boundary, const Vec<Dim>& x, int own, int piece, const Lengths& lengths) {
  return is_at_opening(boundary, x, lengths) || is_at_plate(boundary, x, own, piece, lengths);
}

template <int Dim>
double distance_to_plate(const Boundary<Dim>& boundary, const Vec<Dim>& x, const Vec<Dim>& out, int own,
                         const Lengths& lengths) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const WallPlate& plate : boundary.plates) {
    if (plate.wall == own) continue;
    for (int f = plate.first_face; f < plate.first_face + plate.pieces; ++f) {
      const WallFace<Dim>& face = boundary.faces[f];
      const double closing = -face.normal.dot(out);
      if (std::abs(closing) < min_closing || !is_near(face, x, lengths.gap())) continue;
      const double distance = face.height(x) / closing;
      if (std::abs(distance) < std::abs(nearest)) nearest = distance;
    }
  }
  return std::isfinite(nearest) ? nearest : 0.0;
}

RimEnd end_along(const Boundary<3>& boundary, const Vec<3>& from, const Vec<3>& to, const Vec<3>& out, int own,
                 const Lengths& lengths) {
  const auto is_closed = [&](double share) {
    return is_closed_by_wall(boundary, Vec<3>(from + share * (to - from)), out, lengths.gap(), own);
  };
  // Beside a wall at which it does not point, such as the side wall of a flume, an edge stays free.
  const auto is_ended = [&](const Vec<3>& x) {
    const WallBesidePlate beside = wall_beside_plate(boundary, x, own);
    return (beside.distance <= lengths.gap() && boundary.faces[beside.face].normal.dot(out) < faces_edge) ||
           is_continued(boundary, x, own, -1, lengths);
  };
  const int steps = std::max(1, static_cast<int>(std::ceil((to - from).norm() / lengths.spacing)));
  int on_wall = 0;
  for (int k = 0; k <= steps; ++k) on_wall += is_closed(static_cast<double>(k) / steps) ? 1 : 0;
  if (on_wall == steps + 1) return RimEnd::on_wall;
  int ended = 0;
  for (int k = 0; k < steps; ++k) {
    ended += is_ended(Vec<3>(from + (k + 0.5) / steps * (to - from))) ? 1 : 0;
  }
  return 2 * ended >= steps ? RimEnd::continued : RimEnd::free;
}

std::vector<WallEnd> find_ends(const Boundary<2>& boundary, const Lengths& lengths) {
  std::vector<WallEnd> ends;
  for (int f = 0; f < static_cast<int>(boundary.faces.size()); ++f) {
    const WallFace<2>& face = boundary.faces[f];
    if (boundary.walls[face.wall].is_plate) continue;
    for (const int corner : {0, 1}) {
      const Vec<2>& x = face.corners[corner];
      const Vec<2> out = (x - face.corners[1 - corner]).normalized();
      const auto is_alike = [&](int g) {
        return boundary.walls[boundary.faces[g].wall].body == boundary.walls[face.wall].body;
      };
      const WallBesidePlate beside = closing_wall(boundary, x, out, lengths.gap(), face.wall);
      bool is_end = !is_at_opening(boundary, x, lengths) && (beside.face < 0 || !is_alike(beside.face));
      for (int g = 0; g < static_cast<int>(boundary.faces.size()) && is_end; ++g) {
        const bool is_plate = boundary.walls[boundary.faces[g].wall].is_plate;
        is_end = g == f || is_plate || !is_near(boundary.faces[g], x, lengths.tolerance()) || !is_alike(g);
      }
      if (is_end) ends.push_back({f, corner, is_at_plate(boundary, x, face.wall, -1, lengths)});
    }
  }
  return ends;
}

void find_free_edges(const Boundary<3>& boundary, const Lengths& lengths, WallMesh& mesh) {
  const MeshSurface& surface = *mesh.surface;
  const TriangleMesh& triangles = surface.mesh();
  for (int t = 0; t < static_cast<int>(triangles.triangles.size()); ++t) {
    for (int e = 0; e < 3; ++e) {
      if (surface.neighbours()[t][e] >= 0) continue;
      const Vec<3>& from = triangles.corner(t, e);
      const Vec<3>& to = triangles.corner(t, (e + 1) % 3);
      const Vec<3> out = (to - from).cross(triangles.area_normal(t)).normalized();
      const bool is_free = end_along(boundary, from, to, out, mesh.wall, lengths) == RimEnd::free &&
                           !goes_on_in_wall(boundary, from, to, mesh.wall, lengths);
      const auto bit = static_cast<std::uint8_t>(1U << e);
      if (is_free) {
        mesh.free_edges.resize(triangles.triangles.size(), 0);
        mesh.free_edges[t] |= bit;
      }
      if (is_free || is_at_plate(boundary, Vec<3>(0.5 * (from + to)), mesh.wall, -1, lengths)) {
        mesh.ended_edges.resize(triangles.triangles.size(), 0);
        mesh.ended_edges[t] |= bit;
      }
    }
  }
}

int next_in_chain(const Boundary<2>& boundary, int f, int corner, double tolerance) {
  const Vec<2>& x = boundary.faces[f].corners[corner];
  for (int g = 0; g < static_cast<int>(boundary.faces.size()); ++g) {
    const WallFace<2>& face = boundary.faces[g];
    const bool moves_alike = boundary.walls[face.wall].body == boundary.walls[boundary.faces[f].wall].body;
    if (g == f || boundary.walls[face.wall].is_plate || !moves_alike) continue;
    if ((face.corners[1 - corner] - x).norm() <= tolerance) return g;
  }
  return -1;
}

double reach_of_screens(const Boundary<2>& boundary, const WallEnd& end, double whole, const Lengths& lengths) {
  double length = 0.0;
  for (int f = end.face; length < whole + lengths.reach;) {
    const WallFace<2>& face = boundary.faces[f];
    const Vec<2>& corner = face.corners[1 - end.corner];
    const Vec<2> inwards = corner - face.corners[end.corner];
    length += inwards.norm();
    const int next = next_in_chain(boundary, f, 1 - end.corner, lengths.tolerance());
    if (next < 0) {
      const bool is_open_there = is_continued(boundary, corner, face.wall, -1, lengths);
      return is_open_there ? std::clamp(length - lengths.reach, 0.0, whole) : whole;
    }
    const Vec<2> further = boundary.faces[next].corners[1 - end.corner] - corner;
    const double sine = face.normal.dot(further.normalized());
    if (sine > min_bend) return whole;
    if (sine < -min_bend) return std::clamp(length - lengths.reach, 0.0, whole);
    f = next;
  }
  return whole;
}

template WallBesidePlate closing_wall(const Boundary<2>&, const Vec<2>&, const Vec<2>&, double, int);
template WallBesidePlate closing_wall(const Boundary<3>&, const Vec<3>&, const Vec<3>&, double, int);
template bool is_continued(const Boundary<2>&, const Vec<2>&, int, int, const Lengths&);
template bool is_continued(const Boundary<3>&, const Vec<3>&, int, int, const Lengths&);
template double distance_to_plate(const Boundary<2>&, const Vec<2>&, const Vec<2>&, int, const Lengths&);
template double distance_to_plate(const Boundary<3>&, const Vec<3>&, const Vec<3>&, int, const Lengths&);

}  // namespace tailwater
