#include "bodies/contacts.h"

#include <algorithm>
#include <cmath>

#include "motion/wall_motion.h"

namespace tailwater {
namespace {

/// Position of a surface at the start of a step, and its velocity.
template <int Dim>
struct SurfaceMotion {
  AffineMap<Dim> placement = {};
  AffineMap<Dim> velocity{Mat<Dim>::Zero(), Vec<Dim>::Zero()};  ///< of the point that is drawn at x
};

/// The path of a surface that moves as prescribed.
template <int Dim>
const typename WallMotion<Dim>::MovingWall& path_of(const Flow<Dim>& flow, const ContactSurface<Dim>& surface) {
  return *std::ranges::find(flow.setup.wall_motion->moving(), surface.wall, &WallMotion<Dim>::MovingWall::wall);
}

template <int Dim>
class ContactFinder {
 public:
  ContactFinder(const Flow<Dim>& flow, const ContactSurfaces<Dim>& surfaces, const std::vector<BodyState<Dim>>& bodies,
                double dt, std::span<const Freedom> freedoms)
      : flow_(flow), surfaces_(surfaces), bodies_(bodies), dt_(dt), freedoms_(freedoms) {}

  std::vector<OneSidedForce> find() const {
    std::vector<OneSidedForce> contacts;
    for (const ContactSurface<Dim>& surface : surfaces_.each) {
      const SurfaceMotion<Dim> motion = motion_of(surface);
      for (int b = 0; b < static_cast<int>(surfaces_.points.size()); ++b) {
        if (b == surface.body) continue;
        for (const Vec<Dim>& point : surfaces_.points[b])
          add(b, bodies_[b].placement(point), surface, motion, contacts);
      }
    }
    return contacts;
  }

 private:
  SurfaceMotion<Dim> motion_of(const ContactSurface<Dim>& surface) const {
    SurfaceMotion<Dim> motion{.placement = placement_of(flow_, surface, flow_.state.time)};
    if (surface.wall < 0) return motion;
    const double time = flow_.state.time;
    motion.velocity = path_of(flow_, surface).mean_velocity(time, time + dt_, flow_.state.motion);
    return motion;
  }

  /// Adds a contact for the point of body b at x, if it is near the surface.
  void add(int b, const Vec<Dim>& x, const ContactSurface<Dim>& surface, const SurfaceMotion<Dim>& motion,
           std::vector<OneSidedForce>& contacts) const {
    const double spacing = flow_.setup.scale.spacing;
    const Vec<Dim> drawn = motion.placement.inverse(x);
    const NearestWall<Dim> wall = surface.boundary.nearest(drawn, contact_reach * spacing);
    if (wall.face < 0) return;
    const double distance = wall.signed_distance;
    const Vec<Dim> away = motion.placement.linear * (std::abs(distance) > corner_tolerance * spacing
                                                         ? Vec<Dim>((drawn - wall.point) / distance)
                                                         : surface.boundary.faces[wall.face].normal);
    Vec<Dim> velocity = bodies_[b].velocity_at(x) - motion.velocity(drawn);
    if (surface.body >= 0) velocity -= bodies_[surface.body].velocity_at(x);
    contacts.push_back({.direction = on_body<Dim>(freedoms_, bodies_, b, x, away) -
                                     on_body<Dim>(freedoms_, bodies_, surface.body, x, away),
                        .speed = away.dot(velocity) + std::max(0.0, distance) / dt_});
  }

  const Flow<Dim>& flow_;
  const ContactSurfaces<Dim>& surfaces_;
  const std::vector<BodyState<Dim>>& bodies_;
  double dt_;
  std::span<const Freedom> freedoms_;
};

}  // namespace

template <int Dim>
AffineMap<Dim> placement_of(const Flow<Dim>& flow, const ContactSurface<Dim>& surface, double time) {
  if (surface.body >= 0) return flow.state.motion.bodies.each[surface.body].at(time);
  if (surface.wall < 0) return {};
  const auto& path = path_of(flow, surface);
  return path.in_period(path.at(time, flow.state.motion));
}

template <int Dim>
std::vector<OneSidedForce> find_contacts(const Flow<Dim>& flow, const ContactSurfaces<Dim>& surfaces,
                                         const std::vector<BodyState<Dim>>& bodies, double dt,
                                         std::span<const Freedom> freedoms) {
  return ContactFinder<Dim>(flow, surfaces, bodies, dt, freedoms).find();
}

TAILWATER_IN_2D_AND_3D(placement_of);
TAILWATER_IN_2D_AND_3D(find_contacts);

}  // namespace tailwater
