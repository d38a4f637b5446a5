// How walls end: on other walls, continued by something else, or in the water.
#pragma once

#include <vector>

#include "geometry/boundary.h"
#include "geometry/plate_shape.h"

namespace tailwater {

/// How a piece of the rim of a wall ends. Screens end abruptly where the wall is continued by something else.
enum class RimEnd { on_wall, continued, free };

/// The spacing of the particles and the support of the kernel, m.
struct Lengths {
  double spacing;
  double reach;
  double gap() const { return 0.5 * spacing; }  ///< an end that is as near to another wall leaves no opening
  /// Half-width of the fade about the rim of a wall. A pair that appears at once changes the
  /// energy (p_i + p_j) w_i w_j W_ij without work, and still water beside the rim then never comes to rest.
  double fade() const { return spacing; }
  double tolerance() const { return corner_tolerance * spacing; }
};

/// The wall on which wall `own` ends at `x`, where it points in the direction `out`. A wall closes this end if it is no
/// plate, and nearer than `gap` or in front of the end. A wall behind the end, such as a pipe that opens beside a
/// plate, does not close it. The result has no face if there is no such wall.
template <int Dim>
WallBesidePlate closing_wall(const Boundary<Dim>& boundary, const Vec<Dim>& x, const Vec<Dim>& out, double gap,
                             int own);

template <int Dim>
bool is_closed_by_wall(const Boundary<Dim>& boundary, const Vec<Dim>& x, const Vec<Dim>& out, double gap, int own) {
  return closing_wall(boundary, x, out, gap, own).face >= 0;
}

/// Whether another plate, an opening or a periodic plane is at an end of wall `own`. Another piece of the wall itself
/// must touch the end; `piece` is the face that ends there, -1: no piece of the wall counts.
template <int Dim>
bool is_continued(const Boundary<Dim>& boundary, const Vec<Dim>& x, int own, int piece, const Lengths& lengths);

/// Distance [m] of an end of a plate at `x` from another plate, in the direction `out` in which the end points. It is
/// negative if the end has passed the plate, and 0 if no plate is as near as ends that count as closed, or if the
/// plates are parallel.
template <int Dim>
double distance_to_plate(const Boundary<Dim>& boundary, const Vec<Dim>& x, const Vec<Dim>& out, int own,
                         const Lengths& lengths);

/// Determines how an edge of wall `own` ends, in steps of dx.
RimEnd end_along(const Boundary<3>& boundary, const Vec<3>& from, const Vec<3>& to, const Vec<3>& out, int own,
                 const Lengths& lengths);

/// The face that continues a chain at a corner of a face, whose other corner it has there; -1: none.
int next_in_chain(const Boundary<2>& boundary, int f, int corner, double tolerance);

/// Length [m] of the screens beside a free end, along its wall, at most `whole`. They end a support before a corner
/// around which water stands, because pairs of water around a corner interact, or before an opening, whose duct makes
/// such a corner.
double reach_of_screens(const Boundary<2>& boundary, const WallEnd& end, double whole, const Lengths& lengths);

/// The ends of walls that are no plates, unless a wall of the same body, other than a plate, closes or continues them.
std::vector<WallEnd> find_ends(const Boundary<2>& boundary, const Lengths& lengths);

/// Finds the free edges of the rim of a mesh, and those at which a plate ends.
void find_free_edges(const Boundary<3>& boundary, const Lengths& lengths, WallMesh& mesh);

}  // namespace tailwater
