// The pieces of hulls beside other walls, and the gaps between them.
#include <algorithm>
#include <cmath>

#include "bodies/contacts.h"
#include "bodies/narrow_gaps.h"

namespace tailwater {
namespace {

/// [dx]; a hull that can stand lies flat on a wall that is nearer than this and parallel.
constexpr double flush_gap = 0.05;

/// -cos of the angle between parallel walls, at least.
constexpr double flush_cosine = 0.9999;

/// [dx]; width up to which a flat contact counts as a line, beside which the pressure acts on the whole hull.
constexpr double widest_line = 1.5;

/// [dx]; size of the pieces by which a patch is divided where a hull stands in a wall.
constexpr double longest_part = 0.1;

/// Least value of -cos of the angle between the normals of a piece and of the wall that it faces.
constexpr double least_opposite = 0.5;

}  // namespace

template <int Dim>
void NarrowGaps<Dim>::find_pieces(double time) {
  const Boundary<Dim>& boundary = flow_.walls.boundary;
  for (const ContactSurface<Dim>& surface : hulls_.surfaces) {
    placements_.push_back(placement_of(flow_, surface, time));
  }
  std::vector<std::uint8_t> is_flat;
  if (hulls_.can_stand) is_flat = find_flat_contacts();
  for (const WallPatch<Dim>& patch : hulls_.patches) {
    const int hull = hulls_.of_wall[boundary.faces[patch.face].wall];
    const Vec<Dim> x = patch.centre(boundary);
    const double dx = spacing_at(x);
    const OtherWall wall = other_wall(hull, x, hulls_.reach * dx);
    if (wall.distance >= hulls_.reach * dx) continue;
    const double measure = hulls_.can_stand ? wetted_measure(patch, wall, is_flat[hull] != 0) : patch.measure;
    if (measure == 0.0) {
      contacts_.push_back({hull, x, dx});
      continue;
    }
    const double gap = std::max(0.0, wall.distance);
    const double facing = -boundary.faces[patch.face].normal.dot(wall.normal);
    pieces_.push_back({.hull = hull,
                       .other_wall = wall.wall,
                       .x = x,
                       .spacing = dx,
                       .towards_hull = wall.normal,
                       .gap = gap,
                       .surface = -measure * boundary.faces[patch.face].normal,
                       .faces = facing >= least_opposite,
                       .film = facing < least_opposite ? 0.0 : film_share(gap / dx)});
  }
}

template <int Dim>
bool NarrowGaps<Dim>::is_flush(const WallPatch<Dim>& patch, const OtherWall& wall) const {
  return std::abs(wall.distance) < flush_gap * flow_.setup.scale.spacing &&
         -flow_.walls.boundary.faces[patch.face].normal.dot(wall.normal) > flush_cosine;
}

/// A round hull that is drawn with straight sides may lie on one of them. So narrow a contact counts as a line.
template <int Dim>
std::vector<std::uint8_t> NarrowGaps<Dim>::find_flat_contacts() const {
  std::vector<double> measure(static_cast<std::size_t>(hulls_.count), 0.0);
  std::vector<Box<Dim>> box(measure.size());
  for (const WallPatch<Dim>& patch : hulls_.patches) {
    const int hull = hulls_.of_wall[flow_.walls.boundary.faces[patch.face].wall];
    const Vec<Dim> x = patch.centre(flow_.walls.boundary);
    if (!is_flush(patch, other_wall(hull, x, flush_gap * flow_.setup.scale.spacing))) continue;
    measure[hull] += patch.measure;
    box[hull].extend(x);
  }
  std::vector<std::uint8_t> is_flat(measure.size(), 0);
  for (std::size_t k = 0; k < measure.size(); ++k) {
    if (measure[k] == 0.0) continue;
    const double length = std::max(box[k].sizes().norm(), flow_.setup.scale.spacing);
    is_flat[k] = measure[k] > widest_line * flow_.setup.scale.spacing * (Dim == 2 ? 1.0 : length);
  }
  return is_flat;
}

template <int Dim>
double NarrowGaps<Dim>::wetted_measure(const WallPatch<Dim>& patch, const OtherWall& wall, bool is_flat_there) const {
  const Boundary<Dim>& boundary = flow_.walls.boundary;
  if (is_flush(patch, wall)) return is_flat_there ? 0.0 : patch.measure;
  const double dx = flow_.setup.scale.spacing;
  if (wall.distance > dx) return patch.measure;
  const int hull = hulls_.of_wall[boundary.faces[patch.face].wall];
  const std::vector<WallPatch<Dim>> pieces = pieces_of(patch, boundary, longest_part * dx);
  const auto in_front = std::ranges::count_if(pieces, [&](const WallPatch<Dim>& piece) {
    return other_wall(hull, piece.centre(boundary), widest_gap * dx).distance > 0.0;
  });
  return patch.measure * static_cast<double>(in_front) / static_cast<double>(pieces.size());
}

template <int Dim>
double NarrowGaps<Dim>::width_at(int hull, const Vec<Dim>& x) const {
  const double widest = widest_film() * spacing_at(x);
  const auto surface = std::ranges::find(hulls_.surfaces, hull, &ContactSurface<Dim>::hull);
  const AffineMap<Dim>& placement = placements_[static_cast<std::size_t>(surface - hulls_.surfaces.begin())];
  const NearestWall<Dim> own = surface->boundary.nearest(placement.inverse(x), widest);
  if (own.face < 0) return widest;
  const OtherWall wall = other_wall(hull, x, widest - own.signed_distance);
  const Vec<Dim> normal = placement.linear * surface->boundary.faces[own.face].normal;
  return -wall.normal.dot(normal) < least_opposite ? widest : std::max(0.0, own.signed_distance + wall.distance);
}

template <int Dim>
typename NarrowGaps<Dim>::OtherWall NarrowGaps<Dim>::other_wall(int hull, const Vec<Dim>& x, double reach) const {
  const double dx = flow_.setup.scale.spacing;
  OtherWall nearest{-1, reach, Vec<Dim>::Zero()};
  for (std::size_t s = 0; s < hulls_.surfaces.size(); ++s) {
    const ContactSurface<Dim>& surface = hulls_.surfaces[s];
    if (surface.hull == hull) continue;
    const Vec<Dim> drawn = placements_[s].inverse(x);
    const NearestWall<Dim> wall = surface.boundary.nearest(drawn, reach);
    if (wall.face < 0 || wall.signed_distance >= nearest.distance) continue;
    nearest.wall = surface.boundary.faces[wall.face].wall;
    nearest.distance = wall.signed_distance;
    nearest.normal = placements_[s].linear * (std::abs(wall.signed_distance) > corner_tolerance * dx
                                                  ? Vec<Dim>((drawn - wall.point) / wall.signed_distance)
                                                  : surface.boundary.faces[wall.face].normal);
  }
  return nearest;
}

#define TAILWATER_INSTANTIATE(Dim)                                       \
  template void NarrowGaps<Dim>::find_pieces(double);                    \
  template double NarrowGaps<Dim>::width_at(int, const Vec<Dim>&) const; \
  template typename NarrowGaps<Dim>::OtherWall NarrowGaps<Dim>::other_wall(int, const Vec<Dim>&, double) const;
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
