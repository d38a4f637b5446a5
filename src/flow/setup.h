// Data that do not change during a run, derived from the case for the steps.
#pragma once

#include <memory>
#include <vector>

#include "base/box.h"
#include "closures/liquid.h"
#include "closures/time_step.h"
#include "flow/formulation.h"
#include "kernel/kernel.h"
#include "operators/lattice.h"
#include "parallel/communicator.h"
#include "particles/liquids.h"
#include "walls/friction_law.h"

namespace tailwater {

struct CaseSpec;
template <int Dim>
struct Drawing;
template <int Dim>
class GradedSums;
template <int Dim>
class WallMotion;

/// The resolution of a flow where no zone of refinement is: the particle spacing, and what follows from it and the
/// kernel.
template <int Dim>
struct Scale {
  Scale(double dx, const Kernel<Dim>& of_formulation)
      : spacing(dx),
        kernel(of_formulation),
        lattice(lattice_sums(kernel, spacing)),
        kernel_values(kernel_values_of(kernel, spacing)) {}

  double spacing;  ///< m; dx of the case
  Kernel<Dim> kernel;
  LatticeSums lattice;
  KernelValues kernel_values;
};

template <int Dim>
struct Setup {
  /// Moves the motion of the walls out of `drawing`.
  Setup(const CaseSpec& spec, const FlowFormulation<Dim>& chosen, const Communicator& all_ranks, Drawing<Dim>& drawing);
  ~Setup();

  Communicator ranks;
  FlowFormulation<Dim> formulation;
  Liquid liquid;            ///< of several, that of the first block
  ParticleLiquids liquids;  ///< of the particles, if the case has several
  Scale<Dim> scale;
  std::shared_ptr<const GradedSums<Dim>> graded;  ///< null: all particles have the spacing of `scale`
  std::int64_t first_wall_id;                     ///< id of the wall particle with number 0
  Vec<Dim> gravity;                               ///< m/s^2
  double length;  ///< m; L of (F41): from the case, or the fluid's height along gravity at the start or at open ends
  PeriodicDomain<Dim> domain;
  bool is_closed;  ///< water fills a domain periodic in every direction: no surface, pressure up to a constant
  std::unique_ptr<WallMotion<Dim>> wall_motion;
  FrictionLaw friction_law;
  TimeStepRule time_step_rule;
  /// Whether a part solves for the viscous forces and the friction of walls (rheology/thick_liquid.h): the viscosities
  /// of `liquid` and `friction_law` are then 0.
  bool has_implicit_viscosity = false;

  /// Whether missing neighbours count as air, so that there is no tension near the surface.
  bool has_air() const { return formulation.surface_is_air && !is_closed; }
  /// m/s^2; gravity without the periodic directions, along which water falls without end.
  Vec<Dim> gravity_across() const {
    Vec<Dim> across = gravity;
    for (int d = 0; d < Dim; ++d) {
      if (domain[d]) across[d] = 0.0;
    }
    return across;
  }
  /// Local spacing of particles relative to that of the case.
  double relative_spacing(const Vec<Dim>& x) const;
  /// The least relative spacing.
  double finest_spacing() const;
  /// Weight of a particle of this volume [m^Dim] in statistics of the water: 1 if all particles have one spacing.
  double weight_in_statistics(double volume) const {
    return graded == nullptr ? 1.0 : volume / power<Dim>(scale.spacing);
  }
};

}  // namespace tailwater
