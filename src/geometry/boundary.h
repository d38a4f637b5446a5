// Solid walls as oriented faces: segments in 2D, triangles in 3D. The normal of every face points to its fluid side.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/box.h"
#include "base/vec.h"
#include "geometry/face.h"
#include "geometry/opening.h"
#include "geometry/screen.h"

namespace tailwater {

struct CaseSpec;
template <int Dim>
class FaceGrid;

/// Index of the body to which all resting walls belong.
inline constexpr int resting_body = 0;

/// Properties of a wall that act on the fluid beside it.
struct WallProperties {
  std::string name;
  double friction = 0.0;      ///< fraction of the no-slip wall stress: 0 free slip, 1 no slip
  double roughness = 0.0;     ///< m; equivalent sand roughness k_s
  int body = resting_body;    ///< walls of one body never move relative to each other
  std::string kind = "wall";  ///< the table of the case file that defines it
  bool is_plate = false;      ///< without thickness, with water on both sides
  bool is_duct = false;       ///< outside of an opening; not a wall of the case file
  /// Largest shear stress over the normal stress, along a wall whose friction is that of no slip; 0: no bound.
  double coulomb_friction = 0.0;

  bool moves() const { return body != resting_body; }
};

/// The point of the walls nearest to a given point.
template <int Dim>
struct NearestWall {
  int face = -1;  ///< index into Boundary::faces; -1: no wall within the search distance
  Vec<Dim> point = Vec<Dim>::Zero();
  double signed_distance = 0.0;  ///< m; positive on the fluid side, negative behind the wall
};

class MeshSurface;

/// A wall from a mesh: its faces are consecutive, in the order of the triangles of its surface, and face the water.
struct WallMesh {
  std::shared_ptr<const MeshSurface> surface;  ///< as drawn
  int first_face = 0;
  int wall = 0;
  std::vector<std::uint8_t> free_edges = {};   ///< for each triangle, one bit per edge that is a free rim; empty: none
  std::vector<std::uint8_t> ended_edges = {};  ///< likewise: edges of the rim beyond which no place is behind the mesh

  int end_face() const;
  bool has_free_edge(int triangle, int edge) const {
    return !free_edges.empty() && (free_edges[triangle] >> edge & 1) != 0;
  }
};

/// An end of a wall in 2D that is not a plate: no wall of the same body but plates continues or closes it.
struct WallEnd {
  int face = 0;              ///< index into Boundary::faces
  int corner = 0;            ///< of the face
  bool is_at_plate = false;  ///< a plate ends there: the wall has no screens, and no place is behind it
  bool is_free = false;      ///< whether no other body closes it at present, so that it is in the water
};

/// A wall without thickness. Every piece of it, a segment (2D) or a triangle (3D), has two faces back to back. The
/// fronts of all pieces come first, then the backs in the same order.
struct WallPlate {
  int wall = 0;
  int first_face = 0;
  int pieces = 0;
  std::shared_ptr<const MeshSurface> sheet = nullptr;  ///< as drawn, if it is from a mesh
};

/// The space outside an inlet or outlet that holds the water beyond it (geometry/ducts.h).
template <int Dim>
struct Duct {
  Opening<Dim> mouth;  ///< the opening, at which the case ends
  double length;       ///< m; of the duct, along the normal of the mouth

  bool holds(const Vec<Dim>& x) const {
    const double beyond = mouth.beyond(x);
    return beyond > 0.0 && beyond <= length && mouth.spans(x);
  }
};

template <int Dim>
struct Boundary {
  PeriodicDomain<Dim> domain;
  std::vector<WallFace<Dim>> faces;  ///< in 3D each rectangle is two consecutive triangles
  std::vector<WallProperties> walls;
  std::vector<WallMesh> meshes;  ///< by first face; none in 2D
  std::vector<WallPlate> plates;
  std::vector<WallFace<Dim>> continued;  ///< openings and periodic planes: walls that end there continue beyond them
  std::vector<WallEnd> ends;             ///< none in 3D
  std::vector<Screen<Dim>> screens;      ///< beside plates and free ends, at their present places, with images
  std::vector<std::shared_ptr<const MeshSurface>> water;  ///< the mesh of each block of water; null if it has none
  std::vector<Duct<Dim>> ducts;                           ///< empty if the walls are those of the case file alone

  /// Stores the faces of resting walls by place, for searches up to `reach` (m). Afterwards no face may be added, and
  /// only faces of moving walls may change.
  void file_faces(double reach);
  double filed_reach() const;

  /// Detects the free ends of walls that are not plates. Ends that are not detected have no screens.
  void find_free_ends(double spacing, double reach);

  /// Makes the screens at the present places of the faces. An end that is on another wall, or nearer to it than half a
  /// `spacing` (m), leaves no opening. There the screen of a plate continues behind that wall by `reach` (m), the
  /// support of the kernel; other walls have no screen there. A wall does not close an end that points away from it.
  void hang_screens(double spacing, double reach);
  void hang_screens() { hang_screens(screen_spacing_, screen_reach_); }

  /// Indices of the screens that a displacement of this length (m) ending at `x` may cross.
  std::span<const int> screens_near(const Vec<Dim>& x, double length) const {
    return all_screens_.empty() ? std::span<const int>() : hung_near(x, length);
  }

  /// False only where no screen hides particles and no particle acts through screens.
  bool has_screens_near(const Vec<Dim>& x) const { return hung_box_.contains(x); }

  /// Whether `x` is so near a free end of a wall that the wall counts as a plate there: it has two sides, no point is
  /// behind it, and its particles act through its screens. False for plates.
  bool is_beside_free_end(int wall, const Vec<Dim>& x) const;

  /// Nearest wall within `search_distance` (m, may be infinite) of `x`. No point is behind a plate, nor behind a wall
  /// whose nearest point is a free end. Where several faces are equally near (a shared corner), the sign is that of the
  /// face whose plane is farthest from `x`, which is right at convex and concave corners. The sign of a mesh is right
  /// at saddles as well (mesh_surface.h).
  NearestWall<Dim> nearest(const Vec<Dim>& x, double search_distance) const;

  /// Signed distance [m] of `x` from one mesh; infinite if no part of it is within `search_distance`.
  double height_above(const WallMesh& mesh, const Vec<Dim>& x, double search_distance) const;

  /// Displacement [m] of a moving mesh from its drawn position.
  Vec<Dim> displacement_of(const WallMesh& mesh) const;

  /// Calls visit(f) for every face that does not belong to a mesh.
  template <class Visit>
  void visit_plain_faces(Visit&& visit) const {
    int f = 0;
    for (const WallMesh& mesh : meshes) {
      for (; f < mesh.first_face; ++f) visit(f);
      f = mesh.end_face();
    }
    for (; f < static_cast<int>(faces.size()); ++f) visit(f);
  }

  /// The index of the wall if it is a plate, else -1.
  int plate_of(int wall) const { return walls[wall].is_plate ? wall : -1; }

  bool is_in_duct(const Vec<Dim>& x) const {
    return std::ranges::any_of(ducts, [&](const Duct<Dim>& duct) { return duct.holds(x); });
  }

  /// The mesh to which a face belongs, or null.
  const WallMesh* mesh_of(int face) const;

  /// Nearest wall, as `nearest`, except that beside a free end no point is behind the wall: water there has come around
  /// the end.
  NearestWall<Dim> nearest_to_water(const Vec<Dim>& x, double search_distance) const;

  /// Whether a point on a face is a free end of its wall.
  bool is_free_end(int face, const Vec<Dim>& x) const;

 private:
  std::span<const int> hung_near(const Vec<Dim>& x, double length) const;

  double screen_spacing_ = 0.0;                ///< m
  double screen_reach_ = 0.0;                  ///< m
  std::shared_ptr<const FaceGrid<Dim>> hung_;  ///< the screens; null: they have never been hung
  Box<Dim> hung_box_;                          ///< around all points that a screen can affect
  std::vector<Screen<Dim>> mesh_rims_;         ///< the screens beside free rims of meshes, as drawn
  std::vector<int> all_screens_;
  std::shared_ptr<const FaceGrid<Dim>> resting_;  ///< without meshes; null: nothing is stored
  std::vector<int> moving_;                       ///< faces that do not belong to a mesh, once others are stored
};

/// The walls of a case file, without ducts. Left and right of a polygon are seen in the direction of its points. A box
/// is traversed counter-clockwise, so its left is its inside. Throws CaseError for a wall without extent or normal,
/// repeated points, points of the wrong dimension, or an open face that does not exist.
template <int Dim>
Boundary<Dim> make_boundary(const CaseSpec& spec);

}  // namespace tailwater
