#include "porous/porous_layers.h"

#include <algorithm>
#include <cmath>

#include "base/box.h"
#include "base/for_each.h"
#include "flow/flow.h"
#include "flow/pressure_equation.h"
#include "geometry/from_spec.h"
#include "io/messages.h"
#include "motion/floating_body.h"
#include "neighbours/neighbourhood.h"
#include "operators/laplacian_morris.h"
#include "porous/layer_checks.h"
#include "porous/porous_region.h"
#include "pressure/full_water.h"

namespace tailwater {
namespace {

constexpr int lattice_count = 65;

}  // namespace

template <int Dim>
PorousLayers<Dim>::PorousLayers(const CaseSpec& spec, const Setup<Dim>& setup, const Boundary<Dim>& boundary)
    : field_(spec, boundary, setup.scale.kernel, setup.domain) {
  require_sound_layers(spec, boundary, field_);
  for (const PorousTable& table : spec.porous) {
    regions_.emplace_back(spec, table);
    region_names_.push_back(table.name);
  }
  for (const FloatingBody<Dim>& body : make_bodies<Dim>(spec)) bodies_.push_back({body.name, body.walls});
  // The range is from water that has left the tightest layer to water that has entered it.
  const double dx = setup.scale.spacing;
  const double widening = std::pow(field_.min_porosity(), -1.0 / Dim);
  min_spacing_ = dx / widening;
  spacing_step_ = (dx * widening - min_spacing_) / (lattice_count - 1);
  for (int k = 0; k < lattice_count; ++k) {
    lattices_.push_back(lattice_sums<Dim>(setup.scale.kernel, min_spacing_ + k * spacing_step_));
  }
}

template <int Dim>
void PorousLayers<Dim>::warn(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  for (BodyWalls& body : bodies_) {
    if (body.is_told) continue;
    for (std::size_t r = 0; r < regions_.size(); ++r) {
      const std::size_t inside = count_each(particles.owned, [&](std::size_t i) {
        if (particles.is_fluid(i)) return false;
        const int wall = flow.walls.particles.wall[particles.wall_row[i]];
        const Vec<Dim>& x = particles.position[i];
        return std::ranges::find(body.walls, wall) != body.walls.end() && regions_[r].box().contains(x) &&
               regions_[r].depth_inside(x, flow.setup.scale.spacing) > 0.0;
      });
      if (body.is_told || !flow.setup.ranks.any(inside > 0)) continue;
      body.is_told = true;
      tailwater::warn(
          "body-entered-porous-layer",
          "body '{}' has entered porous layer '{}' by t = {:.4f} s, and passes through its stones, which do "
          "not hold bodies; draw the surface of the layer as a wall",
          body.name, region_names_[r], flow.state.time);
    }
  }
}

template <int Dim>
void PorousLayers<Dim>::begin(Flow<Dim>& flow) {
  flow.pores = this;
}

template <int Dim>
PoreSpace PorousLayers<Dim>::at(const Vec<Dim>& x) const {
  const PorousMedium medium = field_.at(x);
  return {medium.porosity(), 1.0 + medium.added_mass};
}

template <int Dim>
double PorousLayers<Dim>::resistance_at(const Vec<Dim>& x, double speed) const {
  const PorousMedium medium = field_.at(x);
  return medium.linear + medium.quadratic * speed;
}

template <int Dim>
LatticeSums PorousLayers<Dim>::lattice_of(double volume) const {
  const double steps = (std::pow(volume, 1.0 / Dim) - min_spacing_) / spacing_step_;
  const double bounded = std::clamp(steps, 0.0, lattice_count - 1.0);
  const int low = std::min(static_cast<int>(bounded), lattice_count - 2);
  const double share = bounded - low;
  const LatticeSums& below = lattices_[low];
  const LatticeSums& above = lattices_[low + 1];
  return {.concentration = std::lerp(below.concentration, above.concentration, share),
          .morris = std::lerp(below.morris, above.morris, share),
          .across_plane = std::lerp(below.across_plane, above.across_plane, share)};
}

/// Gives water the volume that it occupies at its present place. Indices change between steps only, when nothing has
/// moved since the last call: a particle with a new index still has the old position.
template <int Dim>
void PorousLayers<Dim>::arrive(Flow<Dim>& flow) {
  Particles<Dim>& particles = flow.state.particles;
  arrivals_.resize(particles.owned);
  for_each(particles.owned, [&](std::size_t i) {
    const double porosity = particles.is_fluid(i) ? field_.porosity_at(particles.position[i]) : 1.0;
    if (arrivals_[i].id == particles.id[i]) particles.volume[i] *= arrivals_[i].porosity / porosity;
    arrivals_[i] = {particles.id[i], porosity};
  });
  // Ghosts that are not renewed receive new positions only.
  const bool some_are_renewed = flow.setup.ranks.any(!flow.neighbourhood->has_pairs());
  if (!some_are_renewed) flow.halo().exchange(particles.volume);
}

/// Turns u into n u, with the media at the water's mid-step position or at its position at the end of the step.
template <int Dim>
void PorousLayers<Dim>::begin_projection(Flow<Dim>& flow, Projection projection, double dt) {
  Particles<Dim>& particles = flow.state.particles;
  const double way = projection == Projection::of_step ? 0.5 * dt : 0.0;
  media_.resize(particles.owned);
  conductance_.resize(particles.owned);
  for_each(particles.owned, [&](std::size_t i) {
    Vec<Dim>& velocity = particles.velocity[i];
    media_[i] = particles.is_fluid(i) ? field_.at(particles.position[i] + way * velocity) : PorousMedium{};
    conductance_[i] = media_[i].porosity() * media_[i].mobility(velocity.norm(), dt);
    if (particles.is_fluid(i)) velocity *= media_[i].porosity();
  });
  flow.halo().exchange(conductance_);
  unprojected_.assign(particles.velocity.begin(),
                      particles.velocity.begin() + static_cast<std::ptrdiff_t>(particles.owned));
}

template <int Dim>
void PorousLayers<Dim>::change_prediction(const Flow<Dim>& flow, std::span<const Vec<Dim>> acceleration, double dt,
                                          std::span<Vec<Dim>> predicted) {
  const Particles<Dim>& particles = flow.state.particles;
  work_of_solid_ = sum_over(particles.owned, 0.0, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return 0.0;
    const Vec<Dim> u = unprojected_[i] / media_[i].porosity();
    const double mass = flow.setup.liquid.density * media_[i].solid * particles.volume[i];
    return mass * acceleration[i].dot(dt * (u + 0.5 * dt * acceleration[i]));
  });
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    const Vec<Dim> u = unprojected_[i] / media_[i].porosity();
    predicted[i] = conductance_[i] * ((1.0 + media_[i].added_mass) * u + dt * acceleration[i]);
    unprojected_[i] = predicted[i];
  });
}

/// Subtracts dt/2 (grad v . u) . grad n and divides by n: the target dt/2 tr(grad u . grad v) with the known gradient
/// of v.
template <int Dim>
void PorousLayers<Dim>::change_target(const Flow<Dim>& flow, std::span<const Mat<Dim>> velocity_gradient, double dt,
                                      std::span<double> target) const {
  const Particles<Dim>& particles = flow.state.particles;
  for_each(target.size(), [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    const double n = media_[i].porosity();
    const Vec<Dim> u = particles.velocity[i] / n;
    const Vec<Dim> slope = field_.porosity_gradient_at(particles.position[i] + 0.5 * dt * u);
    target[i] = (target[i] - 0.5 * dt * (velocity_gradient[i] * u).dot(slope)) / n;
  });
}

/// Harmonic mean, so that the flow between an open and a tight medium is the one that both admit. Walls have the
/// conductance of the water beside them.
template <int Dim>
double PorousLayers<Dim>::mean_conductance(const Flow<Dim>& flow, std::size_t i, std::size_t j) const {
  const double own = conductance_[i];
  if (!flow.state.particles.is_fluid(j)) return own;
  return 2.0 * own * conductance_[j] / (own + conductance_[j]);
}

/// Multiplies the weights of water by the conductance of each pair, and the closing weight of the row by that of the
/// particle.
template <int Dim>
void PorousLayers<Dim>::write_rows(Flow<Dim>& flow) {
  const Pairs<Dim>& pairs = flow.pairs();
  for_each(pairs.owned(), [&](std::size_t i) {
    if (flow.role[i] != Role::water || flow.equation->rows.scale(i) == 0.0) return;
    const double closing = 1.0 / flow.equation->rows.scale(i) - flow.equation->rows.sum_of_weights(i);
    LinearSystem::Row row = flow.equation->rows.row(i);
    const double sum = row.write_weights([&](float* weights) {
      double weights_sum = 0.0;
      for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k, ++weights) {
        *weights *= static_cast<float>(mean_conductance(flow, i, pairs.j[k]));
        weights_sum += *weights;
      }
      return weights_sum;
    });
    row.finish(sum + conductance_[i] * closing, 0.0);
  });
}

/// Adds the divergence of gravity where the conductance varies, in the two-point form of the rows, so that water at
/// rest stays at rest in layers as well as outside.
template <int Dim>
int PorousLayers<Dim>::pose(Flow<Dim>& flow, std::span<const Vec<Dim>> /*predicted*/, double /*dt*/) {
  const Pairs<Dim>& pairs = flow.pairs();
  const Particles<Dim>& particles = flow.state.particles;
  const Setup<Dim>& setup = flow.setup;
  const Vec<Dim> weight = setup.liquid.density * setup.gravity;
  std::vector<double> source(particles.owned, 0.0);
  for_each(pairs.owned(), [&](std::size_t i) {
    if (flow.role[i] != Role::water) return;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const std::size_t j = pairs.j[k];
      const double excess = mean_conductance(flow, i, j) - conductance_[i];
      if (excess == 0.0) continue;
      const Vec<Dim> d = pairs.d(i, k);
      const double c =
          morris_laplacian_weight(particles.volume[j], pairs.F(i, k), d.squaredNorm(), setup.scale.spacing);
      source[i] += c * excess * weight.dot(d);
    }
  });
  take_out_mean(flow, find_fullness(flow), source);
  LinearSystem& rows = flow.equation->rows;
  for_each(source.size(), [&](std::size_t i) { rows.rhs()[i] += rows.scale(i) * source[i]; });
  return 0;
}

/// Multiplies the change of velocity by pressure and gravity in open water by the conductance; then turns v into u. A
/// prescribed velocity has not changed.
template <int Dim>
void PorousLayers<Dim>::finish_projection(Flow<Dim>& flow) {
  Particles<Dim>& particles = flow.state.particles;
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    Vec<Dim>& velocity = particles.velocity[i];
    if (!is_claimed(flow.role[i])) velocity = unprojected_[i] + conductance_[i] * (velocity - unprojected_[i]);
    velocity /= media_[i].porosity();
  });
}

template <int Dim>
void PorousLayers<Dim>::correct(Flow<Dim>& flow, double /*dt*/) {
  finish_projection(flow);
}

template <int Dim>
void PorousLayers<Dim>::project_again(Flow<Dim>& flow, const std::vector<double>& /*correction*/, double /*dt*/) {
  finish_projection(flow);
}

/// Restores u: nothing has been corrected, and the velocity is still the one at the beginning of the projection.
template <int Dim>
void PorousLayers<Dim>::stay(Flow<Dim>& flow) {
  Particles<Dim>& particles = flow.state.particles;
  for_each(particles.owned, [&](std::size_t i) {
    if (particles.is_fluid(i)) particles.velocity[i] /= media_[i].porosity();
  });
}

/// Subtracts the energy dissipated by the resistance, and the work of viscous forces that was counted in the volume of
/// the grains.
template <int Dim>
void PorousLayers<Dim>::add_work(const Flow<Dim>& flow, const std::vector<double>& /*on_walls*/, double /*dt*/,
                                 Works& works) const {
  const Particles<Dim>& particles = flow.state.particles;
  const double resisted = sum_over(particles.owned, 0.0, [&](std::size_t i) {
    if (!particles.is_fluid(i) || is_claimed(flow.role[i])) return 0.0;
    const double mobility = conductance_[i] / media_[i].porosity();
    const double slowing = 1.0 / mobility - 1.0 - media_[i].added_mass;  // r dt
    const double mass = flow.setup.liquid.density * flow.water_volume_of(i);
    return mass * slowing * particles.velocity[i].squaredNorm();
  });
  works.viscous -= resisted + work_of_solid_;
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_porous_layers(const CaseSpec& spec, const Setup<Dim>& setup,
                                              const Boundary<Dim>& boundary) {
  if (spec.porous.empty()) return nullptr;
  return std::make_unique<PorousLayers<Dim>>(spec, setup, boundary);
}

template class PorousLayers<2>;
template class PorousLayers<3>;
TAILWATER_IN_2D_AND_3D(make_porous_layers);

}  // namespace tailwater
