// Floating bodies beside other walls. The force of the water on a body is the integral of the pressure over its own
// surface. The space of another wall has no pairs with the body, and neither has a gap that is too narrow for a row of
// particles. A piece of the surface there gets what the pairs miss, the force p m with
//
//   m = s (-A n - sum of the forces that the pairs have in a pressure of 1),
//
// s = 1 beside a gap narrower than dx, and 0 beside one of 1.75 dx or more, in which rows of particles press by
// themselves.
//
// p is the pressure of the water beside the piece. In a gap without room for a row of particles it is that of a film.
// Water hardly flows there, so p - rho g.x in a gap is harmonic along it (Reynolds), and at its rim that of the water
// beside it, or of the air. Each place of the gap has the mean over the rim with weights 1/r^(Dim-1), which is that
// function between the ends of a slit, along a strip and under a disc.
//
// Water in a gap narrower than 0.75 dx is held: it rests, since particles cannot tell how it would flow, and its
// pressure follows that of the water around it (docs/theory/floating_bodies.md).
#pragma once

#include <Eigen/Core>

#include <vector>

#include "base/box.h"
#include "bodies/floating_bodies.h"
#include "neighbours/cell_grid.h"

namespace tailwater {

template <int Dim>
class NarrowGaps {
 public:
  /// With the walls and the water where they are, at `time` [s].
  NarrowGaps(const Flow<Dim>& flow, const FloatingBodies<Dim>& bodies, double time);

  /// The water in gaps that are narrower than 0.75 dx.
  std::vector<std::size_t> find_stagnant() const;
  /// Measures what the pairs of water that is not stagnant make of a pressure. Call when it is known which is.
  /// Collective.
  void measure();
  /// Makes the stagnant water rest, with the pressure of the water around it. Changes the flow's rows. Collective.
  void hold_water(Flow<Dim>& flow) const;

  /// Calls push(body, x, force, couple) for what the pairs miss on a piece of a body in `pressure` [Pa], which is up to
  /// date. All ranks make the same calls. Collective.
  template <class Push>
  void visit_forces(const std::vector<double>& pressure, Push&& push) const {
    const Eigen::VectorXd p = find_pressure(pressure);
    for (std::size_t n = 0; n < pieces_.size(); ++n) {
      const double on_piece = p[static_cast<Eigen::Index>(n)];
      const Piece& piece = pieces_[n];
      if (on_piece > 0.0)
        push(piece.body, piece.x, Vec<Dim>(on_piece * piece.area), Turn<Dim>(on_piece * piece.couple));
    }
  }

  /// Calls push(body, x, force) for what water in films does to bodies by its pairs, as far as the film counts. Of the
  /// owned water.
  template <class Push>
  void visit_pairs_in_films(const std::vector<double>& pressure, Push&& push) const {
    const Particles<Dim>& particles = flow_.state.particles;
    for (const WaterInGap& water : water_) {
      if (is_stagnant_[water.i] == 0.0) continue;
      visit_pair_forces(flow_, water.i, pressure, [&](std::size_t j, const Vec<Dim>& force) {
        if (particles.is_fluid(j)) return;
        const auto row = particles.wall_row[j];
        if (bodies_.body_of_wall[flow_.walls.particles.wall[row]] != water.body) return;
        push(water.body, flow_.walls.particles.position[row], force);
      });
    }
  }

  /// The nearest other wall of a body that has a force here, else -1.
  int wall_beside(int body) const {
    int wall = -1;
    double least = resolved_gap * flow_.setup.scale.spacing;
    for (const Piece& piece : pieces_) {
      if (piece.body != body || piece.gap >= least) continue;
      least = piece.gap;
      wall = piece.other_wall;
    }
    return wall;
  }

 private:
  /// [dx]; from here on rows of particles press on a body by themselves. With what their pairs miss as well they would
  /// press by up to a fifth of the buoyancy too much.
  static constexpr double resolved_gap = 1.75;

  struct Piece {
    int body;
    int other_wall;                    ///< index into Boundary::walls
    Vec<Dim> x;                        ///< on the body
    Vec<Dim> towards_body;             ///< from the wall
    double gap;                        ///< m
    Vec<Dim> surface;                  ///< m^(Dim-1); force of a pressure of 1 on it
    double film;                       ///< share of a film where there is no water: 1 in a gap without room for a row
    Vec<Dim> area = Vec<Dim>::Zero();  ///< m^(Dim-1); force per pressure that pairs miss
    Turn<Dim> couple = Turn<Dim>::Zero();  ///< m^Dim; likewise, about x
    double wetness = 0.0;                  ///< 1 where water is beside it
    double nearest = 0.0;                  ///< m; the narrowest gap that pairs reach from here
    std::int32_t gap_number = -1;          ///< pieces of one gap have the same
    std::vector<std::size_t> water = {};   ///< owned particles beside it
    std::vector<Vec<Dim>> places = {};     ///< m; of these, or of their images
    std::vector<double> weights = {};      ///< w W at x
  };

  /// What is nearest of all other walls.
  struct OtherWall {
    int wall;         ///< index into Boundary::walls, or -1
    double distance;  ///< m; negative behind it
    Vec<Dim> normal;
  };

  /// Owned water in a gap that has a film.
  struct WaterInGap {
    std::size_t i;
    int body;
    double width;  ///< m; of the gap
  };

  void find_pieces(double time);
  OtherWall other_wall(int body, const Vec<Dim>& x, double reach) const;
  double film_at(double width, double facing) const;
  void find_water();
  void number_gaps();
  void find_nearest();
  void look_at_water();
  void measure_pairs();
  void find_shares();
  bool is_film(const Piece& piece) const;
  /// m; of the gap between a body and another wall at x, at most that of the widest film.
  double width_at(int body, const Vec<Dim>& x) const;
  double share_beside(const Piece& piece) const;
  double share_at(double gap) const;
  /// Adds a force per pressure at x to the sums of piece n.
  void add(std::int32_t n, const Vec<Dim>& x, const Vec<Dim>& force, std::vector<double>& sums) const;
  void subtract_pairs(std::size_t i, int body, std::vector<double>& sums) const;
  /// The piece of the body that is nearest to x, or -1.
  std::int32_t nearest_piece(int body, const Vec<Dim>& x) const;
  template <class Visit>
  void visit_near(const Piece& piece, double reach, Visit&& visit) const;
  /// Pa; at each piece.
  Eigen::VectorXd find_pressure(const std::vector<double>& pressure) const;
  double weight_of(const Vec<Dim>& x) const { return flow_.setup.liquid.density * flow_.setup.gravity.dot(x); }

  const Flow<Dim>& flow_;
  const FloatingBodies<Dim>& bodies_;
  std::vector<AffineMap<Dim>> placements_;  ///< of the surfaces that bodies can touch
  std::vector<Piece> pieces_;               ///< the same on all ranks, but for the water
  std::vector<std::size_t> films_;          ///< pieces whose pressure is that of a film
  std::vector<std::size_t> rim_;            ///< pieces beside films
  Eigen::MatrixXd shares_;                  ///< of each piece of the rim in the head of each film
  std::vector<WaterInGap> water_;
  std::int32_t gap_count_ = 0;
  std::vector<double> is_stagnant_;  ///< of all particles, 1 or 0
  static constexpr std::size_t twist_size = Dim + turns<Dim>;
  CellGrid<Dim> places_;  ///< of the pieces
  Box<Dim> around_;       ///< all places that are near to pieces
};

}  // namespace tailwater
