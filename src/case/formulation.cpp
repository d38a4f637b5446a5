#include "case/formulation.h"

namespace tailwater {
namespace {

void set_published_farzin(SchemeTable& scheme) {
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
  scheme.courant = is_explicit ? 0.05 : 0.12;
  scheme.artificial_viscosity = 0.20;
  scheme.viscosity_floor = 0.0;
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

void set_robust_farmani(SchemeTable& scheme) {
  scheme.displacement = Displacement::mean_velocity;
  scheme.courant = 0.25;  // its loss of energy grows with the step
}

void set_published_farmani(SchemeTable& scheme) {
  scheme.kernel = KernelName::cubic_spline;
  scheme.support = 2.4;
  scheme.laplacian = LaplacianKind::shao_lo;
  scheme.gradient = GradientKind::density_weighted;
  scheme.pair_vectors = PairVectors::kernel;
  scheme.source = SourceKind::density;
  scheme.surface = SurfaceTreatment::density;
  scheme.walls = WallTreatment::row_and_dummies;
  scheme.displacement = Displacement::mean_velocity;
  scheme.courant = 0.1;
  scheme.noise_viscosity = 0.0;
  scheme.turbulence = Turbulence::none;
  scheme.shifting = ShiftingKind::none;
}

}  // namespace

void apply_formulation(SchemeTable& scheme) {
  const bool is_robust = scheme.formulation == Formulation::robust;
  switch (scheme.name) {
    case SchemeName::farzin2014:
      if (!is_robust) set_published_farzin(scheme);
      return;
    case SchemeName::farmani2020:
      return is_robust ? set_robust_farmani(scheme) : set_published_farmani(scheme);
  }
}

}  // namespace tailwater
