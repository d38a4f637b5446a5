#include "case/scheme_choices.h"

namespace tailwater {
namespace {

void set_published_farzin(SchemeChoices& scheme) {
  const bool is_explicit = scheme.integrator == Integrator::explicit_projection;
  scheme.kernel = KernelName::farzin;
  scheme.laplacian = LaplacianKind::consistent;
  scheme.gradient = GradientKind::consistent;
  scheme.divergence = DivergenceKind::consistent;
  scheme.pair_vectors = PairVectors::kernel;
  scheme.source = SourceKind::velocity_divergence;
  scheme.surface = SurfaceTreatment::cone;
  scheme.walls = WallTreatment::pressure_rows;
  scheme.divergence_free = DivergenceFree::start;
  scheme.displacement = Displacement::mean_velocity;
  scheme.artificial_viscosity = 0.20;
  scheme.noise_viscosity = 0.0;
  scheme.smagorinsky = 0.10;
  scheme.turbulence = Turbulence::none;
  scheme.shifting = ShiftingKind::farzin;
  scheme.shifting_strength = is_explicit ? 0.10 : 0.08;
  scheme.shifting_cap = 0.05;
  scheme.implicit_form = ImplicitForm::repeated;
  scheme.max_passes = 30;
  scheme.relax_pressure = 0.4;
  scheme.relax_velocity = 0.3;
  scheme.relax_position = 0.4;
}

void set_published_farmani(SchemeChoices& scheme) {
  scheme.kernel = KernelName::cubic_spline;
  scheme.laplacian = LaplacianKind::shao_lo;
  scheme.gradient = GradientKind::density_weighted;
  scheme.pair_vectors = PairVectors::kernel;
  scheme.source = SourceKind::density;
  scheme.surface = SurfaceTreatment::density;
  scheme.walls = WallTreatment::row_and_dummies;
  scheme.displacement = Displacement::mean_velocity;
  scheme.noise_viscosity = 0.0;
  scheme.turbulence = Turbulence::none;
  scheme.shifting = ShiftingKind::none;
}

void set_robust(SchemeChoices& scheme, const StudyTable& study) {
  scheme.divergence_free = study.divergence_free;
  scheme.displacement = scheme.name == SchemeName::farmani2020 ? Displacement::mean_velocity : study.displacement;
  scheme.artificial_viscosity = study.artificial_viscosity;
  scheme.shifting = study.shifting > 0.0 ? ShiftingKind::lind : ShiftingKind::none;
  scheme.shifting_strength = study.shifting;
  scheme.density_relaxation = study.density_relaxation;
  scheme.energy_slack = study.energy_slack;
}

}  // namespace

SchemeChoices choices_of(const CaseSpec& spec) {
  const SchemeTable& table = spec.scheme;
  SchemeChoices scheme{.name = table.name,
                       .integrator = table.integrator,
                       .courant = table.courant,
                       .noise_viscosity = table.noise_viscosity,
                       .turbulence = table.turbulence,
                       .pair_vectors = table.pair_vectors};
  if (table.formulation == Formulation::robust) {
    set_robust(scheme, spec.study);
  } else if (table.name == SchemeName::farzin2014) {
    set_published_farzin(scheme);
  } else {
    set_published_farmani(scheme);
  }
  return scheme;
}

}  // namespace tailwater
