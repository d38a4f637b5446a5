#include "published/farzin2014.h"

#include "base/for_each.h"
#include "case/formulation.h"
#include "closures/viscosity.h"
#include "flow/stages.h"
#include "neighbours/halo.h"
#include "operators/pair_vectors.h"
#include "published/gradient_consistent.h"
#include "published/laplacian_consistent.h"
#include "published/pressure_rows.h"
#include "published/repeated_projection.h"
#include "published/rows.h"
#include "published/shifting.h"
#include "published/smagorinsky.h"
#include "published/surface_marks.h"
#include "published/viscosity.h"
#include "robust/loops.h"
#include "schemes/projection.h"
#include "schemes/start.h"

namespace tailwater {
namespace {

constexpr double artificial_viscosity = 0.20;  ///< c_a of (F3)
constexpr double stress = 0.10;                ///< c_s of (F4-F6)
/// eps of (F30) with the explicit scheme and the implicit one.
constexpr double explicit_shifting = 0.10;
constexpr double implicit_shifting = 0.08;
constexpr double farthest_shift = 0.05;  ///< dx; not from the paper

template <int Dim>
class FarzinDiscretisation final : public Discretisation<Dim> {
 public:
  FarzinDiscretisation(std::shared_ptr<Tensors<Dim>> tensors, const ShiftingLaw& shifting)
      : tensors_(std::move(tensors)), shifting_(shifting) {}

  void find_surface(Flow<Dim>& flow, SurfaceMarks marks) override {
    Surroundings<Dim>& surroundings = flow.surroundings;
    const Pairs<Dim>& pairs = flow.pairs();
    const Particles<Dim>& particles = flow.state.particles;
    tensors_->resize(particles.owned);
    compute_renormalisation<Dim>(pairs, particles.volume, surroundings.takes_part, *tensors_);  // (F10), (F13)
    if (marks == SurfaceMarks::found) {
      mark_by_cone<Dim>(
          {pairs, surroundings.concentration, surroundings.concentration_gradient, *tensors_, flow.setup.scale.spacing},
          particles, surroundings.is_surface);
      flow.halo().exchange(surroundings.is_surface);
      find_interior_by_marks<Dim>(pairs, particles, flow.setup.scale.spacing, surroundings.is_surface,
                                  surroundings.interior);
    }
  }

  /// Only for works and reactions: gradient and divergence are consistent.
  void find_pair_vectors(Flow<Dim>& flow) override {
    find_kernel_gradients(flow.pairs(), flow.surroundings.pair_vectors);
  }

  void add_viscous_force(const Flow<Dim>& flow, std::span<const Mat<Dim>>,
                         std::vector<Vec<Dim>>& acceleration) const override {  // (F2)
    const Particles<Dim>& particles = flow.state.particles;
    std::vector<double> viscosity(particles.size());
    effective_viscosity<Dim>(flow.setup.liquid.viscosity, particles.velocity, viscosity);  // (F3)
    add_consistent_viscosity<Dim>(flow.pairs(), particles, *tensors_, flow.surroundings.takes_part,
                                  flow.setup.scale.spacing, viscosity, particles.velocity, acceleration);
    std::vector<Mat<Dim>> tau(particles.size());  // (F4)-(F6)
    sub_particle_stress<Dim>(flow.pairs(), particles, stress, flow.setup.scale.spacing, particles.velocity, tau);
    flow.halo().exchange(tau);
    add_stress_divergence<Dim>(flow.pairs(), particles, tau, acceleration);
  }

  std::size_t write_rows(Flow<Dim>& flow) const override {  // (F23), (F34)
    const Pairs<Dim>& pairs = flow.pairs();
    const std::vector<double>& volume = flow.state.particles.volume;
    std::vector<std::uint8_t> fell_back(flow.state.particles.owned, 0);
    write_rows_of_marked_water(flow, [&](std::size_t i, LinearSystem::Row& row) {
      const Renormalisation<Dim>& tensors = (*tensors_)[i];
      if (tensors.laplacian_is_sound()) {
        const double sum = row.set_weights([&](std::size_t k) {
          return flow.surroundings.takes_part[pairs.j[k]]
                     ? consistent_laplacian_weight<Dim>(tensors, volume[pairs.j[k]], pairs.e(i, k), pairs.r(i, k),
                                                        pairs.value(i, k))
                     : 0.0;
        });
        if (sum > 0.0) return sum;
      }
      fell_back[i] = 1;
      return row.set_weights([&](std::size_t k) {
        return flow.surroundings.takes_part[pairs.j[k]]
                   ? fallback_laplacian_weight(tensors, volume[pairs.j[k]], pairs.r(i, k), pairs.value(i, k),
                                               flow.setup.scale.spacing)
                   : 0.0;
      });
    });
    return count_each(fell_back.size(), [&](std::size_t i) { return fell_back[i] != 0; });
  }

  PressureSource find_source(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity, std::span<const double> target,
                             double dt) const override {  // (F15), (F22)
    PressureSource source{std::vector<double>(flow.state.particles.owned, 0.0), {}};
    find_divergence(flow, velocity, source.rows);
    const double unit = flow.setup.liquid.density / dt;
    for_each(source.rows.size(), [&](std::size_t i) {
      if (flow.role[i] == Role::water) source.rows[i] = -unit * (source.rows[i] - target[i]);
    });
    return source;
  }

  void find_divergence(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity,
                       std::span<double> divergence) const override {
    for_each(flow.state.particles.owned, [&](std::size_t i) {
      if (flow.role[i] != Role::water) return;
      const Renormalisation<Dim>& tensors = (*tensors_)[i];
      divergence[i] = tensors.gradient_is_sound()
                          ? consistent_gradient<Dim>(flow.pairs(), i, tensors.B1, flow.state.particles.volume,
                                                     flow.surroundings.takes_part, velocity)
                                .trace()
                          : 0.0;
    });
  }

  void find_gradient(const Flow<Dim>& flow, const std::vector<double>& pressure,
                     std::span<Vec<Dim>> gradient) const override {  // (F9)
    for_each(flow.state.particles.owned, [&](std::size_t i) {
      if (flow.role[i] != Role::water) return;
      gradient[i].setZero();
      const Renormalisation<Dim>& tensors = (*tensors_)[i];
      if (!tensors.gradient_is_sound()) return;
      gradient[i] = consistent_gradient<Dim>(flow.pairs(), i, tensors.B1, flow.state.particles.volume,
                                             flow.surroundings.takes_part, std::span<const double>(pressure));
    });
  }

  /// The consistent gradient has no reactions; these are those of the conservative gradient.
  void wall_reactions(const Flow<Dim>& flow, std::span<const std::size_t> walls, const std::vector<double>& pressure,
                      std::span<Vec<Dim>> pushes) const override {
    find_conservative_pushes(flow, walls, pressure, pushes);
  }

  void reactions_seen_by_water(const Flow<Dim>& flow, std::span<const std::size_t> water, std::span<const double> share,
                               const std::vector<double>& pressure, std::span<Vec<Dim>> pushes) const override {
    find_conservative_pushes_on_walls(flow, water, share, pressure, pushes);
  }

  std::size_t find_shifts(Flow<Dim>& flow, double dt, std::vector<Vec<Dim>>& shifts) const override {
    Particles<Dim>& particles = flow.state.particles;
    const std::size_t capped =
        find_published_shifts<Dim>(shifting_, dt, flow.pairs(), particles, flow.surroundings, shifts);
    for_each(particles.owned, [&](std::size_t i) {
      if (is_claimed(flow.role[i])) shifts[i].setZero();
    });
    set_wall_velocities<Dim>(flow, flow.state.wall_velocity, particles.velocity);
    carry_fields_along<Dim>(flow.pairs(), *tensors_, flow.surroundings, shifts, particles);
    return capped;
  }

 private:
  std::shared_ptr<Tensors<Dim>> tensors_;  ///< of owned particles, at the present positions; pressure rows read them
  ShiftingLaw shifting_;
};

}  // namespace

template <int Dim>
FlowFormulation<Dim> published_farzin(const CaseSpec& spec) {
  const bool is_explicit = spec.scheme.integrator == Integrator::explicit_projection;
  const auto tensors = std::make_shared<Tensors<Dim>>();
  FlowFormulation<Dim> formulation;
  const double dx = spec.particles.spacing;
  const ShiftingLaw shifting{
      .strength = is_explicit ? explicit_shifting : implicit_shifting, .cap = farthest_shift * dx, .spacing = dx};
  formulation.discretisation = std::make_shared<FarzinDiscretisation<Dim>>(tensors, shifting);
  formulation.walls = make_pressure_rows<Dim>(tensors);
  formulation.kernel = make_kernel<Dim>(KernelName::farzin, traits_of(spec).support * dx);  // (F8)
  formulation.take_step = is_explicit ? explicit_projection_step<Dim> : repeated_projection_step<Dim>;
  formulation.find_first_pressure = project_at_start<Dim>;
  formulation.needs_concentration_gradient = true;
  formulation.moves_with_mean_velocity = true;  // (F17), (F25)
  formulation.friction_is_viscous = true;
  formulation.shifts_particles = true;
  formulation.courant = spec.scheme.courant;
  formulation.artificial_viscosity = artificial_viscosity;
  formulation.energy_slack = spec.study.energy_slack;
  return formulation;
}

TAILWATER_IN_2D_AND_3D(published_farzin);

}  // namespace tailwater
