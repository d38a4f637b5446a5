#include "schemes/flow.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/from_spec.h"
#include "operators/laplacian_shao_lo.h"

namespace tailwater {
namespace {

/// Lists reach this far beyond the support [dx]: half of it is what the fastest particle moves in a step, so that a
/// list lasts for about one and every pass of the implicit iteration. Wider lists cost more at each evaluation than
/// they save searches (docs/theory/neighbours.md).
constexpr double skin_over_spacing = 0.6;

/// With the density source: speeds beyond this multiple of sqrt(2 g L) are those of particles thrown out.
constexpr double fastest_counted_over_reference = 2.0;

/// Two-point weights between a lattice and its mirror image give the stress nu u/(0.59 dx) (default kernel).
constexpr double wall_law_distance_over_spacing = 0.6;

template <int Dim>
PeriodicDomain<Dim> periodic_domain(const DomainTable& domain) {
  PeriodicDomain<Dim> periodic;
  for (int d = 0; d < Dim; ++d) {
    const std::vector<double>& range = periodic_range(domain, d);
    if (!range.empty()) periodic[d] = std::pair{range[0], range[1]};
  }
  return periodic;
}

/// dx; what looks for a wall near a particle looks no farther.
constexpr double near_walls = 3.0;

template <int Dim>
Boundary<Dim> make_filed_boundary(const CaseSpec& spec) {
  Boundary<Dim> boundary = make_boundary<Dim>(spec);
  boundary.file_faces(near_walls * spec.particles.spacing);
  return boundary;
}

template <int Dim>
WallModel<Dim> make_wall_model(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  WallModel<Dim> walls;
  walls.treatment = spec.scheme.walls;
  switch (walls.treatment) {
    case WallTreatment::dummies:
      walls.particles = make_dummy_particles(boundary, spec.particles.spacing, dummy_layers(spec));
      break;
    case WallTreatment::pressure_rows:
      walls.particles = make_surface_particles(boundary, spec.particles.spacing);
      break;
    case WallTreatment::row_and_dummies:
      walls.particles = make_row_and_dummy_particles(boundary, spec.particles.spacing, dummy_layers(spec));
      break;
  }
  for (const int wall : walls.particles.wall) walls.friction.push_back(boundary.walls[wall].friction);
  walls.velocity.assign(walls.particles.size(), Vec<Dim>::Zero());
  return walls;
}

/// Fluid first, then walls; ids in that order.
template <int Dim>
Particles<Dim> make_particles(const FluidParticles<Dim>& fluid, const WallParticles<Dim>& walls, double volume) {
  Particles<Dim> particles;
  const std::size_t fluid_count = fluid.position.size();
  particles.resize(fluid_count + walls.size());
  particles.owned = particles.size();
  for (std::size_t i = 0; i < particles.owned; ++i) {
    const bool is_fluid = i < fluid_count;
    particles.position[i] = is_fluid ? fluid.position[i] : walls.position[i - fluid_count];
    particles.velocity[i] = is_fluid ? fluid.velocity[i] : Vec<Dim>(Vec<Dim>::Zero());
    particles.pressure[i] = 0.0;
    particles.volume[i] = volume;
    particles.kind[i] = is_fluid ? ParticleKind::fluid : ParticleKind::wall;
    particles.wall_row[i] = is_fluid ? -1 : static_cast<std::int32_t>(i - fluid_count);
    particles.id[i] = static_cast<std::int64_t>(i);
  }
  return particles;
}

/// Leaves each rank an equal number of the particles that all have made.
template <int Dim>
void keep_any_share(const Communicator& ranks, Neighbourhood<Dim>& neighbourhood, Particles<Dim>& particles) {
  if (ranks.is_alone()) return;
  const auto begin_of = [&](int rank) { return static_cast<std::int32_t>(particles.owned * rank / ranks.size()); };
  std::vector<std::int32_t> kept(begin_of(ranks.rank() + 1) - begin_of(ranks.rank()));
  std::iota(kept.begin(), kept.end(), begin_of(ranks.rank()));
  neighbourhood.keep(particles, kept);
}

/// Height of the fluid along gravity [m]; its largest extent where there is no gravity.
template <int Dim>
double fluid_height(const FluidParticles<Dim>& fluid, const Vec<Dim>& gravity, double spacing) {
  if (fluid.position.empty()) return 0.0;
  Vec<Dim> low = fluid.position[0];
  Vec<Dim> high = fluid.position[0];
  for (const Vec<Dim>& position : fluid.position) {
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  if (gravity.norm() == 0.0) return (high - low).maxCoeff() + spacing;
  const Vec<Dim> down = gravity.normalized();
  double lowest = down.dot(fluid.position[0]);
  double highest = lowest;
  for (const Vec<Dim>& position : fluid.position) {
    lowest = std::max(lowest, down.dot(position));
    highest = std::min(highest, down.dot(position));
  }
  return lowest - highest + spacing;
}

}  // namespace

Interventions& Interventions::operator+=(const Interventions& other) {
  put_back += other.put_back;
  capped_shifts += other.capped_shifts;
  clamped_pressures += other.clamped_pressures;
  fallback_rows += other.fallback_rows;
  restarted_solves += other.restarted_solves;
  return *this;
}

template <int Dim>
Flow<Dim>::Flow(const CaseSpec& spec, const Communicator& all_ranks)
    : ranks(all_ranks),
      scheme(spec.scheme),
      density(spec.physics.density),
      spacing(spec.particles.spacing),
      gravity(to_vec<Dim>(spec.physics.gravity, "physics", "gravity")),
      boundary(make_filed_boundary<Dim>(spec)),
      walls(make_wall_model(spec, boundary)),
      wall_motion(spec, boundary, walls.particles),
      decomposition(ranks, spec.parallel),
      neighbourhood(make_kernel<Dim>(spec.scheme.kernel, spec.scheme.support * spacing), spacing,
                    skin_over_spacing * spacing,
                    walls.treatment == WallTreatment::dummies ? WallRows::fluid_only : WallRows::all,
                    periodic_domain<Dim>(spec.domain), ranks),
      pressure_system(spec.pressure_solver, ranks) {
  const FluidParticles<Dim> fluid = make_fluid_particles(spec, boundary);
  particles = make_particles(fluid, walls.particles, power<Dim>(spacing));
  keep_any_share(ranks, neighbourhood, particles);
  decomposition.share_out(particles, neighbourhood.work(particles));
  end_of.assign(particles.owned, -1);
  wall_acceleration.assign(walls.particles.size(), Vec<Dim>::Zero());
  wall_motion.get_velocity(0.0, walls.velocity);
  length = scheme.length > 0.0 ? scheme.length : fluid_height(fluid, gravity, spacing);

  for (const Outlet<Dim>& outlet : make_outlets<Dim>(spec)) {
    open_ends.emplace_back(outlet, gravity, spacing, scheme.support * spacing);
  }
  const Kernel<Dim>& kernel = neighbourhood.kernel();
  lattice = lattice_sums(kernel, spacing);
  air_law = AirLaw(kernel, spacing);
  W_0 = kernel_value(kernel, 0.0);
  eta_squared = shao_lo_eta_squared(kernel_radius(kernel));
  const double g = gravity.norm();
  viscosity_law = {.molecular = spec.physics.viscosity,
                   .artificial = scheme.artificial_viscosity * spacing,
                   .floor = scheme.viscosity_floor * spacing * std::sqrt(g * length),
                   .wall_distance = wall_law_distance_over_spacing * spacing,
                   .channel_width = spec.physics.channel_width};
  shifting_law = {.kind = scheme.shifting,
                  .strength = scheme.shifting_strength,
                  .cap = scheme.shifting_cap * spacing,
                  .spacing = spacing,
                  .W_spacing = kernel_value(kernel, spacing)};
  const double reference_speed = std::sqrt(2.0 * g * length);
  time_step_rule = {.courant = scheme.courant,
                    .spacing = spacing,
                    .reference_speed = reference_speed,
                    .viscous_share = scheme.name == SchemeName::farmani2020 ? 0.1 : 0.25 / Dim};
  if (scheme.source == SourceKind::density && reference_speed > 0.0) {
    time_step_rule.fastest = fastest_counted_over_reference * reference_speed;
  }
  const PeriodicDomain<Dim> domain = periodic_domain<Dim>(spec.domain);
  is_closed = std::all_of(domain.begin(), domain.end(), [](const auto& interval) { return interval.has_value(); });
  pressure_system.set_constant_is_free(is_closed);
}

template <int Dim>
bool Flow<Dim>::uses_tensors() const {
  return scheme.laplacian == LaplacianKind::consistent || scheme.gradient == GradientKind::consistent ||
         scheme.divergence == DivergenceKind::consistent || scheme.surface == SurfaceTreatment::cone ||
         scheme.surface == SurfaceTreatment::farzin || scheme.walls == WallTreatment::pressure_rows ||
         scheme.shifting == ShiftingKind::farzin;
}

template <int Dim>
bool Flow<Dim>::uses_velocity_gradient() const {
  return scheme.noise_viscosity > 0.0 ||
         (scheme.name == SchemeName::farzin2014 && scheme.divergence_free == DivergenceFree::midway);
}

template <int Dim>
FlowMeasures measure(const Flow<Dim>& flow) {
  FlowMeasures measures;
  const Particles<Dim>& particles = flow.particles;
  double error_sum = 0.0;
  double error_squares = 0.0;
  std::int64_t bulk_particles = 0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    measures.largest_speed = std::max(measures.largest_speed, particles.velocity[i].squaredNorm());
    measures.kinetic_energy += flow.kinetic_energy_of(i);
    measures.potential_energy += flow.potential_energy_of(i);
    if (i < flow.interior.size() && flow.is_inside(i)) {
      const double error = flow.concentration[i] - 1.0;
      error_sum += error;
      error_squares += error * error;
      measures.density_error_largest = std::max(measures.density_error_largest, std::abs(error));
      ++bulk_particles;
    }
  }
  flow.ranks.sum_each(measures.kinetic_energy, measures.potential_energy, error_sum, error_squares, bulk_particles);
  flow.ranks.largest_each(measures.largest_speed, measures.density_error_largest);
  measures.largest_speed = std::sqrt(measures.largest_speed);
  if (bulk_particles > 0) {
    const auto count = static_cast<double>(bulk_particles);
    measures.density_error_mean = error_sum / count;
    measures.density_error_rms = std::sqrt(error_squares / count);
  }
  for (const OpenEnd<Dim>& end : flow.open_ends) measures.departed += end.departed;
  return measures;
}

template struct Flow<2>;
template struct Flow<3>;
template FlowMeasures measure<2>(const Flow<2>&);
template FlowMeasures measure<3>(const Flow<3>&);

}  // namespace tailwater
