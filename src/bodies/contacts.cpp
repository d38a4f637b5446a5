#include "bodies/contacts.h"

#include <algorithm>
#include <cmath>

namespace tailwater {
namespace {

/// More are needed only where many points of a body touch at once.
constexpr int contact_sweeps = 100;

}  // namespace

template <int Dim>
std::vector<Contact> find_contacts(const Flow<Dim>& flow, const StepStart<Dim>& start, double dt,
                                   std::span<const Freedom> freedoms) {
  const ContactSurfaces<Dim>& surfaces = flow.setup.contact;
  const double spacing = flow.setup.spacing;
  std::vector<Contact> contacts;
  for (std::size_t b = 0; b < surfaces.points.size(); ++b) {
    BodyState<Dim> body = flow.state.motion.bodies.each[b];
    body.velocity = start.body_velocity[b];
    for (const Vec<Dim>& point : surfaces.points[b]) {
      const Vec<Dim> x = body.placement(point);
      const NearestWall<Dim> wall = surfaces.resting.nearest(x, spacing);
      if (wall.face < 0) continue;
      const double distance = std::abs(wall.signed_distance);
      const Vec<Dim> away = distance > corner_tolerance * spacing ? Vec<Dim>((x - wall.point) / wall.signed_distance)
                                                                  : surfaces.resting.faces[wall.face].normal;
      Contact contact{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(freedoms.size())),
                      away.dot(body.velocity_at(x)) + std::max(0.0, wall.signed_distance) / dt};
      const Turn<Dim> arm = moment_of<Dim>(x - body.centre, away);
      for (std::size_t w = 0; w < freedoms.size(); ++w) {
        const auto [other, entry] = freedoms[w];
        if (other != b) continue;
        contact.direction[static_cast<Eigen::Index>(w)] = entry < Dim ? away[entry] : arm[entry - Dim];
      }
      contacts.push_back(std::move(contact));
    }
  }
  return contacts;
}

// A sweep gives each contact in turn the force that it needs (projected Gauss-Seidel).
Eigen::VectorXd admitted(std::vector<Contact>& contacts, const Eigen::MatrixXd& inertia, double dt,
                         const Eigen::VectorXd& wanted, Eigen::VectorXd& push) {
  push.setZero();
  Eigen::VectorXd A = wanted;
  const auto factors = inertia.fullPivLu();
  for (int sweep = 0; sweep < contact_sweeps; ++sweep) {
    bool is_changed = false;
    for (Contact& contact : contacts) {
      if (sweep == 0) contact.force = 0.0;
      const double speed = contact.speed_after(dt, A);
      if (speed >= 0.0 && contact.force == 0.0) continue;
      const Eigen::VectorXd answer = factors.solve(contact.direction);
      const double mobility = dt * contact.direction.dot(answer);
      if (mobility <= 0.0) continue;  // it cannot move that way
      const double change = std::max(-speed / mobility, -contact.force);
      contact.force += change;
      A += change * answer;
      push += change * contact.direction;
      is_changed = true;
    }
    if (!is_changed) break;
  }
  return A;
}

template std::vector<Contact> find_contacts<2>(const Flow<2>&, const StepStart<2>&, double, std::span<const Freedom>);
template std::vector<Contact> find_contacts<3>(const Flow<3>&, const StepStart<3>&, double, std::span<const Freedom>);

}  // namespace tailwater
