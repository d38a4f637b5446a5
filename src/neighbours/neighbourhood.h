// Keeps neighbour rows, ghosts and cell grid valid for the particles' present positions, at least cost: lists reach a
// skin beyond the support and are made anew only when some particle has moved half of it.
#pragma once

#include <vector>

#include "neighbours/cell_grid.h"
#include "neighbours/halo.h"
#include "neighbours/pairs.h"
#include "particles/particles.h"

namespace tailwater {

/// Which rows wall particles get: none of the wall-wall pairs (dummies look only at fluid), or all.
enum class WallRows { fluid_only, all };

template <int Dim>
class Neighbourhood {
 public:
  /// `radius` [m] is the kernel's support, `skin` [m] what lists reach beyond it.
  Neighbourhood(Kernel<Dim> kernel, double spacing, double skin, WallRows wall_rows, PeriodicDomain<Dim> domain,
                Communicator ranks = {});

  /// Brings everything up to date with particles.position. Collective. Returns true when the lists (and so the number
  /// of ghosts) are new; pairs() and their order may change at every call.
  bool update(Particles<Dim>& particles);

  /// Moves particles that left a periodic domain back in at its other end. Call between steps only.
  void wrap(Particles<Dim>& particles) const { wrap_positions<Dim>(domain_, particles); }

  /// The place inside a periodic domain that `position` stands for.
  Vec<Dim> wrapped(const Vec<Dim>& position) const { return tailwater::wrapped<Dim>(domain_, position); }

  /// Sorts the owned particles by slabs across the fluid's longest extent, wrapped, and forgets lists and ghosts: near
  /// in space is near in memory, and an incomplete factorisation in this order needs the fewest iterations. Call
  /// between steps only: indices change.
  void reorder(Particles<Dim>& particles);

  /// Forgets lists and ghosts: the next `update` makes them anew, as if there never were any.
  void forget(Particles<Dim>& particles);

  /// Leaves only these owned particles, in this order, and forgets lists and ghosts. Call between steps only: indices
  /// change.
  void keep(Particles<Dim>& particles, std::span<const std::int32_t> kept);

  /// What a step costs for each owned particle, in pairs, while indices are those of the present lists; else 1 for
  /// each.
  std::vector<double> work(const Particles<Dim>& particles) const;

  const Pairs<Dim>& pairs() const { return pairs_; }
  const Halo<Dim>& halo() const { return halo_; }
  /// All particles, ghosts included, as they were when the lists were made: search up to half a skin farther.
  const CellGrid<Dim>& grid() const { return grid_; }
  const Kernel<Dim>& kernel() const { return kernel_; }
  std::size_t rebuilds() const { return rebuilds_; }

 private:
  bool lists_are_valid(const Particles<Dim>& particles) const;
  void rebuild(Particles<Dim>& particles);

  Kernel<Dim> kernel_;
  double spacing_;
  double skin_;
  WallRows wall_rows_;
  PeriodicDomain<Dim> domain_;
  Communicator ranks_;
  CellGrid<Dim> grid_;
  Halo<Dim> halo_;
  NeighbourList list_;
  Pairs<Dim> pairs_;
  bool has_lists_ = false;
  std::vector<Vec<Dim>> position_at_rebuild_;
  std::size_t rebuilds_ = 0;
};

}  // namespace tailwater
