#include "geometry/plate_corners.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/plate_shape.h"

namespace tailwater {
namespace {

/// The number of ends or edges of a plate.
template <int Dim>
constexpr int ends_of_plate = 2 * (Dim - 1);

/// End 0 or 1 of a plate: a point, and the direction in which the end points.
std::pair<RimPiece<2>, Vec<2>> end_of(const Boundary<2>& boundary, const WallPlate& plate, int end) {
  const WallFace<2>& face = boundary.faces[plate.first_face + (end == 0 ? 0 : plate.pieces - 1)];
  return {{face.corners[end]}, (face.corners[end] - face.corners[1 - end]).normalized()};
}

/// Edge `end % 2` along axis `end / 2` of a rectangle.
std::pair<RimPiece<3>, Vec<3>> end_of(const Boundary<3>& boundary, const WallPlate& plate, int end) {
  const Screen<3> bare = rectangle_of(boundary, plate);
  const int axis = end / 2;
  const Vec<3> from = bare.corner + bare.range[axis][end % 2] * bare.along[axis];
  return {{from, from + bare.range[1 - axis][1] * bare.along[1 - axis]},
          (end % 2 == 0 ? -1.0 : 1.0) * bare.along[axis]};
}

/// Whether two ends of plates are at the same place.
template <int Dim>
bool coincide(const RimPiece<Dim>& a, const RimPiece<Dim>& b, double tolerance) {
  const auto are_near = [&](bool is_reversed) {
    for (std::size_t k = 0; k < a.size(); ++k) {
      if ((a[k] - b[is_reversed ? b.size() - 1 - k : k]).norm() > tolerance) return false;
    }
    return true;
  };
  return are_near(false) || are_near(true);
}

}  // namespace

template <int Dim>
int corner_number(const Boundary<Dim>& boundary, const WallPlate& plate, int end, const Lengths& lengths) {
  constexpr double straight_cosine = 0.996;  // of 5 degrees: the plates go straight on, or lie on each other
  const auto [piece, out] = end_of(boundary, plate, end);
  Vec<Dim> middle = Vec<Dim>::Zero();
  for (const Vec<Dim>& x : piece) middle += x / static_cast<double>(piece.size());
  int found = -1;
  int plates_near = 0;
  for (std::size_t p = 0; p < boundary.plates.size(); ++p) {
    const WallPlate& other = boundary.plates[p];
    bool is_near = false;
    for (int f = other.first_face; f < other.first_face + other.pieces; ++f) {
      is_near = is_near || (closest_point(boundary.faces[f], middle) - middle).norm() <= lengths.gap();
    }
    plates_near += is_near ? 1 : 0;
    if (other.sheet || other.wall == plate.wall) continue;
    for (int e = 0; is_near && e < ends_of_plate<Dim>; ++e) {
      const auto [there, out_there] = end_of(boundary, other, e);
      if (!coincide<Dim>(piece, there, lengths.gap()) || std::abs(out.dot(out_there)) > straight_cosine) continue;
      const int own_number = ends_of_plate<Dim> * static_cast<int>(&plate - boundary.plates.data()) + end;
      found = std::min(own_number, ends_of_plate<Dim> * static_cast<int>(p) + e);
    }
  }
  return plates_near == 2 ? found : -1;
}

template <int Dim>
void add_corner(const ScreenCorner<Dim>& corner, Screen<Dim> beyond, const Lengths& lengths,
                std::vector<Screen<Dim>>& screens) {
  Box<Dim> around;
  for (const Vec<Dim>& x : corner.piece) around.extend(x);
  for (Screen<Dim>& screen : screens) {
    if (screen.is_beyond || screen.box().exteriorDistance(around) > lengths.reach) continue;
    screen.corners.push_back(corner);
    screen.fade = lengths.fade();
  }
  beyond.is_beyond = true;
  beyond.rim.clear();
  beyond.corners = {corner};
  beyond.fade = lengths.fade();
  screens.push_back(std::move(beyond));
}

template int corner_number(const Boundary<2>&, const WallPlate&, int, const Lengths&);
template int corner_number(const Boundary<3>&, const WallPlate&, int, const Lengths&);
template void add_corner(const ScreenCorner<2>&, Screen<2>, const Lengths&, std::vector<Screen<2>>&);
template void add_corner(const ScreenCorner<3>&, Screen<3>, const Lengths&, std::vector<Screen<3>>&);

}  // namespace tailwater
