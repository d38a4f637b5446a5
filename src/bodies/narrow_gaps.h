// Forces on hulls beside other walls. A hull is a floating body, or a fixed wall that water surrounds. The force of the
// water on it is the integral of the pressure over its surface. The volume of another wall has no pairs with the hull,
// nor does a gap that is too narrow for a row of particles. A piece of the hull's surface there therefore receives the
// missing force p m with
//
//   m = s (-A n - sum of the pair forces for a pressure of 1),
//
// where s = 1 beside a gap narrower than dx, and 0 beside one of 1.75 dx or more, in which rows of particles transmit
// the pressure.
//
// A fixed hull has s = 1 on all pieces if its narrowest gap is at most 1.5 dx, and 0 from 2 dx on.
//
// p is the pressure of the water beside the piece. In a gap too narrow for a row of particles it is that of a film.
// Water hardly flows there, so p - rho g.x is harmonic in the gap (Reynolds). At its rim it is that of the water or air
// there. Each place of the gap has the mean over the rim with weights 1/r^(Dim-1), which is the harmonic function
// between the ends of a slit, along a strip and under a disc.
//
// Water in a gap narrower than 0.75 dx is held at rest, because particles cannot resolve its flow. Its pressure follows
// that of the water around it (docs/theory/floating_bodies.md).
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "base/box.h"
#include "bodies/floating_bodies.h"
#include "bodies/hulls.h"
#include "bodies/sealed_water.h"
#include "neighbours/cell_grid.h"

namespace tailwater {

template <int Dim>
class NarrowGaps {
 public:
  /// With walls and water at their present positions, at `time` [s].
  NarrowGaps(const Flow<Dim>& flow, const Hulls<Dim>& hulls, double time);

  /// Finds the water of gaps again where only water has moved.
  void find_water();
  /// Owned water in gaps that are narrower than 0.75 dx, beside fixed hulls 1.5 dx.
  std::vector<std::size_t> find_stagnant() const;
  /// Finds the water that is not stagnant, and the films where there is none. Collective.
  void find_films(std::span<const std::size_t> stagnant);
  /// Also measures the pair forces of this water per pressure. Collective.
  void measure(std::span<const std::size_t> stagnant);
  /// Holds the stagnant water at rest, with the pressure of the water around it. Changes the flow's rows. Collective.
  void hold_water(Flow<Dim>& flow, std::span<const std::size_t> stagnant) const;

  /// The sealed water at the present `pressure` [Pa], after `find_films` (sealed_water.cpp). Collective.
  SealedWater find_sealed(const std::vector<double>& pressure) const;
  /// Whether a hull touches another wall, or some piece faces one across a gap that a film can fill.
  bool can_seal() const {
    return !contacts_.empty() || std::ranges::any_of(pieces_, [](const Piece& piece) { return piece.film > 0.0; });
  }

  /// Calls push(hull, x, force, couple) for the force that pairs miss on each piece of a hull in `pressure` [Pa], which
  /// is up to date. All ranks make the same calls. Collective.
  template <class Push>
  void visit_forces(const std::vector<double>& pressure, Push&& push) const {
    const Eigen::VectorXd p = find_pressure(pressure);
    for (std::size_t n = 0; n < pieces_.size(); ++n) {
      const double on_piece = p[static_cast<Eigen::Index>(n)];
      const Piece& piece = pieces_[n];
      if (on_piece != 0.0)
        push(piece.hull, piece.x, Vec<Dim>(on_piece * piece.area), Turn<Dim>(on_piece * piece.couple));
    }
  }

  /// Calls push(hull, x, force) for the pair forces of owned stagnant water on hulls, as far as the film replaces them.
  template <class Push>
  void visit_pairs_in_films(const std::vector<double>& pressure, Push&& push) const {
    const WallParticles<Dim>& walls = flow_.walls.particles;
    for (const std::size_t i : stagnant_) {
      visit_pair_forces(flow_, i, pressure, [&](std::size_t j, const Vec<Dim>& force) {
        if (flow_.state.particles.is_fluid(j)) return;
        const auto row = flow_.state.particles.wall_row[j];
        const int hull = hulls_.of_wall[walls.wall[row]];
        const double share = hull < 0 ? 0.0 : share_replaced(i, hull, walls.position[row]);
        if (share > 0.0) push(hull, walls.position[row], Vec<Dim>(share * force));
      });
    }
  }

  /// [dx]; the narrowest gap of a hull, infinite if no other wall is within 3 dx.
  double narrowest(int hull) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Piece& piece : pieces_) {
      if (piece.hull == hull) least = std::min(least, piece.gap / piece.spacing);
    }
    return least;
  }

  /// The nearest other wall of a hull that has a force here, else -1.
  int wall_beside(int hull) const {
    int wall = -1;
    double least = resolved_gap * flow_.setup.scale.spacing;
    for (const Piece& piece : pieces_) {
      if (piece.hull != hull || piece.gap >= std::min(least, resolved_gap * piece.spacing)) continue;
      least = piece.gap;
      wall = piece.other_wall;
    }
    return wall;
  }

  /// The wall across the narrowest gap of a hull within the reach of pairs, else -1.
  int wall_facing(int hull) const {
    int wall = -1;
    double least = std::numeric_limits<double>::infinity();
    for (const Piece& piece : pieces_) {
      if (piece.hull != hull || !piece.faces || piece.gap >= least) continue;
      least = piece.gap;
      wall = piece.other_wall;
    }
    return wall;
  }

 private:
  /// [dx]; from this width on, rows of particles in the gap transmit the pressure. With the missing force added, the
  /// force would exceed the buoyancy by up to a fifth.
  static constexpr double resolved_gap = 1.75;

  struct Piece {
    int hull;
    int other_wall;                        ///< index into Boundary::walls
    Vec<Dim> x;                            ///< on the hull
    double spacing;                        ///< m; dx here
    Vec<Dim> towards_hull;                 ///< unit normal from the wall
    double gap;                            ///< m
    Vec<Dim> surface;                      ///< m^(Dim-1); force of a pressure of 1 on it
    bool faces;                            ///< whether water can be between it and a wall that faces it
    double film;                           ///< film fraction where there is no water: 1 in a gap too narrow for a row
    Vec<Dim> area = Vec<Dim>::Zero();      ///< m^(Dim-1); missing force per pressure
    Turn<Dim> couple = Turn<Dim>::Zero();  ///< m^Dim; missing couple per pressure, about x
    double wetness = 0.0;                  ///< 1 where water is beside the piece
    double nearest = 0.0;                  ///< m; the narrowest gap in reach of pairs from here
    std::int32_t gap_number = -1;          ///< common to all pieces of a gap
    bool is_at_contact = false;            ///< whether a contact of the hull is beside it
    std::vector<std::size_t> water = {};   ///< owned particles beside the piece
    std::vector<Vec<Dim>> places = {};     ///< m; of these particles, or of their images
    std::vector<double> weights = {};      ///< w W of these particles at x
  };

  /// A place where a hull lies flat on a wall or is in it. Water seeps through contacts: they join the gaps beside
  /// them.
  struct Contact {
    int hull;
    Vec<Dim> x;
    double spacing;  ///< m; dx here
  };

  /// The nearest wall that does not belong to the hull.
  struct OtherWall {
    int wall;         ///< index into Boundary::walls, or -1
    double distance;  ///< m; negative behind the wall
    Vec<Dim> normal;
  };

  /// Owned water in a gap that has a film.
  struct WaterInGap {
    std::size_t i;
    int hull;
    double width;    ///< m; of the gap
    double spacing;  ///< m; dx here
  };

  /// m; dx at a place.
  double spacing_at(const Vec<Dim>& x) const { return flow_.setup.scale.spacing * flow_.setup.relative_spacing(x); }
  void find_pieces(double time);
  OtherWall other_wall(int hull, const Vec<Dim>& x, double reach) const;
  /// The wall that faces a place on a hull with this normal within the widest film, else the `nearest` wall.
  OtherWall wall_across(int hull, const Vec<Dim>& x, const Vec<Dim>& normal, const OtherWall& nearest) const;
  /// [dx]; width of a gap at which the effect of a film without water in it ends.
  double widest_film() const;
  /// Film fraction of a place where a gap is `width` [dx] wide: 1 in a gap too narrow for a row of particles.
  double film_share(double width) const;
  /// Whether the patch lies on the wall.
  bool is_flush(const WallPatch<Dim>& patch, const OtherWall& wall) const;
  /// By patch, whether the hull lies flat on another wall there.
  std::vector<std::uint8_t> find_flat_contacts() const;
  /// Measure of the part of a patch that is in front of other walls and does not lie on them.
  double wetted_measure(const WallPatch<Dim>& patch, const OtherWall& wall, bool is_flat_there) const;
  void number_gaps();
  void find_nearest();
  void look_at_water();
  void measure_pairs();
  void find_shares();
  void find_pieces_beyond();
  bool is_film(const Piece& piece) const;
  /// Width [m] of the gap between a hull and another wall at x, at most that of the widest film.
  double width_at(int hull, const Vec<Dim>& x) const;
  double share_beside(const Piece& piece) const;
  double share_at(const Piece& piece, double beyond) const;
  double share_of_pair(const Piece& piece, const Vec<Dim>& middle) const;
  /// Fraction of the force of stagnant water on a wall particle of a hull that the film replaces: all in a gap of this
  /// hull, in a gap between others as much as of other pairs.
  double share_replaced(std::size_t i, int hull, const Vec<Dim>& x) const;
  /// Adds a force per pressure at x to the sums of piece n.
  void add(std::int32_t n, const Vec<Dim>& x, const Vec<Dim>& force, std::vector<double>& sums) const;
  void subtract_pairs(std::size_t i, int hull, std::vector<double>& sums) const;
  /// The piece of the hull that is nearest to x, or -1.
  std::int32_t nearest_piece(int hull, const Vec<Dim>& x) const;
  template <class Visit>
  void visit_near(const Piece& piece, double reach, Visit&& visit) const;
  /// For each piece the weight of its water, and the weighted sum of the heads [Pa]. Collective.
  std::vector<double> heads_beside(const std::vector<double>& pressure) const;
  /// Mean head [Pa] of other water beside the gap of piece e, by the number of each piece's water and `heads_beside`.
  std::optional<double> head_beyond(std::size_t e, std::span<const double> water, std::span<const double> heads) const;
  /// Pressure [Pa] at each piece.
  Eigen::VectorXd find_pressure(const std::vector<double>& pressure) const;
  double weight_of(const Vec<Dim>& x) const { return flow_.setup.liquid.density * flow_.setup.gravity.dot(x); }

  const Flow<Dim>& flow_;
  Hulls<Dim> hulls_;
  std::vector<AffineMap<Dim>> placements_;        ///< of the surfaces
  std::vector<Piece> pieces_;                     ///< identical on all ranks, except for the water
  std::vector<Contact> contacts_;                 ///< identical on all ranks
  std::vector<std::size_t> films_;                ///< pieces whose pressure is that of a film
  std::vector<std::size_t> rim_;                  ///< pieces beside films
  std::vector<std::vector<std::size_t>> beyond_;  ///< for each piece of the rim, pieces whose head it passes on
  Eigen::MatrixXd shares_;                        ///< weight of each piece of the rim in the head of each film
  std::vector<double> narrowest_;                 ///< dx; of each hull, its narrowest gap
  std::vector<WaterInGap> water_;
  std::int32_t gap_count_ = 0;
  std::vector<std::size_t> stagnant_;  ///< owned
  std::vector<double> is_stagnant_;    ///< of all particles, 1 or 0
  static constexpr std::size_t twist_size = Dim + turns<Dim>;
  CellGrid<Dim> places_;          ///< of the pieces
  std::vector<Box<Dim>> around_;  ///< of each hull, contains all places near its pieces
};

}  // namespace tailwater
