#include "rheology/coulomb_friction.h"

#include <algorithm>
#include <cmath>

#include "base/for_each.h"
#include "neighbours/halo.h"

namespace tailwater {

template <int Dim>
bool CoulombFriction<Dim>::is_sliding_wall(const Flow<Dim>& flow, std::size_t i) const {
  const Particles<Dim>& particles = flow.state.particles;
  if (particles.is_fluid(i)) return false;
  return flow.walls.boundary.walls[flow.walls.particles.wall[particles.wall_row[i]]].coulomb_friction > 0.0;
}

template <int Dim>
void CoulombFriction<Dim>::locate(const Flow<Dim>& flow) {
  has_walls_ = std::ranges::any_of(flow.walls.boundary.walls,
                                   [](const WallProperties& wall) { return wall.coulomb_friction > 0.0; });
  if (!has_walls_) return;
  const Pairs<Dim>& pairs = flow.pairs();
  const Particles<Dim>& particles = flow.state.particles;
  walls_.clear();
  contacts_.clear();
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: lists
    if (is_sliding_wall(flow, i)) walls_.push_back(i);
    if (!particles.is_fluid(i) || pairs.sees_wall[i] == 0) continue;
    Contact contact{.particle = i};
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = static_cast<std::size_t>(pairs.j[k]);
      if (!is_sliding_wall(flow, j)) continue;
      const auto row = particles.wall_row[j];
      const double c = particles.volume[j] * wall_factor<Dim>(flow, row, pairs.d(i, k), pairs.F(i, k));
      contact.weight += c;
      contact.along += c * along_wall<Dim>(flow, row);
    }
    if (contact.weight > 0.0) contacts_.push_back(contact);
  }
  relief_.assign(particles.owned, Mat<Dim>::Zero());
  offset_.assign(particles.owned, Vec<Dim>::Zero());
}

template <int Dim>
void CoulombFriction<Dim>::begin_passes() {
  for (Contact& contact : contacts_) contact.slides = false;
}

template <int Dim>
void CoulombFriction<Dim>::find_bounds(const Flow<Dim>& flow, const WallRates<Dim>& walls,
                                       const std::vector<double>& pressure, std::span<const Vec<Dim>> velocity,
                                       std::span<const double> viscosity) {
  const Pairs<Dim>& pairs = flow.pairs();
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<Vec<Dim>> reactions(walls_.size());
  flow.discretisation().wall_reactions(flow, walls_, pressure, reactions);
  std::vector<double> over_weight(particles.size(), 0.0);  // mu_f N_w over the sum of c_iw d_i
  for_each(walls_.size(), [&](std::size_t n) {
    const std::size_t w = walls_[n];
    const auto row = particles.wall_row[w];
    const Vec<Dim>& normal = flow.walls.particles.normal[row];
    double pressing = particles.volume[w] * reactions[n].dot(normal);
    double weight = 0.0;
    for (std::size_t k = pairs.begin(w); k < pairs.end(w); ++k) {
      const auto i = static_cast<std::size_t>(pairs.j[k]);
      if (!particles.is_fluid(i)) continue;
      const Vec<Dim> d = -pairs.d(w, k);
      const double c = particles.volume[i] * particles.volume[w] * wall_factor<Dim>(flow, row, d, pairs.F(w, k));
      weight += c * distance_from_wall<Dim>(flow, row, d);
      pressing -= viscosity[i] * c * (velocity[i] - walls.at(flow.walls, row, d)).dot(normal);
    }
    const double mu = flow.walls.boundary.walls[flow.walls.particles.wall[row]].coulomb_friction;
    if (weight > 0.0) over_weight[w] = mu * std::max(0.0, pressing) / weight;
  });
  flow.halo().exchange(over_weight);
  for_each(contacts_.size(), [&](std::size_t n) {
    Contact& contact = contacts_[n];
    const std::size_t i = contact.particle;
    contact.bound = 0.0;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto w = static_cast<std::size_t>(pairs.j[k]);
      if (over_weight[w] == 0.0) continue;
      const auto row = particles.wall_row[w];
      const Vec<Dim> d = pairs.d(i, k);
      contact.bound += over_weight[w] * particles.volume[i] * particles.volume[w] *
                       wall_factor<Dim>(flow, row, d, pairs.F(i, k)) * distance_from_wall<Dim>(flow, row, d);
    }
  });
}

template <int Dim>
typename CoulombFriction<Dim>::NoSlip CoulombFriction<Dim>::no_slip(const Contact& contact, const Vec<Dim>& s) const {
  const Vec<Dim> along = contact.along * s;
  return {along, std::sqrt(std::max(0.0, s.dot(along)))};
}

/// The shear rate x of the liquid beside the wall, which replaces q, has the friction of the bound where q has more:
/// mu x grows with x for every law.
template <int Dim>
void CoulombFriction<Dim>::slide(const Flow<Dim>& flow, const LawOfParticle& law, const Vec<Dim>& s, Contact& contact,
                                 double& rate) {
  constexpr int halvings = 40;
  const std::size_t i = contact.particle;
  const double size = flow.state.particles.volume[i] * std::sqrt(contact.weight);
  const NoSlip full = no_slip(contact, s);
  const bool has_turned = contact.slides && full.along.dot(contact.direction) < 0.0;
  contact.slides = !has_turned && size * law(i, rate) * full.q > contact.bound;
  relief_[i].setZero();
  offset_[i].setZero();
  if (!contact.slides) return;
  contact.direction = full.along;
  const double other = std::max(0.0, rate * rate - full.q * full.q);
  double low = 0.0;
  double high = full.q;
  for (int n = 0; n < halvings; ++n) {
    const double x = 0.5 * (low + high);
    (size * law(i, std::sqrt(other + x * x)) * x > contact.bound ? high : low) = x;
  }
  rate = std::sqrt(other + low * low);
  const double over_q = contact.bound / (std::sqrt(contact.weight) * full.q);
  const Mat<Dim> across = contact.along - full.along * full.along.transpose() / (full.q * full.q);
  relief_[i] = flow.state.particles.volume[i] * law(i, rate) * contact.along - over_q * across;
  offset_[i] = over_q * full.along;
}

template <int Dim>
void CoulombFriction<Dim>::slide(const Flow<Dim>& flow, const WallRates<Dim>& walls, const LawOfParticle& law,
                                 const std::vector<double>& pressure, std::span<const Vec<Dim>> velocity,
                                 std::span<const Vec<Dim>> at_walls, std::span<const double> viscosity,
                                 std::span<double> rate) {
  find_bounds(flow, walls, pressure, velocity, viscosity);
  for_each(contacts_.size(), [&](std::size_t n) {
    const std::size_t i = contacts_[n].particle;
    slide(flow, law, velocity[i] - at_walls[i], contacts_[n], rate[i]);
  });
}

template <int Dim>
bool CoulombFriction<Dim>::has_changed(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity,
                                       std::span<const Vec<Dim>> at_walls, std::span<const double> viscosity) const {
  constexpr double rounding = 1e-3;  // of velocities, whose solve ends before
  const bool changed = std::ranges::any_of(contacts_, [&](const Contact& contact) {
    const std::size_t i = contact.particle;
    const NoSlip full = no_slip(contact, velocity[i] - at_walls[i]);
    if (contact.slides) return full.along.dot(contact.direction) < 0.0;
    const double friction = flow.state.particles.volume[i] * viscosity[i] * std::sqrt(contact.weight) * full.q;
    return friction > (1.0 + rounding) * contact.bound;
  });
  return flow.setup.ranks.any(changed);
}

template <int Dim>
bool CoulombFriction<Dim>::slides_anywhere(const Flow<Dim>& flow) const {
  if (!has_walls_) return false;
  return flow.setup.ranks.any(std::ranges::any_of(contacts_, &Contact::slides));
}

template <int Dim>
std::vector<double> CoulombFriction<Dim>::fractions(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity,
                                                    std::span<const Vec<Dim>> at_walls,
                                                    std::span<const double> viscosity) const {
  std::vector<double> fraction(flow.state.particles.size(), 1.0);
  for_each(contacts_.size(), [&](std::size_t n) {
    const Contact& contact = contacts_[n];
    const std::size_t i = contact.particle;
    const double q = no_slip(contact, velocity[i] - at_walls[i]).q;
    const double friction = flow.state.particles.volume[i] * viscosity[i] * std::sqrt(contact.weight) * q;
    if (friction > contact.bound) fraction[i] = contact.bound / friction;
  });
  flow.halo().exchange(fraction);
  return fraction;
}

template class CoulombFriction<2>;
template class CoulombFriction<3>;

}  // namespace tailwater
