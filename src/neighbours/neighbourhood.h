// Keeps neighbour rows, ghosts and cell grid valid for the particles' present positions. Ghosts extend a skin beyond
// the support and are selected again only when some particle has moved half a skin.
#pragma once

#include <vector>

#include "geometry/images.h"
#include "neighbours/cell_grid.h"
#include "neighbours/halo.h"
#include "neighbours/pairs.h"
#include "particles/particles.h"
#include "refinement/spacing_field.h"

namespace tailwater {

/// How particles follow each other in memory: by the cells of a grid, in slabs across the direction of largest spread
/// and row by row in a slab, or along a Z curve (base/z_curve.h) through cells of dx.
enum class ParticleOrder { slabs, z_curve };

template <int Dim>
class Neighbourhood {
 public:
  /// `skin` [m] is how far ghosts reach beyond the kernel's support.
  /// `kernel` and `spacing` are those of the case, where `field` is 1.
  Neighbourhood(Kernel<Dim> kernel, double spacing, double skin, WallRows wall_rows, PeriodicDomain<Dim> domain,
                Communicator ranks = {}, SpacingField<Dim> field = {});

  /// Brings everything up to date with particles.position. Collective. Returns whether the ghosts, and their number,
  /// are new. pairs() and their order may change at every call.
  bool update(Particles<Dim>& particles);

  /// Weighs the pairs of the last update (weigh_pairs in pairs.h).
  template <class MayChange, class Weigh>
  void weigh_pairs(MayChange&& may_change, Weigh&& weigh) {
    tailwater::weigh_pairs(pairs_, may_change, weigh);
  }

  /// Moves particles that left a periodic domain in again at its other end. Call between steps only.
  void wrap(Particles<Dim>& particles) const { wrap_positions<Dim>(domain_, particles); }

  /// The equivalent of `position` inside a periodic domain.
  Vec<Dim> wrapped(const Vec<Dim>& position) const { return tailwater::wrapped<Dim>(domain_, position); }

  /// Wraps the owned particles, sorts them, so that particles near in space are near in memory, and discards pairs and
  /// ghosts. Call between steps only: indices change.
  void reorder(Particles<Dim>& particles, ParticleOrder order);

  /// Discards pairs and ghosts; the next `update` computes them as if for the first time.
  void forget(Particles<Dim>& particles);

  /// Keeps only these owned particles, in this order, and discards pairs and ghosts. Call between steps only: indices
  /// change.
  void keep(Particles<Dim>& particles, std::span<const std::int32_t> kept);

  /// Cost of a step for each owned particle, in pairs; 1 for each if the pairs are not of the present indices.
  std::vector<double> work(const Particles<Dim>& particles) const;

  /// Whether pairs and ghosts are of the present indices.
  bool has_pairs() const { return has_pairs_; }

  const Pairs<Dim>& pairs() const { return pairs_; }
  const Halo<Dim>& halo() const { return halo_; }
  /// All particles, ghosts included, as they were when the pairs were found.
  const CellGrid<Dim>& grid() const { return grid_; }
  const Kernel<Dim>& kernel() const { return kernel_; }
  /// Number of times that ghosts were selected again.
  std::size_t renewals() const { return renewals_; }

 private:
  void find_relative_spacing(const Particles<Dim>& particles);
  bool ghosts_are_valid(const Particles<Dim>& particles) const;
  void renew_ghosts(Particles<Dim>& particles);

  Kernel<Dim> kernel_;
  double spacing_;
  double skin_;
  WallRows wall_rows_;
  PeriodicDomain<Dim> domain_;
  Communicator ranks_;
  SpacingField<Dim> field_;
  bool has_ghosts_;  ///< whether there can be any
  CellGrid<Dim> grid_;
  Halo<Dim> halo_;
  Pairs<Dim> pairs_;
  bool has_pairs_ = false;
  std::vector<Vec<Dim>> position_at_renewal_;  ///< of owned particles, if there are ghosts
  std::size_t renewals_ = 0;
};

}  // namespace tailwater
