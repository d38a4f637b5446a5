#include "rheology/viscous_operator.h"

#include <algorithm>

#include "base/for_each.h"
#include "closures/fluid_pairs.h"
#include "neighbours/halo.h"
#include "neighbours/pair_lanes.h"
#include "operators/symmetric.h"
#include "rheology/wall_pair.h"

namespace tailwater {
namespace {

/// Least eigenvalues of the moment below which there is no gradient, and above which it counts in full. Across a
/// surface it is 1/2 on a lattice, of a single row 0.
constexpr double no_moment = 0.1;
constexpr double full_moment = 0.25;

}  // namespace

/// Writes the weights of fluid of particle i, for products: the kernel costs more than all the rest of them. Returns
/// their moment.
template <int Dim>
[[gnu::flatten]] Mat<Dim> ViscousOperator<Dim>::weigh_fluid(const Flow<Dim>& flow, std::size_t i) {
  const Pairs<Dim>& pairs = flow.pairs();
  float* const row = fluid_weight_.data() + pairs.begin(i);
  SymmetricLanes<Dim> moment{};
  for_each_pair(pairs, i, [&](const auto& batch) {
    const PlaceLanes<Dim> place = batch.place();
    const Lanes weight = batch.store(place.volume_of_fluid() * batch.F(place.d), row);
    moment.add(weight * place.d, place.d);
  });
  return sum_of(moment);
}

/// Adds up the walls beside fluid particle i, and returns their moment.
template <int Dim>
Mat<Dim> ViscousOperator<Dim>::weigh_walls(const Flow<Dim>& flow, const WallRates<Dim>& walls, std::size_t i) {
  const Pairs<Dim>& pairs = flow.pairs();
  const Particles<Dim>& particles = flow.state.particles;
  Mat<Dim> moment = Mat<Dim>::Zero();
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = pairs.j[k];
    if (particles.is_fluid(j)) continue;
    const Vec<Dim> d = pairs.d(i, k);
    const double F = pairs.F(i, k);
    const auto row = particles.wall_row[j];
    const double of_wall = particles.volume[j] * wall_factor(flow, row, d, F);
    moment += flow.walls.friction[row] * particles.volume[j] * F * d * d.transpose();
    wall_weight_[i] += of_wall;
    if (flow.walls.friction[row] < 1.0) {
      slip_weight_[i] += (1.0 - flow.walls.friction[row]) * of_wall * along_wall<Dim>(flow, row);
    }
    wall_velocity_[i] += of_wall * walls.at(flow.walls, row, d);
  }
  if (wall_weight_[i] > 0.0) wall_velocity_[i] /= wall_weight_[i];
  return moment;
}

template <int Dim>
void ViscousOperator<Dim>::locate(const Flow<Dim>& flow, const WallRates<Dim>& walls) {
  const Pairs<Dim>& pairs = flow.pairs();
  const Particles<Dim>& particles = flow.state.particles;
  const std::size_t owned = particles.owned;
  make_room(fluid_weight_, pairs.j.size());
  fluid_weight_.resize(pairs.j.size());
  inverse_moment_.assign(owned, Mat<Dim>::Zero());
  share_.assign(owned, 0.0);
  fluid_share_.assign(owned, 1.0);
  wall_weight_.assign(owned, 0.0);
  wall_velocity_.assign(owned, Vec<Dim>::Zero());
  slips_ =
      std::ranges::any_of(flow.walls.boundary.walls, [](const WallProperties& wall) { return wall.friction < 1.0; });
  slip_weight_.assign(slips_ ? owned : 0, Mat<Dim>::Zero());
  for_each(owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    const Mat<Dim> moment = weigh_fluid(flow, i);
    const Mat<Dim> of_walls = weigh_walls(flow, walls, i);
    const double least = min_eigenvalue<Dim>(moment);
    share_[i] = std::clamp((least - no_moment) / (full_moment - no_moment), 0.0, 1.0);
    if (share_[i] == 0.0) return;
    inverse_moment_[i] = moment.inverse();
    if (wall_weight_[i] > 0.0) fluid_share_[i] = least / min_eigenvalue<Dim>(moment + of_walls);
  });
  coulomb_.locate(flow);
}

template <int Dim>
[[gnu::flatten]] Mat<Dim> ViscousOperator<Dim>::gradient(const Flow<Dim>& flow, std::span<const Float4> velocity,
                                                         std::size_t i) const {
  MatLanes<Dim> sums{};
  for_each_pair(flow.pairs(), i, [&](const auto& batch) {
    const VecLanes<Dim> d = batch.place().d;
    const VecLanes<Dim> difference = batch.range.load(fluid_weight_.data()) * (batch.of(velocity) - velocity[i]);
    for (int b = 0; b < Dim; ++b) sums.column[b] -= d.at[b] * difference;
  });
  return sum_of(sums) * inverse_moment_[i];
}

template <int Dim>
void ViscousOperator<Dim>::find_shear_rates(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity,
                                            std::span<double> rate) const {
  const Particles<Dim>& particles = flow.state.particles;
  const std::vector<Float4> in_single = as_float4<Dim>(velocity);
  for_each(particles.owned, [&](std::size_t i) {
    rate[i] = 0.0;
    if (!particles.is_fluid(i)) return;
    const Vec<Dim> beside_walls = velocity[i] - wall_velocity_[i];
    double squared = wall_weight_[i] * beside_walls.squaredNorm();
    if (slips_) squared = std::max(0.0, squared - beside_walls.dot(slip_weight_[i] * beside_walls));
    if (share_[i] > 0.0) {
      const Mat<Dim> G = gradient(flow, in_single, i);
      const Mat<Dim> twice_D = G + G.transpose();
      MatLanes<Dim> linear{};
      for (int a = 0; a < Dim; ++a) {
        for (int b = 0; b < Dim; ++b) linear.column[b].at[a] = in_all_lanes(G(a, b));
      }
      LaneSum rest;
      for_each_pair(flow.pairs(), i, [&](const auto& batch) {
        VecLanes<Dim> z = batch.of(in_single) - in_single[i];
        z += linear.times(batch.place().d);
        rest += batch.range.load(fluid_weight_.data()) * z.dot(z);
      });
      squared += share_[i] * (fluid_share_[i] * 0.5 * twice_D.squaredNorm() + rest.total());
    }
    rate[i] = std::sqrt(squared);
  });
}

template <int Dim>
void ViscousOperator<Dim>::slide(const Flow<Dim>& flow, const WallRates<Dim>& walls, const LawOfParticle& law,
                                 const std::vector<double>& pressure, std::span<const Vec<Dim>> velocity,
                                 std::span<double> rate) {
  coulomb_.slide(flow, walls, law, pressure, velocity, wall_velocity_, viscosity_, rate);
}

template <int Dim>
bool ViscousOperator<Dim>::has_changed_slip(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity) const {
  return coulomb_.has_walls() && coulomb_.has_changed(flow, velocity, wall_velocity_, viscosity_);
}

template <int Dim>
void ViscousOperator<Dim>::set_viscosity(const Flow<Dim>& flow, std::span<const double> viscosity) {
  viscosity_.assign(viscosity.begin(), viscosity.end());
  shared_viscosity_.resize(viscosity.size());
  for_each(viscosity.size(), [&](std::size_t i) { shared_viscosity_[i] = share_[i] * viscosity[i]; });
  flow.halo().exchange(viscosity_, shared_viscosity_);
}

template <int Dim>
void ViscousOperator<Dim>::find_forces(const Flow<Dim>& flow, std::vector<Vec<Dim>>& velocity,
                                       std::span<Vec<Dim>> force) {
  const Particles<Dim>& particles = flow.state.particles;
  flow.halo().exchange(velocity);
  const std::vector<Float4> in_single = as_float4<Dim>(std::span<const Vec<Dim>>(velocity));
  using End = StressEnd<Dim>;
  ends_.resize(particles.size());
  for_each(particles.owned, [&](std::size_t i) {
    End& end = ends_[i];
    for (int a = 0; a < Dim; ++a) end.velocity[a] = in_single[i].at[a];
    end.viscosity = static_cast<float>(shared_viscosity_[i]);
    end.transposed.fill(0.0F);
    if (shared_viscosity_[i] == 0.0) return;
    const Mat<Dim> G = gradient(flow, in_single, i);
    const Mat<Dim> Q = shared_viscosity_[i] * (fluid_share_[i] * (G + G.transpose()) * inverse_moment_[i] - G);
    for (int n = 0; n < Dim * Dim; ++n) end.transposed[n] = static_cast<float>(Q.data()[n]);
  });
  flow.halo().exchange(ends_);
  for_each(particles.owned, [&](std::size_t i) {
    force[i].setZero();
    if (!particles.is_fluid(i)) return;
    force[i] = force_of_fluid(flow, i) - friction_of_walls(flow, i) * velocity[i];
    if (may_slip()) force[i] += relief_of_walls(flow, i) * velocity[i];
  });
}

template <int Dim>
[[gnu::flatten]] Vec<Dim> ViscousOperator<Dim>::force_of_fluid(const Flow<Dim>& flow, std::size_t i) const {
  using End = StressEnd<Dim>;
  const auto number = [](std::size_t offset) { return offset / sizeof(float); };
  const End& own = ends_[i];
  const Lanes volume = in_all_lanes(flow.state.particles.volume[i]);
  VecSum<Dim> sum;
  for_each_pair(flow.pairs(), i, [&](const auto& batch) {
    const auto other = batch.j.numbers(ends_.data());
    const Lanes weight = volume * batch.range.load(fluid_weight_.data());
    const Lanes viscosity = own.viscosity + other[number(offsetof(End, viscosity))];
    MatLanes<Dim> transposed;
    for (int n = 0; n < Dim * Dim; ++n) {
      transposed.column[n / Dim].at[n % Dim] = own.transposed[n] + other[number(offsetof(End, transposed)) + n];
    }
    VecLanes<Dim> terms = transposed.times(batch.place().d);
    for (int a = 0; a < Dim; ++a) {
      const Lanes difference = other[number(offsetof(End, velocity)) + a] - own.velocity[a];
      terms.at[a] = weight * (viscosity * difference - terms.at[a]);
    }
    sum += terms;
  });
  return sum.total();
}

template <int Dim>
double ViscousOperator<Dim>::write_weights(const Flow<Dim>& flow, std::size_t i, float* weights) const {
  const Lanes volume = in_all_lanes(flow.state.particles.volume[i]);
  LaneSum sum;
  for_each_pair(flow.pairs(), i, [&](const auto& batch) {
    const Lanes viscosity = in_all_lanes(shared_viscosity_[i]) + batch.of(shared_viscosity_);
    sum += batch.store(volume * batch.range.load(fluid_weight_.data()) * viscosity, weights);
  });
  return sum.total();
}

template <int Dim>
void ViscousOperator<Dim>::find_forces_on_walls(const Flow<Dim>& flow, const WallRates<Dim>& walls,
                                                std::span<const Vec<Dim>> velocity, std::span<Vec<Dim>> force) const {
  const Pairs<Dim>& pairs = flow.pairs();
  const Particles<Dim>& particles = flow.state.particles;
  const std::vector<double> fraction =
      coulomb_.has_walls() ? coulomb_.fractions(flow, velocity, wall_velocity_, viscosity_) : std::vector<double>();
  for_each(pairs.owned(), [&](std::size_t w) {
    if (particles.is_fluid(w)) return;
    const auto row = particles.wall_row[w];
    const double lost = 1.0 - flow.walls.friction[row];
    const bool may_slide = flow.walls.boundary.walls[flow.walls.particles.wall[row]].coulomb_friction > 0.0;
    const Vec<Dim>& n = flow.walls.particles.normal[row];
    force[w] = particles.volume[w] * sum_over_fluid(pairs, particles, w, [&](std::int32_t i, std::size_t k) {
                 const Vec<Dim> d = -pairs.d(w, k);
                 const double factor = wall_factor<Dim>(flow, row, d, pairs.F(w, k));
                 Vec<Dim> slip_velocity = velocity[i] - walls.at(flow.walls, row, d);
                 const double of_pair = may_slide ? 1.0 - fraction[i] : lost;
                 if (of_pair > 0.0) slip_velocity -= of_pair * (slip_velocity - n.dot(slip_velocity) * n);
                 return Vec<Dim>(particles.volume[i] * viscosity_[i] * factor * slip_velocity);
               });
  });
}

template class ViscousOperator<2>;
template class ViscousOperator<3>;

}  // namespace tailwater
