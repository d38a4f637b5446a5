// The walls and the water of a case at the start.
#pragma once

#include "motion/wall_motion.h"
#include "refinement/spacing_field.h"
#include "sampling/fluid_particles.h"
#include "walls/shared_rows.h"
#include "walls/walls.h"

namespace tailwater {

struct CaseSpec;
template <int Dim>
class WallModel;

/// The initial geometry of a case: the faces of all walls on every rank, and this rank's part of the rows of walls and
/// of the water.
template <int Dim>
struct Drawing {
  /// Throws InputError for an impossible geometry. Collective.
  Drawing(const CaseSpec& spec, const WallModel<Dim>& model, const Communicator& ranks);

  SpacingField<Dim> spacing_field;
  Walls<Dim> walls;
  SharedRows<Dim> shared_rows;
  WallMotion<Dim> wall_motion;
  FluidParticles<Dim> fluid;

 private:
  Drawing(const CaseSpec& spec, const WallModel<Dim>& model, const Communicator& ranks, Boundary<Dim> drawn);
};

/// Largest possible depth of the water [m]: the initial depth or that of open ends. Collective.
template <int Dim>
double largest_depth(const CaseSpec& spec, const FluidParticles<Dim>& fluid);

bool has_force_probe(const CaseSpec& spec);

}  // namespace tailwater
