#include "case/formulation.h"

namespace tailwater {

void apply_formulation(SchemeTable& scheme) {
  const bool is_explicit = scheme.integrator == Integrator::explicit_projection;
  if (scheme.formulation == Formulation::robust) {
    if (!is_explicit) scheme.courant = 0.5;
    return;
  }
  scheme.kernel = KernelName::farzin;
  scheme.laplacian = LaplacianKind::consistent;
  scheme.gradient = GradientKind::consistent;
  scheme.divergence = DivergenceKind::consistent;
  scheme.surface = SurfaceTreatment::cone;
  scheme.walls = WallTreatment::pressure_rows;
  scheme.divergence_free = DivergenceFree::start;
  scheme.displacement = Displacement::mean_velocity;
  scheme.courant = is_explicit ? 0.05 : 0.12;
  scheme.artificial_viscosity = 0.20;
  scheme.viscosity_floor = 0.0;
  scheme.noise_viscosity = 0.0;
  scheme.smagorinsky = 0.10;
  scheme.shifting = ShiftingKind::farzin;
  scheme.shifting_strength = is_explicit ? 0.10 : 0.08;
  scheme.shifting_cap = 0.05;
  scheme.density_relaxation = 0.0;
  scheme.implicit_form = ImplicitForm::repeated;
  scheme.max_passes = 30;
  scheme.relax_pressure = 0.4;
  scheme.relax_velocity = 0.3;
  scheme.relax_position = 0.4;
}

}  // namespace tailwater
