// A flow, grouped by lifetime: the setup, which does not change; the state, which a checkpoint saves; tools, which keep
// memory between steps and can be rebuilt; and data of the present positions. Work fields of one step are values that
// its stages pass to each other (stages.h).
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "base/box.h"
#include "closures/surroundings.h"
#include "flow/part.h"
#include "flow/role.h"
#include "flow/setup.h"
#include "flow/state.h"
#include "walls/walls.h"

namespace tailwater {

template <int Dim>
struct Distribution;
template <int Dim>
struct Halo;
template <int Dim>
class Neighbourhood;
template <int Dim>
class Pores;
struct PressureEquation;
template <int Dim>
struct SavedFlow;

template <int Dim>
struct Flow {
  /// Builds the particles, walls and parts of a case (published/make_flow.h). Each rank keeps its fraction of the
  /// particles and of the rows of walls; all ranks have the faces of all walls. Collective. Throws InputError for an
  /// impossible geometry.
  Flow(const CaseSpec& spec, const FlowFormulation<Dim>& formulation, std::span<const PartMaker<Dim>> makers,
       const Communicator& ranks);

  Setup<Dim> setup;
  State<Dim> state;
  std::vector<std::unique_ptr<Part<Dim>>> parts;  ///< the parts of the case, in the order of their calls
  const Pores<Dim>* pores = nullptr;              ///< belongs to one of the parts; null: water can fill all of space

  // Tools.
  std::unique_ptr<Distribution<Dim>> distribution;    ///< of particles and rows of walls over the ranks
  std::unique_ptr<Neighbourhood<Dim>> neighbourhood;  ///< rows of neighbours and ghosts
  std::unique_ptr<PressureEquation> equation;         ///< of the pressure: rows and solver

  // Data of the present positions.
  Walls<Dim> walls;                ///< at their present positions
  Surroundings<Dim> surroundings;  ///< as computed by `locate`
  std::vector<Role> role;          ///< of owned particles in this step

  /// Builds a case whose walls and water have already been made.
  Flow(const CaseSpec& spec, const FlowFormulation<Dim>& formulation, std::span<const PartMaker<Dim>> makers,
       const Communicator& ranks, Drawing<Dim> drawing);
  ~Flow();

  /// The part of type P; an empty one if the case has none.
  template <class P>
  const P& part() const {
    for (const auto& any : parts) {
      if (const auto* const found = dynamic_cast<const P*>(any.get())) return *found;
    }
    static const P none;
    return none;
  }
  template <class P>
  P& part() {
    return const_cast<P&>(std::as_const(*this).template part<P>());
  }
  /// Whether water can leave or enter the domain.
  bool is_open() const {
    return std::ranges::any_of(parts, [](const auto& part) { return part->is_open(); });
  }
  /// Whether the matrix of a second projection serves the next step's first one too.
  bool keeps_matrix() const {
    return setup.formulation.has_second_projection &&
           std::ranges::none_of(parts, [](const auto& part) { return part->changes_rows(); });
  }

  /// Saves the state and that of the parts for `restore`. Reuses the memory of `saved`.
  void save(SavedFlow<Dim>& saved) const;
  /// Continues from a saved flow of the same case. Returns false if its parts belong to another case. Collective.
  bool restore(SavedFlow<Dim> saved);

  const Pairs<Dim>& pairs() const;
  const Halo<Dim>& halo() const;  ///< neighbours/halo.h
  Discretisation<Dim>& discretisation() const { return *setup.formulation.discretisation; }
  const WallModel<Dim>& wall_model() const { return *setup.formulation.walls; }
  WallScene<Dim> wall_scene() const { return {pairs(), state.particles, walls, surroundings}; }

  WallForce<Dim> wall_force(std::span<const Vec<Dim>> acceleration) const {
    return {setup.liquid.density, setup.gravity, acceleration, walls.turn_acceleration};
  }

  /// kg/m^3; of fluid particle i.
  double density_of(std::size_t i) const {
    const ParticleLiquids& liquids = setup.liquids;
    return liquids.are_several() ? liquids.density[liquids.of(state.particles.id[i])] : setup.liquid.density;
  }
  /// Whether statistics of the bulk include particle i.
  bool is_inside(std::size_t i) const { return role[i] == Role::water && surroundings.interior[i] > 0.5; }
  /// m^Dim; volume of water of particle i: its volume, except where grains take part of it.
  double water_volume_of(std::size_t i) const {
    const double volume = state.particles.volume[i];
    return pores == nullptr ? volume : volume * filled_fraction_at(i);
  }
  /// m/s; of all particles: discharge over area, which equals the velocity where water can fill all of space.
  std::vector<Vec<Dim>> filter_velocity() const;
  /// Sums over a full lattice of particles like particle i.
  LatticeSums lattice_of(std::size_t i) const;
  double kinetic_energy_of(std::size_t i) const {
    const double energy = 0.5 * density_of(i) * state.particles.volume[i] * state.particles.velocity[i].squaredNorm();
    return pores == nullptr ? energy : inertia_fraction_at(i) * energy;
  }
  /// The box around all walls at their present positions and the edges of the case that parts define; empty if there is
  /// nothing.
  Box<Dim> box() const;
  /// J; relative to the origin; periodic directions do not contribute.
  double potential_energy_of(std::size_t i) const {
    return -density_of(i) * water_volume_of(i) * setup.gravity_across().dot(state.particles.position[i]);
  }

 private:
  /// Fraction of the space at particle i that water can fill, where there are pores.
  double filled_fraction_at(std::size_t i) const;
  /// The filled fraction times the mass that accelerates with the water over the mass of the water.
  double inertia_fraction_at(std::size_t i) const;
};

}  // namespace tailwater
