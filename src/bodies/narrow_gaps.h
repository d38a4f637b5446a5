// Gaps between floating bodies and walls at rest that are too narrow for a row of particles. Water gets into them all
// the same, and presses the body off the wall. It hardly flows there, so p - rho g.x in a gap is harmonic along it
// (Reynolds), and at its rim that of the water beside it, or of the air. Each place of the gap has the mean over the
// rim with weights 1/r^(Dim-1), which is that function between the ends of a slit, along a strip and under a disc.
//
// Pieces of a gap are in front of the first row of the body's particles. From a width of dx on, or where water is in
// front of a piece, the particles' own forces take the place of the piece's. Water in a gap narrower than 0.75 dx is
// held: it rests, since particles cannot tell how it would flow, and has the pressure of the gap. What it does to the
// body is what the piece does (docs/theory/floating_bodies.md).
#pragma once

#include <vector>

#include "bodies/floating_bodies.h"
#include "neighbours/cell_grid.h"

namespace tailwater {

template <int Dim>
class NarrowGaps {
 public:
  /// With the walls and the water where they are, at `time` [s]. Collective.
  NarrowGaps(const Flow<Dim>& flow, const FloatingBodies<Dim>& bodies, double time);

  /// Makes water in gaps that are narrower than 0.75 dx stagnant: it rests, with the pressure that the gap had last.
  /// Changes the flow's rows. Returns these particles. Collective.
  std::vector<std::size_t> hold_water(Flow<Dim>& flow) const;

  /// Calls push(body, x, force) for what a piece of a gap does to a body in `pressure` [Pa], which is up to date. All
  /// ranks make the same calls. Collective.
  template <class Push>
  void visit_forces(const std::vector<double>& pressure, Push&& push) const {
    const Eigen::VectorXd p = find_pressure(pressure);
    for (std::size_t n = 0; n < pieces_.size(); ++n) {
      const double force = p[static_cast<Eigen::Index>(n)] * pieces_[n].area;
      if (force > 0.0) push(pieces_[n].body, pieces_[n].x, Vec<Dim>(force * pieces_[n].normal));
    }
  }

 private:
  struct Piece {
    int body;
    std::int32_t row;                     ///< of the body's particle
    Vec<Dim> x;                           ///< on the body
    Vec<Dim> normal;                      ///< of the wall, towards the body
    double gap;                           ///< m
    double area = 0.0;                    ///< m^(Dim-1); that counts
    bool is_at_rim = false;               ///< whether what is beside it is not the gap
    std::size_t particle = 0;             ///< of the body, if this rank owns it
    std::vector<std::size_t> water = {};  ///< its pairs with water beside the gap
  };

  void find_pieces(double time);
  void find_rim(double time);
  void find_shares();
  void look_at_water();
  bool holds_water(const Piece& piece) const;
  /// The piece that water at x is in front of, or -1.
  std::int32_t piece_at(const Vec<Dim>& x) const;
  /// Pa; at each piece.
  Eigen::VectorXd find_pressure(const std::vector<double>& pressure) const;
  /// p - rho g.x [Pa] at each piece of the rim.
  Eigen::VectorXd find_rim_heads(const std::vector<double>& pressure) const;
  double weight_of(const Vec<Dim>& x) const { return flow_.setup.liquid.density * flow_.setup.gravity.dot(x); }

  const Flow<Dim>& flow_;
  const FloatingBodies<Dim>& bodies_;
  std::vector<Piece> pieces_;      ///< the same on all ranks, but for the water; the rim's come first
  std::size_t rim_ = 0;            ///< pieces of the rim
  Eigen::MatrixXd shares_;         ///< of each piece of the rim in the head of each piece
  std::vector<Vec<Dim>> middles_;  ///< of the pieces, where the water's particles are
  CellGrid<Dim> grid_;             ///< of the middles
};

}  // namespace tailwater
