// The fluid's particles at the start.
#pragma once

#include <vector>

#include "base/box.h"
#include "base/vec.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "parallel/communicator.h"
#include "refinement/spacing_field.h"

namespace tailwater {

/// One rank's part of the water at the start. The parts of all ranks, one after the other, are all of it.
template <int Dim>
struct FluidParticles {
  std::vector<Vec<Dim>> position;
  std::vector<Vec<Dim>> velocity;
  std::vector<double> volume;           ///< m^Dim
  std::vector<int> block;               ///< index into CaseSpec::fluid
  std::vector<std::int64_t> id;         ///< empty without zones of refinement: the numbers from `first` on
  std::vector<std::int64_t> of_blocks;  ///< how many each block has on all ranks; their numbers follow each other
  std::int64_t first = 0;               ///< number of the first one, among those of all ranks
  /// How many all ranks have. With zones of refinement this, and `first`, count the cells of the case's lattice, which
  /// are divided there.
  std::int64_t all = 0;
  Communicator ranks;

  std::int64_t id_of(std::size_t n) const { return id.empty() ? first + static_cast<std::int64_t>(n) : id[n]; }
  /// The box around the particles of all ranks; empty if there are none. Collective.
  Box<Dim> box() const;
  /// Between the lowest and the highest of all of them along a unit vector, m. Collective.
  double extent_along(const Vec<Dim>& direction) const;
};

/// Ids of particles that come of a division are from here on: above those of all particles of an undivided case.
inline constexpr std::int64_t first_id_of_parts = std::int64_t{1} << 40;

/// The first of the ids that no particle of the start has, where the case's lattice has so many cells.
template <int Dim>
std::int64_t first_id_after_start(const SpacingField<Dim>& field, std::int64_t cells);

/// An expression may take longer than all the rest; what asks for places only leaves it out, with velocities of 0, and
/// gets the cells of the case's lattice undivided.
enum class StartVelocities { found, left_out };

/// The particles on the starting lattice (water_lattice.h). With dummy walls a particle is the centre of its cell. As
/// many cells become particles as the block, without what bodies and walls take, has volume, those that have most of
/// their volume in it (cut_cells.h), and the particles have this volume to round-off. Where nothing cuts a cell,
/// particles have the volumes of their cells. With a row of particles on the wall they stand at the cells' corners,
/// except in periodic directions, but not nearer than dx/2 to a wall, where a wall particle stands; of those on the
/// outline of a polygon every second one is taken, because half of their cells is inside. Particles nearer than dx/4 to
/// a wall to which their block adapts are moved to that distance, which keeps the volume. check_geometry reports
/// everything else that fits badly. Jitter, if any, is drawn from `particles.seed` and is the same on every machine.
///
/// In zones of refinement the cells are divided until their particles have about the volume that the field asks for.
///
/// Each rank makes only its part: as much as it gets when all particles and `others` that follow them are distributed
/// equally. Collective. Throws InputError, which names the block, for a block without extent or with coordinates of the
/// wrong dimension, for a fill as filled_cells does, and where a velocity is not finite or faster than 150 m/s.
template <int Dim>
FluidParticles<Dim> make_fluid_particles(const CaseSpec& spec, const Boundary<Dim>& boundary,
                                         const Communicator& ranks = {}, std::int64_t others = 0,
                                         StartVelocities velocities = StartVelocities::found);

}  // namespace tailwater
