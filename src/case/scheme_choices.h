// What a formulation is made of, choice by choice.
#pragma once

#include "case/spec.h"

namespace tailwater {

enum class KernelName { wendland_c2, cubic_spline, farzin };
enum class LaplacianKind { morris, consistent, shao_lo };
enum class GradientKind { conservative, consistent, density_weighted };
enum class DivergenceKind { standard, consistent };
enum class SourceKind { velocity_divergence, density, mixed };
enum class SurfaceTreatment { air, cone, density };
enum class WallTreatment { dummies, pressure_rows, row_and_dummies };
enum class ShiftingKind { none, lind, farzin };
enum class ImplicitForm { residual, repeated };

struct SchemeChoices {
  SchemeName name = SchemeName::farzin2014;
  Integrator integrator = Integrator::explicit_projection;
  double courant = 0.55;
  double noise_viscosity = 0.2;
  Turbulence turbulence = Turbulence::spalart_allmaras;
  PairVectors pair_vectors = PairVectors::corrected;

  KernelName kernel = KernelName::wendland_c2;
  LaplacianKind laplacian = LaplacianKind::morris;
  GradientKind gradient = GradientKind::conservative;
  DivergenceKind divergence = DivergenceKind::standard;
  SourceKind source = SourceKind::mixed;
  SurfaceTreatment surface = SurfaceTreatment::air;
  double surface_density = 0.99;
  WallTreatment walls = WallTreatment::dummies;
  DivergenceFree divergence_free = DivergenceFree::midway;
  Displacement displacement = Displacement::new_velocity;
  double artificial_viscosity = 0.0;
  double smagorinsky = 0.0;
  ShiftingKind shifting = ShiftingKind::lind;
  double shifting_strength = 3.0;
  double shifting_cap = 0.2;
  double density_relaxation = 0.05;
  double energy_slack = 1e-4;
  ImplicitForm implicit_form = ImplicitForm::residual;
  int max_passes = 3;
  double pass_tolerance = 1e-3;
  double relax_pressure = 1.0;
  double relax_velocity = 1.0;
  double relax_position = 1.0;
};

SchemeChoices choices_of(const CaseSpec& spec);

}  // namespace tailwater
