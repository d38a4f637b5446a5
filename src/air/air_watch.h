// Searches for pockets of air every few steps, and computes the air beside each particle.
#pragma once

#include <Eigen/Core>

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "air/pocket_exchange.h"
#include "air/pocket_space.h"
#include "base/box.h"
#include "case/spec.h"
#include "geometry/opening.h"
#include "geometry/wall_patches.h"
#include "motion/affine_map.h"
#include "motion/floating_body.h"
#include "walls/wall_model.h"

namespace tailwater {

/// Owned water beside pockets.
template <int Dim>
struct PocketSide {
  std::size_t particle;
  std::vector<PocketShare> shares;
  bool is_beside = true;  ///< whether a pocket is near; else only the pressure of its sealed space acts on it
  double weight = 0.0;    ///< completes its row of the pressure equation, in the row's unit
  Vec<Dim> push = Vec<Dim>::Zero();  ///< 1/m; force per volume by air at 1 Pa all around
};

/// A piece of a moving wall beside pockets, or beside water that is beside pockets.
template <int Dim>
struct PocketWall {
  int wall;       ///< index into Boundary::walls
  Vec<Dim> x;     ///< m
  Vec<Dim> area;  ///< m^(Dim-1); towards the wall
  std::vector<PocketShare> shares;
  Turn<Dim> couple = Turn<Dim>::Zero();  ///< m^Dim; moment of 1 Pa in addition to that of `area` at x
};

/// The forces of 1 Pa in a pocket through the pairs of water and a moving wall, in which the pressure is relative to
/// that of the air.
template <int Dim>
struct PocketPairs {
  int wall;         ///< index into Boundary::walls
  int pocket;       ///< index
  Vec<Dim> force;   ///< m^(Dim-1); on the wall
  Mat<Dim> moment;  ///< m^Dim; the sum of force x^T over the wall's particles

  /// m^Dim/s; growth of the pocket by a wall with this velocity: the power of the force on it.
  double growth(const AffineMap<Dim>& velocity) const {
    return force.dot(velocity.constant) + moment.cwiseProduct(velocity.linear).sum();
  }
};

/// The response of the water to 1 Pa in a pocket, one entry per particle.
template <int Dim>
struct AirResponse {
  std::vector<double> pressure;  ///< up to date on walls and ghosts
  std::vector<Vec<Dim>> force;   ///< 1/m; on water, per volume; 0 on all other particles
};

/// The pockets in one step: the water and walls beside them, and their effect.
template <int Dim>
struct PocketStep {
  std::vector<PocketSide<Dim>> water;
  std::vector<PocketWall<Dim>> walls;                              ///< the same on all ranks
  std::vector<PocketPairs<Dim>> wall_pair_forces;                  ///< the same on all ranks
  std::vector<std::pair<std::size_t, PocketShare>> air_fractions;  ///< of owned particles, walls too; if walls move
  /// m^Dim/s per Pa; growth of each pocket (row) through water by the pressure of each
  Eigen::MatrixXd answers;
  /// m^Dim/s per Pa; growth through floating bodies, by own pressure; empty without bodies
  std::vector<double> mobility;
  std::vector<double> pressure;         ///< Pa; pressure of each pocket in this step, above the atmosphere's
  std::vector<double> flow;             ///< m^Dim/s; growth of each by the predicted velocity
  std::vector<double> flow_before;      ///< m^Dim/s; growth of each by the velocity at the start of the step
  std::vector<double> inflow;           ///< m^Dim/s; growth of each by the water of open ends
  std::vector<double> inflow_of_pairs;  ///< m^Dim/s; the part of inflow by pairs of that water and other water
  /// m^Dim/s; growth of each by the velocity of a tank that moves as a whole, for water and walls. The surface of a
  /// pocket is closed only up to an error of the order of dx, and this growth is that error. Empty without such a tank.
  std::vector<double> unclosed;
  /// Pa, of owned particles: absolute difference between the pressure that the air alone makes there and that of the
  /// air beside them, at the start of the step.
  std::vector<double> response_deficit;
  int iterations = 0;  ///< of the solves for the responses
  double work = 0.0;   ///< J; work of the gas

  /// Pa; pressure of the air beside water.
  double pressure_at(const PocketSide<Dim>& side) const {
    double sum = 0.0;
    for (const PocketShare& share : side.shares) sum += share.share * pressure[share.pocket];
    return sum;
  }
};

/// An inlet or outlet.
template <int Dim>
struct AirEnd {
  Opening<Dim> opening;
  Vec<Dim> inside;     ///< m; a place just inside
  bool feeds = false;  ///< whether the case prescribes how much water passes
};

template <int Dim>
class AirWatch {
 public:
  /// For a case without enclosed air.
  AirWatch() = default;
  /// `box` contains all walls during the whole run.
  AirWatch(const CaseSpec& spec, std::span<const Duct<Dim>> ducts, const Box<Dim>& box,
           const PeriodicDomain<Dim>& domain);

  bool is_on() const { return grid_ != nullptr; }
  /// The cells in which air is searched for; not to be called if !is_on().
  const VoidGrid<Dim>& grid() const { return *grid_; }
  const GasLaw& law() const { return law_; }

  /// Whether water may have gone so far since the last search that a new one is needed.
  bool is_due(const AirState& state) const;

  /// Searches for the present pockets, with the vents at these places. Pockets of the first search of a run may start
  /// at a pressure that the case gives. Throws InputError where it gives one and there is no enclosed air. Collective.
  void look(const Walls<Dim>& walls, std::span<const Vec<Dim>> vents, const Particles<Dim>& particles,
            const Communicator& ranks, AirState& state);

  /// Discards the result of the last search and the responses. Call when particles have been repartitioned and sorted.
  void forget();

  std::vector<PocketShare> shares_at(const Boundary<Dim>& boundary, const Vec<Dim>& x) const {
    return space_.shares_at(boundary, x);
  }
  /// shares_at, with the remainder to 1 added to the reference pocket of the space at x, if it has one. The pressure of
  /// that pocket is added to all of the space, and only the differences of other pockets from it act on the water.
  std::vector<PocketShare> fractions_at(const Boundary<Dim>& boundary, const Vec<Dim>& x) const;
  /// The reference pocket of the space at x, as an index; -1: it has none, since it is open, or an end has a level.
  int reference_at(const Vec<Dim>& x) const;
  /// The reference pocket of the space of a pocket.
  int reference_of(int pocket) const { return reference_of_pocket_[pocket]; }
  /// The reference pocket of the space at an end, by index of inlets, then outlets.
  int reference_of_end(std::size_t end) const { return reference_at(ends_[end].inside); }
  /// The pieces of moving walls beside pockets.
  std::vector<PocketWall<Dim>> walls_beside(const Boundary<Dim>& boundary) const;
  /// m^(Dim-1); opening of the vents of each pocket (vent.h).
  const std::vector<double>& openings() const { return openings_; }

  /// Discards the responses alone. Call when the order of particles has changed otherwise.
  void forget_responses() {
    responses_.clear();
    air_pressure_.clear();
  }

  /// The response to a pocket in the last step, from which the next step continues; empty at first.
  AirResponse<Dim>& response(std::int64_t pocket) { return responses_[pocket]; }
  const AirResponse<Dim>& response(std::int64_t pocket) const { return responses_.at(pocket); }
  /// Pa; the pressure made by the air alone, one entry per particle at the last solve: the sum over pockets of their
  /// pressure times their response.
  std::vector<double>& air_pressure() { return air_pressure_; }
  const std::vector<double>& air_pressure() const { return air_pressure_; }

 private:
  bool is_in_gap(const Boundary<Dim>& boundary, int face, const Vec<Dim>& x) const;
  void mark_wall(const Walls<Dim>& walls, std::size_t row, CellMarks& tested, CellMarks& solid) const;
  void mark_across(const Walls<Dim>& walls, std::size_t row, CellMarks& solid) const;
  void mark_plate(const Walls<Dim>& walls, std::size_t row, CellMarks& plates) const;
  void mark_rows(const Walls<Dim>& walls, std::size_t from, std::size_t to, CellMarks& solid, CellMarks& plates) const;
  void mark_resting(const Walls<Dim>& walls, const Communicator& ranks);
  void mark_end(const AirEnd<Dim>& end, CellMarks& closed) const;
  void find_spaces(const CellMarks& solid, const CellMarks& plates);
  void find_references(std::span<const FoundPocket> found);
  void find_openings(std::span<const Vec<Dim>> vents, std::size_t pockets);
  void set_start_pressures(AirState& state) const;

  std::shared_ptr<const VoidGrid<Dim>> grid_;
  GasLaw law_;
  double spacing_ = 0.0;
  bool knows_walls_ = false;
  std::vector<WallPatch<Dim>> moving_;  ///< pieces of walls that move
  CellMarks resting_;                   ///< cells behind walls at rest
  CellMarks resting_plates_;            ///< cells beside plates at rest
  CellMarks closed_ends_;               ///< cells on inlets and outlets
  bool has_looked_ = false;
  PocketSpace<Dim> space_;
  std::vector<PocketTable> starts_;
  std::vector<VentTable> vents_;
  std::vector<AirEnd<Dim>> ends_;
  SealedSpaces<Dim> spaces_;
  std::vector<int> reference_of_pocket_;
  std::map<int, int> reference_of_space_;
  std::vector<double> openings_;
  std::map<std::int64_t, AirResponse<Dim>> responses_;  ///< by the number of the pocket
  std::vector<double> air_pressure_;
};

}  // namespace tailwater
