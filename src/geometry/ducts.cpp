#include "geometry/ducts.h"

#include <algorithm>
#include <cmath>

#include "geometry/from_spec.h"
#include "geometry/images.h"
#include "geometry/mesh_surface.h"

namespace tailwater {
namespace {

/// [dx]; walls of which so much lies beside an edge of the rim close it. Of shorter edges they close half.
constexpr double min_closed = 2.0;
constexpr double march = 0.25;         // dx; with which walls that lead on are followed
constexpr double looking_away = -0.6;  // cosine between a wall's normal and the way inwards
constexpr double led_straight = 1.0;   // dx; walls that lead to an opening are no farther from straight, a lead away
constexpr double exact = 1e-9;         // dx; accuracy of their ends: much finer than the tolerance of corners

/// How walls lie beside an edge of the rim of an opening.
struct EdgeOfRim {
  bool is_closed = false;
  bool is_on_mesh = false;  ///< whether a mesh is among these walls
};

/// Where walls are beside the rim of one opening, and how far they lead on along its normal.
template <int Dim>
class Rim {
 public:
  Rim(const CaseSpec& spec, const Boundary<Dim>& boundary, const Opening<Dim>& mouth)
      : spec_(spec),
        boundary_(boundary),
        mouth_(mouth),
        dx_(spec.particles.spacing),
        length_(duct_length(spec) - (is_led_to() ? lead_over_spacing * dx_ : 0.0)) {}

  /// The wall beside a place on the rim, from which the inside lies in the direction `inwards`; no face if the rim is
  /// open there. A bank that the top of a river's section meets looks the other way.
  NearestWall<Dim> wall_at(const Vec<Dim>& x, const Vec<Dim>& inwards) const {
    // A rim in a periodic boundary is open to the next period.
    if (is_in_periodic_plane<Dim>(boundary_.domain, x, corner_tolerance * dx_)) return {};
    const NearestWall<Dim> wall = boundary_.nearest(x, rim_tolerance(mouth_) * dx_);
    const bool looks_away = wall.face >= 0 && boundary_.faces[wall.face].normal.dot(inwards) < looking_away;
    return looks_away ? NearestWall<Dim>{} : wall;
  }

  /// How walls lie beside an edge of the rim (3D). Its ends do not count: walls there are beside the next edge.
  EdgeOfRim edge(const Vec<Dim>& from, const Vec<Dim>& to) const {
    const double length = (to - from).norm();
    const Vec<Dim> inwards = inwards_of(from, to);
    const double margin = std::min(0.25 * length, dx_);
    const int pieces = std::max(1, static_cast<int>(std::ceil(2.0 * (length - 2.0 * margin) / dx_)));
    const double piece = (length - 2.0 * margin) / pieces;
    int closed = 0;
    EdgeOfRim edge;
    for (int k = 0; k < pieces; ++k) {
      const int f = wall_at(Vec<Dim>(from + (margin + (k + 0.5) * piece) / length * (to - from)), inwards).face;
      closed += f >= 0;
      edge.is_on_mesh = edge.is_on_mesh || (f >= 0 && boundary_.mesh_of(f) != nullptr);
    }
    edge.is_closed = closed > 0 && closed * piece >= std::min(0.5 * (length - 2.0 * margin), min_closed * dx_);
    return edge;
  }

  /// Length [m] over which walls continue from a place on the rim, at most the length of the duct.
  double led_on(const Vec<Dim>& x) const {
    double low = 0.0;
    double high = 0.0;
    while (high < length_ && (high == 0.0 || is_beside_wall(x, high))) {
      low = high;
      high = std::min(length_, high + march * dx_);
    }
    if (high >= length_ && is_beside_wall(x, high)) return length_;
    while (high - low > exact * dx_) {
      const double middle = 0.5 * (low + high);
      (is_beside_wall(x, middle) ? low : high) = middle;
    }
    return low;
  }

  /// Unit vector at right angles to an edge of the rim; the rim runs counter-clockwise around the normal (3D).
  Vec<Dim> inwards_of(const Vec<Dim>& from, const Vec<Dim>& to) const {
    if constexpr (Dim == 3) return mouth_.normal.cross(to - from).normalized();
    return (mouth_.corner + 0.5 * mouth_.edges[0] - from).normalized();
  }

  double length() const { return length_; }
  const Opening<Dim>& mouth() const { return mouth_; }

 private:
  /// Whether the walls beside the rim lead straight to it from inside, so that outflow does not turn there.
  bool is_led_to() const {
    std::vector<Vec<Dim>> places = mouth_.rim();
    if constexpr (Dim == 3) {
      const std::vector<Vec<3>> corners = places;  // those of a periodic domain are open
      for (std::size_t k = 0; k < corners.size(); ++k)
        places[k] = 0.5 * (corners[k] + corners[(k + 1) % corners.size()]);
    }
    bool is_closed_somewhere = false;
    for (const Vec<Dim>& x : places) {
      const NearestWall<Dim> beside = wall_at(x, Vec<Dim>::Zero());
      if (beside.face < 0) continue;
      is_closed_somewhere = true;
      for (const double share : {0.5, 1.0}) {
        const Vec<Dim> inside = beside.point - share * lead_over_spacing * dx_ * mouth_.normal;
        if (boundary_.nearest(inside, share * led_straight * dx_).face < 0) return false;
      }
    }
    return is_closed_somewhere;
  }
  /// Whether a wall is beside the place that is `distance` farther out, and not only behind it.
  bool is_beside_wall(const Vec<Dim>& x, double distance) const {
    const Vec<Dim> there = x + distance * mouth_.normal;
    const NearestWall<Dim> wall = boundary_.nearest(there, rim_tolerance(mouth_) * dx_);
    return wall.face >= 0 && std::abs(mouth_.normal.dot(wall.point - there)) <= exact * dx_;
  }

  const CaseSpec& spec_;
  const Boundary<Dim>& boundary_;
  const Opening<Dim>& mouth_;
  double dx_, length_;
};

/// The walls of a duct in 2D: a line from each end of the mouth that is on a wall, from the wall itself.
std::vector<WallFace<2>> walls_of(const Rim<2>& rim, int wall) {
  const Opening<2>& mouth = rim.mouth();
  std::vector<WallFace<2>> faces;
  for (const Vec<2>& x : mouth.rim()) {
    const Vec<2> inwards = rim.inwards_of(x, x);
    const NearestWall<2> beside = rim.wall_at(x, inwards);
    if (beside.face < 0) continue;
    const double begin = rim.led_on(beside.point);
    const double end = rim.length() - mouth.beyond(beside.point);
    if (end - begin <= corner_tolerance * rim.length()) continue;
    Vec<2> from = beside.point + begin * mouth.normal;
    Vec<2> to = beside.point + end * mouth.normal;
    const bool fluid_is_left = -mouth.normal[1] * inwards[0] + mouth.normal[0] * inwards[1] > 0.0;
    if (!fluid_is_left) std::swap(from, to);
    faces.push_back({{from, to}, inwards, wall});
  }
  return faces;
}

/// The walls of a duct in 3D.
struct Tube {
  TriangleMesh mesh;        ///< over the edges of the rim that are closed; its fronts are inside
  bool is_on_mesh = false;  ///< whether one of these edges lies on a mesh
};

Tube tube_of(const Rim<3>& rim) {
  const Opening<3>& mouth = rim.mouth();
  std::vector<Vec<3>> corners = mouth.rim();
  Vec<3> area = Vec<3>::Zero();
  for (std::size_t k = 0; k < corners.size(); ++k) area += corners[k].cross(corners[(k + 1) % corners.size()]);
  if (area.dot(mouth.normal) < 0.0) std::ranges::reverse(corners);
  const auto next = [&](std::size_t k) -> const Vec<3>& { return corners[(k + 1) % corners.size()]; };
  Tube tube;
  TriangleMesh& mesh = tube.mesh;
  std::vector<std::size_t> closed;
  double begin = rim.length();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const EdgeOfRim edge = rim.edge(corners[k], next(k));
    if (!edge.is_closed) continue;
    closed.push_back(k);
    tube.is_on_mesh = tube.is_on_mesh || edge.is_on_mesh;
    begin = std::min(begin, rim.led_on(Vec<3>(0.5 * (corners[k] + next(k)))));
  }
  if (rim.length() - begin <= corner_tolerance * rim.length()) return tube;
  for (const std::size_t k : closed) {
    const int first = static_cast<int>(mesh.points.size());
    for (const double along : {begin, rim.length()}) {
      mesh.points.push_back(corners[k] + along * mouth.normal);
      mesh.points.push_back(next(k) + along * mouth.normal);
    }
    mesh.triangles.push_back({first, first + 2, first + 1});
    mesh.triangles.push_back({first + 1, first + 2, first + 3});
  }
  return tube;
}

void append_walls(const Rim<2>& rim, int wall, double /*spacing*/, Boundary<2>& boundary) {
  for (const WallFace<2>& face : walls_of(rim, wall)) boundary.faces.push_back(face);
}

/// A rectangle's duct is a box, whose particles continue the lattice of boxes in front of it. Other ducts are meshes,
/// as is that of a rectangle on a mesh: particles behind both walls have one lattice.
void append_walls(const Rim<3>& rim, int wall, double spacing, Boundary<3>& boundary) {
  auto [mesh, is_on_mesh] = tube_of(rim);
  if (mesh.triangles.empty()) return;
  weld(mesh, corner_tolerance * spacing);
  const int first = static_cast<int>(boundary.faces.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) boundary.faces.push_back(face_of(mesh, t, wall));
  if (rim.mouth().outline.corners().empty() && !is_on_mesh) return;
  boundary.meshes.push_back({std::make_shared<const MeshSurface>(std::move(mesh)), first, wall});
}

}  // namespace

double duct_length(const CaseSpec& spec) {
  const double stretch = traits_of(spec).support + 1.0;
  return std::ceil(lead_over_spacing + stretch - corner_tolerance) * spec.particles.spacing;
}

template <int Dim>
double rim_tolerance(const Opening<Dim>& opening) {
  return opening.outline.corners().empty() ? 0.1 : 0.3;
}

template <int Dim>
std::vector<Duct<Dim>> find_ducts(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  std::vector<Duct<Dim>> ducts;
  for (const Opening<Dim>& mouth : make_open_ends<Dim>(spec)) {
    if (!mouth.meets_air) ducts.push_back({mouth, Rim<Dim>(spec, boundary, mouth).length()});
  }
  return ducts;
}

template <int Dim>
void append_ducts(const CaseSpec& spec, Boundary<Dim>& boundary) {
  const std::vector<Opening<Dim>> mouths = make_open_ends<Dim>(spec);
  for (const Opening<Dim>& mouth : mouths) {
    if (mouth.meets_air) continue;
    const int wall = static_cast<int>(boundary.walls.size());
    boundary.walls.push_back({.name = mouth.name, .kind = mouth.label().table, .is_duct = true});
    const Rim<Dim> rim(spec, boundary, mouth);
    append_walls(rim, wall, spec.particles.spacing, boundary);
    boundary.ducts.push_back({mouth, rim.length()});
    for (const WallFace<Dim>& face : mouth.moved_out(rim.length()).as_faces()) boundary.continued.push_back(face);
  }
  if (!boundary.ducts.empty()) boundary.hang_screens();  // a plate may stand on the corner of a duct
}

TAILWATER_IN_2D_AND_3D(rim_tolerance);
TAILWATER_IN_2D_AND_3D(find_ducts);
TAILWATER_IN_2D_AND_3D(append_ducts);

}  // namespace tailwater
