#include "robust/formulation.h"

#include "case/formulation.h"
#include "operators/pressure_ramp.h"
#include "robust/discretisation.h"
#include "schemes/projection.h"
#include "schemes/start.h"
#include "schemes/two_step.h"
#include "walls/dummies.h"

namespace tailwater {
namespace {

constexpr double shifting_cap = 0.2;  // dx

/// The settings common to both step orders.
template <int Dim>
FlowFormulation<Dim> robust(const CaseSpec& spec) {
  const StudyTable& study = spec.study;
  const double dx = spec.particles.spacing;
  FlowFormulation<Dim> formulation;
  formulation.kernel = make_kernel<Dim>(KernelName::wendland_c2, traits_of(spec).support * dx);
  formulation.discretisation = std::make_shared<RobustDiscretisation<Dim>>(
      RobustLaws{.pair_vectors = spec.scheme.pair_vectors,
                 .air = AirLaw(formulation.kernel, dx),
                 .shifting = {.strength = study.shifting, .cap = shifting_cap * dx, .spacing = dx},
                 .density_relaxation = study.density_relaxation});
  formulation.walls = make_dummies<Dim>();
  formulation.needs_velocity_gradient = true;
  formulation.needs_concentration_gradient = spec.scheme.pair_vectors == PairVectors::kernel;
  formulation.surface_is_air = true;
  formulation.shifts_particles = study.shifting > 0.0;
  formulation.courant = spec.scheme.courant;
  formulation.length = study.length;
  formulation.artificial_viscosity = study.artificial_viscosity;
  formulation.noise_viscosity = spec.study.noise_viscosity;
  formulation.has_eddy_viscosity = spec.scheme.turbulence == Turbulence::spalart_allmaras;
  formulation.energy_slack = study.energy_slack;
  return formulation;
}

}  // namespace

template <int Dim>
FlowFormulation<Dim> robust_farzin(const CaseSpec& spec) {
  const bool is_implicit = spec.scheme.integrator == Integrator::implicit_projection;
  FlowFormulation<Dim> formulation = robust<Dim>(spec);
  formulation.take_step = is_implicit ? two_projections_step<Dim> : explicit_projection_step<Dim>;
  formulation.find_first_pressure = project_at_start<Dim>;
  formulation.is_divergence_free_midway = spec.study.divergence_free == DivergenceFree::midway;
  formulation.moves_with_mean_velocity = spec.study.displacement == Displacement::mean_velocity;
  formulation.has_second_projection = is_implicit;
  formulation.balanced_ramp = std::make_shared<const PressureRamp>(formulation.kernel, spec.particles.spacing);
  return formulation;
}

template <int Dim>
FlowFormulation<Dim> robust_farmani(const CaseSpec& spec) {
  FlowFormulation<Dim> formulation = robust<Dim>(spec);
  formulation.take_step = two_step<Dim>;
  formulation.find_first_pressure = predict_pressure_at_start<Dim>;
  formulation.moves_with_mean_velocity = true;  // (B19)
  formulation.viscous_share = 0.1;              // (B20)
  return formulation;
}

TAILWATER_IN_2D_AND_3D(robust_farzin);
TAILWATER_IN_2D_AND_3D(robust_farmani);

}  // namespace tailwater
