// Solid walls as oriented faces: segments in 2D, triangles in 3D. Every face knows on which side the fluid is.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/box.h"
#include "base/finding.h"
#include "base/vec.h"
#include "case/spec.h"
#include "geometry/face.h"
#include "geometry/face_grid.h"
#include "geometry/opening.h"
#include "geometry/screen.h"

namespace tailwater {

/// The body that all resting walls belong to.
inline constexpr int resting_body = 0;

/// What a wall does to the fluid that touches it.
struct WallProperties {
  std::string name;
  double friction = 0.0;      ///< share of the no-slip wall stress: 0 free slip, 1 no slip
  double roughness = 0.0;     ///< m; equivalent sand roughness k_s
  int body = resting_body;    ///< walls of one body never move relative to each other
  std::string kind = "wall";  ///< the table of the case file that it is from
  bool is_plate = false;      ///< without thickness, with water on both sides
  bool is_duct = false;       ///< outside of an opening; no wall of the case file

  bool moves() const { return body != resting_body; }
};

/// The place of a wall nearest to some point.
template <int Dim>
struct NearestWall {
  int face = -1;  ///< index into Boundary::faces; -1: no wall within the search distance
  Vec<Dim> point = Vec<Dim>::Zero();
  double signed_distance = 0.0;  ///< m; positive on the fluid side, negative behind the wall
};

class MeshSurface;

/// A wall that is a mesh: its faces are consecutive, in the order of the triangles of its surface, and face the water.
struct WallMesh {
  std::shared_ptr<const MeshSurface> surface;  ///< as drawn
  int first_face = 0;
  int wall = 0;
  std::vector<std::uint8_t> free_edges = {};  ///< of each triangle, a bit for each edge that is a free rim; empty: none

  int end_face() const;
  bool has_free_edge(int triangle, int edge) const {
    return !free_edges.empty() && (free_edges[triangle] >> edge & 1) != 0;
  }
};

/// An end of a wall that is no plate, in 2D: no wall of the same body continues or closes it.
struct WallEnd {
  int face = 0;          ///< index into Boundary::faces
  int corner = 0;        ///< of the face
  bool is_free = false;  ///< whether no other body closes it at present, so that it ends in the water
};

/// A wall without thickness. Every piece of it, a segment (2D) or a triangle (3D), has two faces back to back: first
/// come the fronts of all pieces, then the backs in the same order.
struct WallPlate {
  int wall = 0;
  int first_face = 0;
  int pieces = 0;
  std::shared_ptr<const MeshSurface> sheet = nullptr;  ///< as drawn, if it is from a mesh
};

/// The space outside of an inlet or outlet in which the water beyond it stands (geometry/ducts.h).
template <int Dim>
struct Duct {
  Opening<Dim> mouth;  ///< where the case ends
  double length;       ///< m; of the duct, along the normal of the mouth

  bool holds(const Vec<Dim>& x) const {
    const double beyond = mouth.beyond(x);
    return beyond > 0.0 && beyond <= length && mouth.spans(x);
  }
};

template <int Dim>
struct Boundary {
  std::vector<WallFace<Dim>> faces;  ///< in 3D each rectangle is two consecutive triangles
  std::vector<WallProperties> walls;
  std::vector<WallMesh> meshes;  ///< by first face; none in 2D
  std::vector<WallPlate> plates;
  std::vector<WallFace<Dim>> continued;  ///< openings and periodic planes: walls that end there continue beyond
  std::vector<WallEnd> ends;             ///< none in 3D
  std::vector<Screen<Dim>> screens;      ///< of plates and beside free ends, at their present places
  std::vector<std::shared_ptr<const MeshSurface>> water;  ///< the mesh of each block of water; null if it has none
  std::vector<Duct<Dim>> ducts;                           ///< none, where the walls are those of the case file alone

  /// Files the faces of resting walls by place, for searches up to `reach` (m). Afterwards no face may be added, and
  /// only faces of moving walls may change.
  void file_faces(double reach);
  double filed_reach() const { return resting_.reach(); }

  /// Finds the free ends of walls that are no plates. Without it they have no screens.
  void find_free_ends(double spacing, double reach);

  /// Makes the screens where the faces are now. An end that is on another wall, or nearer to it than half a `spacing`
  /// (m), leaves no opening: the screen of a plate goes on behind that wall by `reach` (m), the support of the kernel,
  /// and other walls have none there. An end that points away from the wall is not closed by it.
  void hang_screens(double spacing, double reach);
  void hang_screens() { hang_screens(screen_spacing_, screen_reach_); }

  /// The screens, by index, that a displacement of this length (m) may pass which ends at `x`.
  std::span<const int> screens_near(const Vec<Dim>& x, double length) const {
    if (length > hung_.reach()) return all_screens_;
    return has_screens_near(x) ? hung_.near(x) : std::span<const int>();
  }

  /// False only where nothing is felt through screens or hidden by them.
  bool has_screens_near(const Vec<Dim>& x) const { return hung_box_.contains(x); }

  /// Whether `x` is so near to a free end of a wall that is no plate that the wall counts as a plate there: it has two
  /// sides, no place is behind it, and its particles are felt through its screens.
  bool is_beside_free_end(int wall, const Vec<Dim>& x) const;

  /// Nearest wall within `search_distance` (m, may be infinite) of `x`. No place is behind a plate, nor behind a wall
  /// whose nearest place is a free end. Where several faces
  /// are equally near (a shared corner), the sign is that of the face whose plane is farthest from `x`, which is right
  /// at convex and concave corners. The sign of a mesh is right at saddles as well (mesh_surface.h).
  NearestWall<Dim> nearest(const Vec<Dim>& x, double search_distance) const;

  /// The signed distance of `x` from one mesh; infinite if there is nothing of it within `search_distance`.
  double height_above(const WallMesh& mesh, const Vec<Dim>& x, double search_distance) const;

  /// How far a mesh that moves is from where it is drawn.
  Vec<Dim> displacement_of(const WallMesh& mesh) const;

  /// Calls visit(f) for every face that is not of a mesh.
  template <class Visit>
  void visit_plain_faces(Visit&& visit) const {
    int f = 0;
    for (const WallMesh& mesh : meshes) {
      for (; f < mesh.first_face; ++f) visit(f);
      f = mesh.end_face();
    }
    for (; f < static_cast<int>(faces.size()); ++f) visit(f);
  }

  /// The wall, if it is a plate, else -1.
  int plate_of(int wall) const { return walls[wall].is_plate ? wall : -1; }

  bool is_in_duct(const Vec<Dim>& x) const {
    return std::ranges::any_of(ducts, [&](const Duct<Dim>& duct) { return duct.holds(x); });
  }

  /// The mesh that a face belongs to; null if it belongs to none.
  const WallMesh* mesh_of(int face) const;

  /// The same, but beside a free end no place is behind the wall either: water that is there has come around the end.
  NearestWall<Dim> nearest_to_water(const Vec<Dim>& x, double search_distance) const;

  /// Whether a place on a face is a free end of its wall.
  bool is_free_end(int face, const Vec<Dim>& x) const;

 private:
  double screen_spacing_ = 0.0;         ///< m
  double screen_reach_ = 0.0;           ///< m
  FaceGrid<Dim> hung_;                  ///< the screens
  Box<Dim> hung_box_;                   ///< around all that is felt through screens
  std::vector<Screen<Dim>> mesh_rims_;  ///< the screens beside free rims of meshes, as drawn
  std::vector<int> all_screens_;
  FaceGrid<Dim> resting_;    ///< without meshes; reach 0: nothing is filed
  std::vector<int> moving_;  ///< faces that are not of a mesh, when others are filed
};

/// Such as "wall 'bed'" or "gate 'lock'".
template <int Dim>
CaseLabel wall_label(const Boundary<Dim>& boundary, int wall) {
  return CaseLabel(boundary.walls[wall].kind, boundary.walls[wall].name);
}

/// The walls of a case file, without ducts. Left and right of a polygon are as seen when walking along its points. A
/// box is walked counter-clockwise, so its left is its inside. Throws CaseError for a wall without extent or normal,
/// repeated points, points of the wrong dimension, or an open face that does not exist.
template <int Dim>
Boundary<Dim> make_boundary(const CaseSpec& spec);

}  // namespace tailwater
