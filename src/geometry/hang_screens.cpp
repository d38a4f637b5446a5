// The screens of plates and beside free ends.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/box.h"
#include "geometry/boundary.h"
#include "geometry/corner_screens.h"
#include "geometry/face_grid.h"
#include "geometry/images.h"
#include "geometry/mesh_surface.h"
#include "geometry/plate_corners.h"
#include "geometry/plate_shape.h"
#include "geometry/rim_ends.h"

namespace tailwater {
namespace {

/// In supports of the kernel: how far from a free end a wall counts as a plate, and how far its screens reach, past
/// which water feels the wall particles that stand as near to the end.
constexpr double plate_reach = 1.5;
constexpr double screened_reach = plate_reach + 1.0;

/// The front of one piece, without other walls.
Screen<2> bare_screen(const Boundary<2>& boundary, const WallPlate& plate, int piece) {
  const WallFace<2>& face = boundary.faces[plate.first_face + piece];
  const Vec<2> along = face.corners[1] - face.corners[0];
  return {face.corners[0],
          face.normal,
          {along.normalized()},
          {{{0.0, along.norm()}}},
          plate.wall,
          plate.first_face + piece,
          plate.first_face + plate.pieces + piece};
}

/// Displacement of a plate from a mesh, from its drawn place.
Vec<3> displacement_of(const Boundary<3>& boundary, const WallPlate& plate) {
  return boundary.faces[plate.first_face].corners[0] - plate.sheet->mesh().corner(0, 0);
}

Screen<3> triangle_screen(const TriangleMesh& mesh, int t, const Vec<3>& moved, const WallPlate& plate, int piece) {
  const Vec<3> corner = mesh.corner(t, 0);
  const Vec<3> along = (mesh.corner(t, 1) - corner).normalized();
  const Vec<3> normal = mesh.area_normal(t).normalized();
  const Vec<3> across = normal.cross(along);
  std::array<Vec<2>, 3> flat;  // the corners, counter-clockwise
  for (int c = 0; c < 3; ++c) {
    const Vec<3> x = mesh.corner(t, c) - corner;
    flat[c] = {along.dot(x), across.dot(x)};
  }
  Screen<3> screen{corner + moved,
                   normal,
                   {along, across},
                   {{{std::min(0.0, flat[2][0]), std::max(flat[1][0], flat[2][0])}, {0.0, flat[2][1]}}},
                   plate.wall,
                   plate.first_face + piece,
                   plate.first_face + plate.pieces + piece};
  for (const int edge : {1, 2}) {
    const Vec<2> to_end = (flat[(edge + 1) % 3] - flat[edge]).normalized();
    screen.cuts[edge - 1] = {{to_end[1], -to_end[0]}, to_end[1] * flat[edge][0] - to_end[0] * flat[edge][1]};
  }
  return screen;
}

/// A free end of a chain of faces: the hidden fraction of its screens decreases to 0 there, also on a screen beyond the
/// end.
void fade_out(const Vec<2>& end, const Vec<2>& out, const Screen<2>& last, double fade,
              std::vector<Screen<2>>& screens) {
  for (Screen<2>& screen : screens) {
    screen.fade = fade;
    if (screen.distance(end) < fade) screen.rim.push_back({end});
  }
  Screen<2> beyond = last;
  beyond.corner = end;
  beyond.along = {out};
  beyond.range = {{{0.0, fade}}};
  beyond.is_beyond = true;
  beyond.fade = fade;
  beyond.rim = {{end}};
  screens.push_back(beyond);
}

/// The screens of one plate, drawn on behind the walls at which it ends.
std::vector<Screen<2>> screens_of(const Boundary<2>& boundary, const WallPlate& plate, const Lengths& lengths) {
  std::vector<Screen<2>> screens;
  for (int piece = 0; piece < plate.pieces; ++piece) screens.push_back(bare_screen(boundary, plate, piece));
  const std::array<Screen<2>, 2> last{screens.front(), screens.back()};
  const std::array<int, 2> piece{0, plate.pieces - 1};
  std::vector<std::pair<ScreenCorner<2>, Screen<2>>> corners;  // with the screens beyond them
  for (const int end : {0, 1}) {
    const int f = plate.first_face + piece[end];
    const Vec<2>& x = boundary.faces[f].corners[end];
    const double side = end == 0 ? -1.0 : 1.0;
    const Vec<2> out = side * last[end].along[0];
    if (is_closed_by_wall(boundary, x, out, lengths.gap(), plate.wall)) {
      if (const auto into_corner = screen_into_corner(boundary, last[end], x, out, lengths)) {
        screens.push_back(*into_corner);
      } else {
        screens[piece[end]].range[0][end] += side * lengths.reach;
      }
    } else if (is_continued(boundary, x, plate.wall, f, lengths)) {
      const double distance = distance_to_plate(boundary, x, out, plate.wall, lengths);
      screens[piece[end]].range[0][end] += side * distance;
      if (const int number = corner_number<2>(boundary, plate, end, lengths); number >= 0) {
        Screen<2> beyond = last[end];
        beyond.corner = x + distance * out;
        beyond.along = {out};
        beyond.range = {{{0.0, lengths.fade()}}};
        corners.push_back({{number, {beyond.corner}}, beyond});
      }
    } else {
      fade_out(x, out, last[end], lengths.fade(), screens);
    }
  }
  for (const auto& [corner, beyond] : corners) add_corner<2>(corner, beyond, lengths, screens);
  return screens;
}

/// Gives each screen the pieces of the rim that are near it.
void share_rim(const std::vector<RimPiece<3>>& rim, double fade, std::vector<Screen<3>>& screens) {
  for (Screen<3>& screen : screens) {
    screen.fade = fade;
    const Box<3> box = screen.box();
    for (const RimPiece<3>& piece : rim) {
      const Box<3> around(piece[0].cwiseMin(piece[1]), piece[0].cwiseMax(piece[1]));
      if (box.exteriorDistance(around) < fade) screen.rim.push_back(piece);
    }
  }
}

/// The rim of a sheet that was drawn on, from the edges that are free: they, and the sides of the strips beside them
/// that are drawn on behind walls.
std::vector<RimPiece<3>> rim_of(const WidenedSheet& wide, const std::vector<bool>& is_free) {
  std::vector<RimPiece<3>> rim;
  for (std::size_t k = 0; k < wide.edges.size(); ++k) {
    const DrawnOnEdge& edge = wide.edges[k];
    if (is_free[k]) {
      rim.push_back({edge.from, edge.to});
      continue;
    }
    if (edge.before >= 0 && is_free[edge.before]) rim.push_back({edge.from, edge.outer_from});
    if (edge.after >= 0 && is_free[edge.after]) rim.push_back({edge.to, edge.outer_to});
  }
  return rim;
}

/// The screens of the triangles of a sheet, and of the strips that were drawn on.
std::vector<Screen<3>> screens_of_triangles(const WidenedSheet& wide, const std::vector<bool>& is_free,
                                            const Vec<3>& moved, const WallPlate& plate, double fade) {
  std::vector<Screen<3>> screens;
  for (int t = 0; t < static_cast<int>(wide.mesh.triangles.size()); ++t) {
    screens.push_back(triangle_screen(wide.mesh, t, moved, plate, wide.from[t]));
    for (const int edge : wide.beyond[t]) screens.back().is_beyond |= edge >= 0 && is_free[edge];
  }
  std::vector<RimPiece<3>> rim = rim_of(wide, is_free);
  for (RimPiece<3>& piece : rim) piece = {piece[0] + moved, piece[1] + moved};
  share_rim(rim, fade, screens);
  return screens;
}

std::vector<Screen<3>> screens_of_sheet(const Boundary<3>& boundary, const WallPlate& plate, const Lengths& lengths) {
  const Vec<3> moved = displacement_of(boundary, plate);
  const TriangleMesh& mesh = plate.sheet->mesh();
  std::vector<bool> is_free;
  const WidenedSheet wide = widened(*plate.sheet, lengths.reach, [&](int t, int e, const Vec<3>& out) {
    const RimEnd end =
        end_along(boundary, mesh.corner(t, e) + moved, mesh.corner(t, (e + 1) % 3) + moved, out, plate.wall, lengths);
    if (end != RimEnd::continued) is_free.push_back(end == RimEnd::free);
    return end != RimEnd::continued;
  });
  return screens_of_triangles(wide, is_free, moved, plate, lengths.fade());
}

std::vector<Screen<3>> screens_of(const Boundary<3>& boundary, const WallPlate& plate, const Lengths& lengths) {
  if (plate.sheet) return screens_of_sheet(boundary, plate, lengths);
  const Screen<3> bare = rectangle_of(boundary, plate);
  Screen<3> whole = bare;
  std::vector<std::array<int, 2>> free_ends;  // axis, end
  std::vector<std::array<int, 3>> corners;    // axis, end, number
  std::vector<Screen<3>> screens;
  for (const int axis : {0, 1}) {
    for (const int end : {0, 1}) {
      const Vec<3> from = bare.corner + bare.range[axis][end] * bare.along[axis];
      const Vec<3> to = from + bare.range[1 - axis][1] * bare.along[1 - axis];
      const double side = end == 0 ? -1.0 : 1.0;
      const Vec<3> out = side * bare.along[axis];
      const RimEnd kind = end_along(boundary, from, to, out, plate.wall, lengths);
      if (kind == RimEnd::on_wall) {
        if (const auto into_corner = screen_into_corner(boundary, bare, from, 1 - axis, out, lengths)) {
          screens.push_back(*into_corner);
        } else {
          whole.range[axis][end] += side * lengths.reach;
        }
      }
      if (kind == RimEnd::continued) {
        whole.range[axis][end] +=
            side * distance_to_plate(boundary, Vec<3>(0.5 * (from + to)), out, plate.wall, lengths);
        const int number = corner_number<3>(boundary, plate, 2 * axis + end, lengths);
        if (number >= 0) corners.push_back({axis, end, number});
      }
      if (kind == RimEnd::free) free_ends.push_back({axis, end});
    }
  }
  const auto at = [&](double x, double y) { return Vec<3>(whole.corner + x * whole.along[0] + y * whole.along[1]); };
  Screen<3> wide = whole;
  for (const auto& [axis, end] : free_ends) wide.range[axis][end] += (end == 0 ? -1.0 : 1.0) * lengths.fade();
  screens.insert(screens.begin(), whole);
  const auto piece_at = [&](int axis, double edge) {
    const std::array<double, 2>& across = whole.range[1 - axis];
    return axis == 0 ? RimPiece<3>{at(edge, across[0]), at(edge, across[1])}
                     : RimPiece<3>{at(across[0], edge), at(across[1], edge)};
  };
  std::vector<RimPiece<3>> rim;
  for (const auto& [axis, end] : free_ends) {
    const double edge = whole.range[axis][end];
    rim.push_back(piece_at(axis, edge));
    Screen<3> strip = wide;
    strip.range[axis][1 - end] = edge;
    strip.is_beyond = true;
    screens.push_back(strip);
  }
  share_rim(rim, lengths.fade(), screens);
  for (const auto& [axis, end, number] : corners) {
    const double edge = whole.range[axis][end];
    Screen<3> beyond = whole;
    beyond.range[axis][1 - end] = edge;
    beyond.range[axis][end] = edge + (end == 0 ? -1.0 : 1.0) * lengths.fade();
    add_corner<3>({number, piece_at(axis, edge)}, beyond, lengths, screens);
  }
  return screens;
}

/// The screens beside a free end: of the faces of its chain from the end inwards.
std::vector<Screen<2>> screens_beside(const Boundary<2>& boundary, const WallEnd& end, const Lengths& lengths) {
  std::vector<Screen<2>> screens;
  const double whole = reach_of_screens(boundary, end, screened_reach * lengths.reach, lengths);
  if (whole == 0.0) return screens;
  double left = whole;
  for (int f = end.face; f >= 0 && left > 0.0; f = next_in_chain(boundary, f, 1 - end.corner, lengths.tolerance())) {
    const WallFace<2>& face = boundary.faces[f];
    const Vec<2> inwards = face.corners[1 - end.corner] - face.corners[end.corner];
    Screen<2> screen{face.corners[end.corner], face.normal, {inwards.normalized()}, {}, 0, f, f};
    screen.range = {{{0.0, std::min(inwards.norm(), left)}}};
    screen.wall = boundary.faces[end.face].wall;
    screen.is_plate = false;
    screens.push_back(screen);
    left -= inwards.norm();
  }
  const Screen<2> last = screens.front();
  fade_out(last.corner, -last.along[0], last, lengths.fade(), screens);
  screens.back().plate_reach = std::clamp(whole - lengths.reach, 0.0, plate_reach * lengths.reach);
  return screens;
}

/// The screens beside the free rim of a mesh.
std::vector<Screen<3>> screens_beside(const WallMesh& mesh, const Lengths& lengths) {
  const WidenedSheet wide = widened(*mesh.surface, lengths.fade(),
                                    [&](int t, int e, const Vec<3>& /*out*/) { return mesh.has_free_edge(t, e); });
  const std::vector<bool> is_free(wide.edges.size(), true);
  const WallPlate as_plate{mesh.wall, mesh.first_face, 0};
  std::vector<Screen<3>> screens = screens_of_triangles(wide, is_free, Vec<3>::Zero(), as_plate, lengths.fade());
  const std::vector<RimPiece<3>> rim = rim_of(wide, is_free);
  std::erase_if(screens, [&](const Screen<3>& screen) {
    const Box<3> box = screen.box();
    return std::ranges::none_of(rim, [&](const RimPiece<3>& piece) {
      const Box<3> around(piece[0].cwiseMin(piece[1]), piece[0].cwiseMax(piece[1]));
      return box.exteriorDistance(around) < screened_reach * lengths.reach;
    });
  });
  for (Screen<3>& screen : screens) {
    screen.is_plate = false;
    screen.plate_reach = plate_reach * lengths.reach;
  }
  return screens;
}

template <int Dim>
void append(std::vector<Screen<Dim>>& screens, std::vector<Screen<Dim>> more) {
  screens.insert(screens.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// Adds the images of the screens in other periods, and removes what does not reach into `space`. The screens of each
/// wall stay together.
template <int Dim>
void append_images(const PeriodicDomain<Dim>& domain, const Box<Dim>& space, std::vector<Screen<Dim>>& screens) {
  const std::size_t count = screens.size();
  for (std::size_t s = 0; s < count; ++s) {
    visit_images<Dim>(domain, screens[s].box(), space, [&](const Vec<Dim>& moved) {
      screens.push_back(screens[s]);
      screens.back().corner += moved;
      for (RimPiece<Dim>& piece : screens.back().rim) {
        for (Vec<Dim>& x : piece) x += moved;
      }
      for (ScreenCorner<Dim>& corner : screens.back().corners) {
        for (Vec<Dim>& x : corner.piece) x += moved;
      }
    });
  }
  if (screens.size() == count) return;
  std::erase_if(screens, [&](const Screen<Dim>& screen) { return !screen.box().intersects(space); });
  std::ranges::stable_sort(screens, {}, &Screen<Dim>::wall);
}

}  // namespace

template <int Dim>
void Boundary<Dim>::find_free_ends(double spacing, double reach) {
  const Lengths lengths{spacing, reach};
  if constexpr (Dim == 2) {
    ends = find_ends(*this, lengths);
  } else {
    mesh_rims_.clear();
    for (WallMesh& mesh : meshes) {
      find_free_edges(*this, lengths, mesh);
      if (!mesh.free_edges.empty()) append(mesh_rims_, screens_beside(mesh, lengths));
    }
  }
}

template <int Dim>
void Boundary<Dim>::hang_screens(double spacing, double reach) {
  screen_spacing_ = spacing;
  screen_reach_ = reach;
  const Lengths lengths{spacing, reach};
  screens.clear();
  hung_box_ = {};
  for (const WallPlate& plate : plates) append(screens, screens_of(*this, plate, lengths));
  if constexpr (Dim == 2) {
    for (WallEnd& end : ends) {
      if (end.is_at_plate) continue;
      const WallFace<2>& face = faces[end.face];
      const Vec<2>& x = face.corners[end.corner];
      const Vec<2> out = (x - face.corners[1 - end.corner]).normalized();
      hung_box_.extend(x);
      end.is_free = !is_closed_by_wall(*this, x, out, lengths.gap(), face.wall);
      if (end.is_free) append(screens, screens_beside(*this, end, lengths));
    }
  } else {
    for (const Screen<3>& drawn : mesh_rims_) {
      const Vec<3> moved = displacement_of(*mesh_of(drawn.front));
      screens.push_back(drawn);
      screens.back().corner += moved;
      for (RimPiece<3>& piece : screens.back().rim) piece = {piece[0] + moved, piece[1] + moved};
    }
  }
  const Vec<Dim> around = Vec<Dim>::Constant(screened_reach * reach);
  const Box<Dim> space = space_around<Dim>(domain, screened_reach * reach);
  append_images<Dim>(domain, space, screens);
  for (Screen<Dim>& screen : screens) {
    if (screen.is_plate) screen.fade = lengths.fade();
  }
  // Points exactly behind the rim, such as lattice points, are hidden for any rounding.
  for (Screen<Dim>& screen : screens) {
    for (std::array<double, 2>& range : screen.range) {
      range[0] -= corner_tolerance * lengths.gap();
      range[1] += corner_tolerance * lengths.gap();
    }
    for (ScreenCut& cut : screen.cuts) cut.most += corner_tolerance * lengths.gap();
  }
  auto hung = std::make_shared<FaceGrid<Dim>>(plate_reach * reach);
  all_screens_.clear();
  for (int s = 0; s < static_cast<int>(screens.size()); ++s) {
    all_screens_.push_back(s);
    const Box<Dim> box = screens[s].box().intersection(space);
    hung_box_.extend(box);
    hung->add(s, box.min(), box.max(), [&](const Vec<Dim>& x) { return screens[s].distance(x); });
  }
  hung_ = std::move(hung);
  if (!hung_box_.isEmpty()) hung_box_ = {hung_box_.min() - around, hung_box_.max() + around};
}

template <int Dim>
std::span<const int> Boundary<Dim>::hung_near(const Vec<Dim>& x, double length) const {
  if (length > hung_->reach()) return all_screens_;
  return has_screens_near(x) ? hung_->near(x) : std::span<const int>();
}

template <int Dim>
bool Boundary<Dim>::is_beside_free_end(int wall, const Vec<Dim>& x) const {
  return std::ranges::any_of(screens_near(x, hung_ == nullptr ? 0.0 : hung_->reach()), [&](int s) {
    const Screen<Dim>& screen = screens[s];
    return screen.wall == wall && screen.is_beyond && !screen.is_plate &&
           distance_to_rim<Dim>(screen.rim, x) < screen.plate_reach;
  });
}

template void Boundary<2>::find_free_ends(double, double);
template void Boundary<3>::find_free_ends(double, double);
template std::span<const int> Boundary<2>::hung_near(const Vec<2>&, double) const;
template std::span<const int> Boundary<3>::hung_near(const Vec<3>&, double) const;
template void Boundary<2>::hang_screens(double, double);
template void Boundary<3>::hang_screens(double, double);
template bool Boundary<2>::is_beside_free_end(int, const Vec<2>&) const;
template bool Boundary<3>::is_beside_free_end(int, const Vec<3>&) const;

}  // namespace tailwater
