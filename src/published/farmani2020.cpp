#include "published/farmani2020.h"

#include "base/for_each.h"
#include "case/formulation.h"
#include "closures/fluid_pairs.h"
#include "closures/viscosity.h"
#include "neighbours/halo.h"
#include "operators/pair_vectors.h"
#include "published/gradient_density_weighted.h"
#include "published/laplacian_shao_lo.h"
#include "published/row_and_dummies.h"
#include "published/rows.h"
#include "published/surface_marks.h"
#include "published/viscosity.h"
#include "robust/loops.h"
#include "schemes/start.h"
#include "schemes/two_step.h"

namespace tailwater {
namespace {

/// Upper bound of counted speeds, in units of sqrt(2 g L). With this source only spray is faster; counting it would
/// shorten the steps for ever (closures/time_step.h).
constexpr double fastest_counted_over_reference = 2.0;

template <int Dim>
class FarmaniDiscretisation final : public Discretisation<Dim> {
 public:
  explicit FarmaniDiscretisation(double eta_squared) : eta_squared_(eta_squared) {}

  void find_surface(Flow<Dim>& flow, SurfaceMarks marks) override {  // (B21)
    Surroundings<Dim>& surroundings = flow.surroundings;
    const Particles<Dim>& particles = flow.state.particles;
    if (marks == SurfaceMarks::found) {
      mark_by_density<Dim>(flow.pairs(), particles, surroundings.concentration, surroundings.is_surface);
      flow.halo().exchange(surroundings.is_surface);
      find_interior_by_marks<Dim>(flow.pairs(), particles, flow.setup.scale.spacing, surroundings.is_surface,
                                  surroundings.interior);
    }
  }

  /// Only for works and the report of the divergence.
  void find_pair_vectors(Flow<Dim>& flow) override {
    find_kernel_gradients(flow.pairs(), flow.surroundings.pair_vectors);
  }

  void add_viscous_force(const Flow<Dim>& flow, std::span<const Mat<Dim>>,
                         std::vector<Vec<Dim>>& acceleration) const override {  // (B9)
    const Particles<Dim>& particles = flow.state.particles;
    std::vector<double> viscosity(particles.size());
    effective_viscosity<Dim>(flow.setup.liquid.viscosity, particles.velocity, viscosity);
    add_shao_lo_viscosity<Dim>(flow.pairs(), particles, eta_squared_, flow.surroundings.concentration, viscosity,
                               particles.velocity, acceleration);
  }

  std::size_t write_rows(Flow<Dim>& flow) const override {  // (B8)
    const Pairs<Dim>& pairs = flow.pairs();
    const std::vector<double>& volume = flow.state.particles.volume;
    const std::vector<double>& density = flow.surroundings.concentration;
    write_rows_of_marked_water(flow, [&](std::size_t i, LinearSystem::Row& row) {
      return row.set_weights([&](std::size_t k) {
        const auto j = pairs.j[k];
        return flow.surroundings.takes_part[j]
                   ? shao_lo_laplacian_weight(volume[j], density[i], density[j], pairs.r(i, k), pairs.slope(i, k),
                                              eta_squared_)
                   : 0.0;
      });
    });
    return 0;
  }

  PressureSource find_source(const Flow<Dim>& flow, std::span<const Vec<Dim>>, std::span<const double>,
                             double dt) const override {  // (B17)
    PressureSource source{std::vector<double>(flow.state.particles.owned, 0.0), {}};
    const double unit = flow.setup.liquid.density / (dt * dt);
    for_each(source.rows.size(),
             [&](std::size_t i) { source.rows[i] = unit * (flow.surroundings.concentration[i] - 1.0); });
    return source;
  }

  void find_divergence(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity,
                       std::span<double> divergence) const override {
    find_standard_divergence(flow, velocity, divergence);
  }

  void find_gradient(const Flow<Dim>& flow, const std::vector<double>& pressure,
                     std::span<Vec<Dim>> gradient) const override {  // (B7)
    const std::vector<double>& volume = flow.state.particles.volume;
    for_each(flow.state.particles.owned, [&](std::size_t i) {
      if (flow.role[i] != Role::water) return;
      gradient[i] = density_weighted_gradient<Dim>(flow.pairs(), i, volume, flow.surroundings.concentration, pressure);
    });
  }

  void wall_reactions(const Flow<Dim>& flow, std::span<const std::size_t> walls, const std::vector<double>& pressure,
                      std::span<Vec<Dim>> pushes) const override {
    const Pairs<Dim>& pairs = flow.pairs();
    const Particles<Dim>& particles = flow.state.particles;
    for_each(walls.size(), [&](std::size_t n) {
      const std::size_t i = walls[n];
      pushes[n] = sum_over_fluid<Dim>(pairs, particles, i, [&](std::size_t, std::size_t k) {
        return Vec<Dim>(
            density_weighted_slope<Dim>(pairs, i, k, particles.volume, flow.surroundings.concentration, pressure) *
            pairs.e(i, k));
      });
    });
  }

  void reactions_seen_by_water(const Flow<Dim>& flow, std::span<const std::size_t> water, std::span<const double> share,
                               const std::vector<double>& pressure, std::span<Vec<Dim>> pushes) const override {
    const Pairs<Dim>& pairs = flow.pairs();
    for_each(water.size(), [&](std::size_t n) {
      const std::size_t i = water[n];
      pushes[n].setZero();
      for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
        if (share[pairs.j[k]] == 0.0) continue;
        pushes[n] += share[pairs.j[k]] *
                     density_weighted_slope<Dim>(pairs, i, k, flow.state.particles.volume,
                                                 flow.surroundings.concentration, pressure) *
                     pairs.e(i, k);
      }
    });
  }

  std::size_t find_shifts(Flow<Dim>&, double, std::vector<Vec<Dim>>&) const override { return 0; }

 private:
  double eta_squared_;  ///< m^2; eta^2 of (B8)
};

}  // namespace

template <int Dim>
FlowFormulation<Dim> published_farmani(const CaseSpec& spec) {
  FlowFormulation<Dim> formulation;
  formulation.kernel =
      make_kernel<Dim>(KernelName::cubic_spline, traits_of(spec).support * spec.particles.spacing);  // (B5)
  formulation.discretisation =
      std::make_shared<FarmaniDiscretisation<Dim>>(shao_lo_eta_squared(kernel_radius(formulation.kernel)));
  formulation.walls = make_row_and_dummies<Dim>();
  formulation.take_step = two_step<Dim>;
  formulation.find_first_pressure = predict_pressure_at_start<Dim>;
  formulation.moves_with_mean_velocity = true;  // (B19)
  formulation.gravity_in_prediction = true;     // (B11)
  formulation.courant = spec.scheme.courant;
  formulation.viscous_share = 0.1;  // (B20)
  formulation.fastest_over_reference = fastest_counted_over_reference;
  formulation.energy_slack = spec.study.energy_slack;
  return formulation;
}

TAILWATER_IN_2D_AND_3D(published_farmani);

}  // namespace tailwater
