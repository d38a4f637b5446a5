// The pieces of hulls beside other walls, and the gaps between them.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "bodies/contacts.h"
#include "bodies/narrow_gaps.h"
#include "bodies/part_in_front.h"
#include "geometry/images.h"
#include "geometry/screen.h"
#include "neighbours/neighbourhood.h"

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
constexpr double min_opposite = 0.5;

/// Sum of w W over the water from which on a piece counts as wet. In a right angle between a hull and a bed the sum is
/// 1/4, beside a row of particles in a gap of dx it is 0.3.
constexpr double weight_beside_water = 0.15;

/// [dx]; distance of the places at which the wall that faces a piece is looked for.
constexpr double step_across = 0.5;

}  // namespace

template <int Dim>
void NarrowGaps<Dim>::find_pieces(double time) {
  const Boundary<Dim>& boundary = flow_.walls.boundary;
  for (const ContactSurface<Dim>& surface : hulls_.surfaces) {
    placements_.push_back(placement_of(flow_, surface, time));
  }
  std::vector<std::uint8_t> is_flat;
  if (hulls_.can_stand) is_flat = find_flat_contacts();
  for (std::size_t k = 0; k < hulls_.patches.size(); ++k) {
    const WallPatch<Dim>& patch = hulls_.patches[k];
    const int hull = hulls_.of_wall[boundary.faces[patch.face].wall];
    const Vec<Dim> x = patch.centre(boundary);
    const double dx = spacing_at(x);
    const OtherWall wall = other_wall(hull, x, hulls_.reach * dx);
    if (wall.distance >= hulls_.reach * dx && !hulls_.can_stand) continue;
    const double measure = hulls_.can_stand ? wetted_measure(patch, wall, is_flat[k] != 0) : patch.measure;
    if (measure == 0.0) {
      contacts_.push_back({hull, x, dx});
      continue;
    }
    const Vec<Dim>& normal = boundary.faces[patch.face].normal;
    const OtherWall across = wall.wall >= 0 ? wall_across(hull, x, normal, wall) : wall;
    const bool faces = -normal.dot(across.normal) >= min_opposite;
    const double gap = std::max(0.0, across.distance);
    pieces_.push_back({.hull = hull,
                       .other_wall = across.wall,
                       .x = x,
                       .spacing = dx,
                       .towards_hull = across.normal,
                       .gap = gap,
                       .surface = -measure * normal,
                       .faces = faces,
                       .film = faces ? film_share(gap / dx) : 0.0});
  }
}

/// Beside the end of a pipe between two side walls, a side wall is nearer than the bed below the pipe.
template <int Dim>
typename NarrowGaps<Dim>::OtherWall NarrowGaps<Dim>::wall_across(int hull, const Vec<Dim>& x, const Vec<Dim>& normal,
                                                                 const OtherWall& nearest) const {
  const double dx = spacing_at(x);
  OtherWall wall = nearest;
  for (double way = 0.0; way <= widest_film() * dx; way += step_across * dx) {
    if (way > 0.0) wall = other_wall(hull, x + way * normal, widest_film() * dx);
    const double facing = -normal.dot(wall.normal);
    if (wall.wall < 0 || facing < min_opposite) continue;
    wall.distance += facing * way;
    return wall;
  }
  return nearest;
}

template <int Dim>
bool NarrowGaps<Dim>::is_flush(const WallPatch<Dim>& patch, const OtherWall& wall) const {
  return std::abs(wall.distance) < flush_gap * flow_.setup.scale.spacing &&
         -flow_.walls.boundary.faces[patch.face].normal.dot(wall.normal) > flush_cosine;
}

/// A round hull that is drawn with straight sides may lie on one of them. So narrow a contact counts as a line. Each
/// plane counts apart: the ends of a pipe lie flat on side walls, its lowest side on the bed.
template <int Dim>
std::vector<std::uint8_t> NarrowGaps<Dim>::find_flat_contacts() const {
  struct Plane {
    int hull;
    Vec<Dim> normal;
    double measure = 0.0;
    Box<Dim> box = {};
  };
  std::vector<Plane> planes;
  std::vector<int> plane_of(hulls_.patches.size(), -1);
  const double dx = flow_.setup.scale.spacing;
  for (std::size_t k = 0; k < hulls_.patches.size(); ++k) {
    const WallPatch<Dim>& patch = hulls_.patches[k];
    const WallFace<Dim>& face = flow_.walls.boundary.faces[patch.face];
    const int hull = hulls_.of_wall[face.wall];
    const Vec<Dim> x = patch.centre(flow_.walls.boundary);
    if (!is_flush(patch, other_wall(hull, x, flush_gap * dx))) continue;
    auto plane = std::ranges::find_if(
        planes, [&](const Plane& other) { return other.hull == hull && other.normal.dot(face.normal) > flush_cosine; });
    if (plane == planes.end()) plane = planes.insert(plane, Plane{hull, face.normal});
    plane->measure += patch.measure;
    plane->box.extend(x);
    plane_of[k] = static_cast<int>(plane - planes.begin());
  }
  std::vector<std::uint8_t> is_flat(plane_of.size(), 0);
  for (std::size_t k = 0; k < plane_of.size(); ++k) {
    if (plane_of[k] < 0) continue;
    const Plane& plane = planes[static_cast<std::size_t>(plane_of[k])];
    is_flat[k] = plane.measure > widest_line * dx * (Dim == 2 ? 1.0 : std::max(plane.box.sizes().norm(), dx));
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
  return patch.measure *
         part_in_front(patch, boundary, wall.distance, longest_part * dx,
                       [&](const Vec<Dim>& x, double reach) { return other_wall(hull, x, reach).distance; });
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
  return -wall.normal.dot(normal) < min_opposite ? widest : std::max(0.0, own.signed_distance + wall.distance);
}

template <int Dim>
typename NarrowGaps<Dim>::OtherWall NarrowGaps<Dim>::other_wall(int hull, const Vec<Dim>& x, double reach) const {
  const double dx = flow_.setup.scale.spacing;
  OtherWall nearest{-1, reach, Vec<Dim>::Zero()};
  const auto look_from = [&](const Vec<Dim>& place) {
    for (std::size_t s = 0; s < hulls_.surfaces.size(); ++s) {
      const ContactSurface<Dim>& surface = hulls_.surfaces[s];
      if (surface.hull == hull) continue;
      const Vec<Dim> drawn = placements_[s].inverse(place);
      const NearestWall<Dim> wall = surface.boundary.nearest(drawn, reach);
      if (wall.face < 0 || wall.signed_distance >= nearest.distance) continue;
      nearest.wall = surface.boundary.faces[wall.face].wall;
      nearest.distance = wall.signed_distance;
      nearest.normal = placements_[s].linear * (std::abs(wall.signed_distance) > corner_tolerance * dx
                                                    ? Vec<Dim>((drawn - wall.point) / wall.signed_distance)
                                                    : surface.boundary.faces[wall.face].normal);
    }
  };
  look_from(x);
  const PeriodicDomain<Dim>& domain = flow_.setup.domain;
  visit_images<Dim>(domain, Box<Dim>(x), space_around<Dim>(domain, reach),
                    [&](const Vec<Dim>& by) { look_from(x + by); });
  return nearest;
}

template <int Dim>
void NarrowGaps<Dim>::look_at_water() {
  const Particles<Dim>& particles = flow_.state.particles;
  const std::vector<Vec<Dim>> shifts = image_shifts<Dim>(flow_.setup.domain);
  std::vector<double> sums(pieces_.size(), 0.0);
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    Piece& piece = pieces_[n];
    const double relative = piece.spacing / flow_.setup.scale.spacing;
    const double reach = kernel_radius(flow_.setup.scale.kernel) * relative;
    for (const Vec<Dim>& shift : shifts) {
      const Vec<Dim> x = flow_.neighbourhood->wrapped(piece.x) - shift;
      flow_.neighbourhood->grid().for_each_near(x, [&](std::int32_t j) {
        const auto i = static_cast<std::size_t>(j);
        if (i >= particles.owned || !particles.is_fluid(i) || is_stagnant_[i] != 0.0) return;
        const double distance = (particles.position[i] - x).norm();
        if (distance >= reach) return;
        piece.water.push_back(i);
        piece.places.push_back(particles.position[i] - x + piece.x);
        const double W = kernel_value(flow_.setup.scale.kernel, distance / relative) / power<Dim>(relative);
        piece.weights.push_back(particles.volume[i] * W);
      });
    }
    sums[n] = std::accumulate(piece.weights.begin(), piece.weights.end(), 0.0);
  }
  flow_.setup.ranks.sum_of_each(sums);
  for (std::size_t n = 0; n < pieces_.size(); ++n) pieces_[n].wetness = std::min(1.0, sums[n] / weight_beside_water);
}

#define TAILWATER_INSTANTIATE(Dim)                                       \
  template void NarrowGaps<Dim>::find_pieces(double);                    \
  template void NarrowGaps<Dim>::look_at_water();                        \
  template double NarrowGaps<Dim>::width_at(int, const Vec<Dim>&) const; \
  template typename NarrowGaps<Dim>::OtherWall NarrowGaps<Dim>::other_wall(int, const Vec<Dim>&, double) const;
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
