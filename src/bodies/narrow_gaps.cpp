#include "bodies/narrow_gaps.h"

#include <algorithm>
#include <cmath>

#include "base/for_each.h"

namespace tailwater {
namespace {

/// [dx]; water in a narrower gap is held. From 0.6 to 0.9 results are similar. With 0.5 water from both sides piles up
/// in the gap; with 1 water at its rim, held, lets none in as it opens.
constexpr double closed_gap = 0.75;
/// [dx]; a row of particles has room in a wider gap.
constexpr double open_gap = 1.0;
/// [dx]; a piece of a gap counts less and less from there to here.
constexpr double widest_gap = 1.5;

/// Of the pressure on a wall, what one row of water at dx/2 from it does by its pairs: 0.845 in 2D and 0.859 in 3D, in
/// sums over a lattice. The rest is what the rows behind it would do.
constexpr double share_of_a_row = 0.85;

/// [dx]; water so near to the middle of a piece is in the gap, not beside it.
constexpr double reach_of_piece = 0.75;

/// Least of -cos of the angle between the normals of a body's particle and of the wall that it faces: at the corner of
/// a box, where it is the mean of three, it is 0.577.
constexpr double least_opposite = 0.5;

/// [dx]; pieces so near are beside each other.
constexpr double reach_of_neighbours = 1.6;

/// [dx]; the sum of the offsets to the pieces beside one is longer at a rim: dx in 2D, 3 dx at a straight one in 3D.
constexpr double least_lopsidedness = 0.5;

}  // namespace

template <int Dim>
NarrowGaps<Dim>::NarrowGaps(const Flow<Dim>& flow, const FloatingBodies<Dim>& bodies, double time)
    : flow_(flow), bodies_(bodies) {
  find_pieces(time);
  if (pieces_.empty()) return;
  find_rim(time);
  find_shares();
  look_at_water();
}

template <int Dim>
void NarrowGaps<Dim>::find_pieces(double time) {
  const WallParticles<Dim>& table = flow_.walls.particles;
  const double dx = flow_.setup.scale.spacing;
  const ContactSurfaces<Dim>& contact = bodies_.contact;
  const Boundary<Dim>& resting = contact.each.front().boundary;
  for (const ContactSurface<Dim>& hull : contact.each) {
    if (hull.body < 0) continue;
    const AffineMap<Dim> placement = flow_.state.motion.bodies.each[hull.body].at(time);
    for (std::int32_t row = 0; row < static_cast<std::int32_t>(flow_.walls.moving); ++row) {
      if (bodies_.body_of_wall[table.wall[row]] != hull.body) continue;
      const Vec<Dim>& x = table.position[row];
      const NearestWall<Dim> wall = resting.nearest(x, (1.0 + widest_gap) * dx);
      if (wall.face < 0 || wall.signed_distance <= 0.0) continue;
      const Vec<Dim> normal = (x - wall.point) / wall.signed_distance;
      if (-table.normal[row].dot(normal) < least_opposite) continue;
      const double depth = -hull.boundary.nearest(placement.inverse(x), contact_reach * dx).signed_distance;
      const double gap = std::max(0.0, wall.signed_distance - depth);
      if (depth <= 0.0 || depth >= dx || gap >= widest_gap * dx) continue;
      pieces_.push_back({.body = hull.body, .row = row, .x = x - depth * normal, .normal = normal, .gap = gap});
    }
  }
}

// At a rim the pieces beside one are on one side only. It counts if the place on the other side is free. Between a body
// and a side wall it is not.
template <int Dim>
void NarrowGaps<Dim>::find_rim(double time) {
  const double dx = flow_.setup.scale.spacing;
  const ContactSurfaces<Dim>& contact = bodies_.contact;
  std::vector<Vec<Dim>> places;
  for (const Piece& piece : pieces_) places.push_back(piece.x);
  const CellGrid<Dim> grid(places, reach_of_neighbours * dx);
  for (Piece& piece : pieces_) {
    Vec<Dim> inward = Vec<Dim>::Zero();
    bool is_alone = true;
    grid.for_each_near(piece.x, [&](std::int32_t n) {
      const Vec<Dim> offset = pieces_[n].x - piece.x;
      if (&pieces_[n] == &piece || pieces_[n].body != piece.body || offset.norm() >= reach_of_neighbours * dx) return;
      inward += offset;
      is_alone = false;
    });
    if (!is_alone && inward.norm() < least_lopsidedness * dx) continue;
    Vec<Dim> beside = piece.x + 0.5 * dx * piece.normal;
    if (!is_alone) beside -= dx * inward.normalized();
    piece.is_at_rim = std::ranges::all_of(contact.each, [&](const ContactSurface<Dim>& surface) {
      if (surface.wall >= 0 || (surface.body >= 0 && surface.body != piece.body)) return true;
      const AffineMap<Dim> placement =
          surface.body < 0 ? AffineMap<Dim>() : flow_.state.motion.bodies.each[surface.body].at(time);
      const NearestWall<Dim> nearest = surface.boundary.nearest(placement.inverse(beside), contact_reach * dx);
      return nearest.face < 0 || nearest.signed_distance > 0.0;
    });
  }
}

template <int Dim>
void NarrowGaps<Dim>::find_shares() {
  const auto other =
      std::stable_partition(pieces_.begin(), pieces_.end(), [](const Piece& piece) { return piece.is_at_rim; });
  rim_ = static_cast<std::size_t>(other - pieces_.begin());
  const auto count = [](std::size_t n) { return static_cast<Eigen::Index>(n); };
  shares_.setIdentity(count(pieces_.size()), count(rim_));
  for (std::size_t n = rim_; n < pieces_.size(); ++n) {
    auto shares = shares_.row(count(n));
    for (std::size_t e = 0; e < rim_; ++e) {
      if (pieces_[e].body == pieces_[n].body)
        shares[count(e)] = std::pow((pieces_[e].x - pieces_[n].x).norm(), 1 - Dim);
    }
    if (shares.any()) shares /= shares.sum();
  }
}

template <int Dim>
bool NarrowGaps<Dim>::holds_water(const Piece& piece) const {
  return piece.gap < closed_gap * flow_.setup.scale.spacing;
}

// Water fills a gap in front of a piece as far as a hat of dx around its middle holds it, which a row of particles dx
// apart does. If it is not held it presses on the body itself, as a row alone does.
template <int Dim>
void NarrowGaps<Dim>::look_at_water() {
  const Particles<Dim>& particles = flow_.state.particles;
  const Pairs<Dim>& pairs = flow_.pairs();
  const double dx = flow_.setup.scale.spacing;
  for (const Piece& piece : pieces_) {
    middles_.push_back(flow_.neighbourhood.wrapped(piece.x - 0.5 * piece.gap * piece.normal));
  }
  grid_ = CellGrid<Dim>(middles_, reach_of_piece * dx);
  std::vector<std::int32_t> piece_of(flow_.walls.moving, -1);
  for (std::size_t n = 0; n < pieces_.size(); ++n) piece_of[pieces_[n].row] = static_cast<std::int32_t>(n);
  std::vector<double> filled(pieces_.size(), 0.0);
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: few are of a gap
    if (particles.is_fluid(i)) continue;
    const auto row = static_cast<std::size_t>(particles.wall_row[i]);
    if (row >= piece_of.size() || piece_of[row] < 0) continue;
    const auto n = static_cast<std::size_t>(piece_of[row]);
    pieces_[n].particle = i;
    const Vec<Dim> to_middle =
        pieces_[n].x - 0.5 * pieces_[n].gap * pieces_[n].normal - flow_.walls.particles.position[row];
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = static_cast<std::size_t>(pairs.j[k]);
      if (!particles.is_fluid(j)) continue;
      filled[n] += std::max(0.0, 1.0 - (particles.position[j] - particles.position[i] - to_middle).norm() / dx);
      if (pieces_[n].is_at_rim && piece_at(particles.position[j]) < 0) pieces_[n].water.push_back(k);
    }
  }
  flow_.setup.ranks.sum_of_each(filled);
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    Piece& piece = pieces_[n];
    const double water = holds_water(piece) ? 0.0 : std::min(1.0, filled[n]);
    const double counted = std::min(1.0, (widest_gap - piece.gap / dx) / (widest_gap - open_gap));
    piece.area = std::pow(dx, Dim - 1) * counted * (1.0 - share_of_a_row * water);
  }
}

template <int Dim>
std::int32_t NarrowGaps<Dim>::piece_at(const Vec<Dim>& x) const {
  std::int32_t nearest = -1;
  double least = reach_of_piece * flow_.setup.scale.spacing;
  grid_.for_each_near(x, [&](std::int32_t n) {
    const double distance = (x - middles_[n]).norm();
    if (distance >= least) return;
    nearest = n;
    least = distance;
  });
  return nearest;
}

template <int Dim>
std::vector<std::size_t> NarrowGaps<Dim>::hold_water(Flow<Dim>& flow) const {
  if (pieces_.empty()) return {};
  Particles<Dim>& particles = flow.state.particles;
  flow.halo().exchange(particles.pressure);
  const Eigen::VectorXd p = find_pressure(particles.pressure);
  const auto piece_that_holds = [&](std::size_t i) {
    const std::int32_t n = flow.role[i] == Role::water ? piece_at(particles.position[i]) : -1;
    return n >= 0 && holds_water(pieces_[n]) ? n : -1;
  };
  const std::vector<std::size_t> stagnant =
      indices_where(particles.owned, [&](std::size_t i) { return piece_that_holds(i) >= 0; });
  for (const std::size_t i : stagnant) {
    const std::int32_t n = piece_that_holds(i);
    flow.role[i] = Role::stagnant;
    particles.velocity[i].setZero();
    flow.pressure_rows.divide_diagonal(i, 0.0);
    flow.pressure_rows.rhs()[i] = p[n];
  }
  return stagnant;
}

template <int Dim>
Eigen::VectorXd NarrowGaps<Dim>::find_rim_heads(const std::vector<double>& pressure) const {
  const Particles<Dim>& particles = flow_.state.particles;
  const Pairs<Dim>& pairs = flow_.pairs();
  std::vector<double> sums(2 * rim_, 0.0);  // of each piece the weight of the water beside it, and with heads
  for (std::size_t n = 0; n < rim_; ++n) {
    for (const std::size_t k : pieces_[n].water) {
      const auto j = static_cast<std::size_t>(pairs.j[k]);
      const double weight = pairs.value(pieces_[n].particle, k);
      sums[2 * n] += weight;
      sums[2 * n + 1] += weight * (pressure[j] - weight_of(particles.position[j]));
    }
  }
  flow_.setup.ranks.sum_of_each(sums);
  Eigen::VectorXd heads(static_cast<Eigen::Index>(rim_));
  for (std::size_t n = 0; n < rim_; ++n) {
    heads[static_cast<Eigen::Index>(n)] = sums[2 * n] > 0.0 ? sums[2 * n + 1] / sums[2 * n] : -weight_of(pieces_[n].x);
  }
  return heads;
}

template <int Dim>
Eigen::VectorXd NarrowGaps<Dim>::find_pressure(const std::vector<double>& pressure) const {
  if (pieces_.empty()) return {};
  Eigen::VectorXd p = shares_ * find_rim_heads(pressure);
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    const auto k = static_cast<Eigen::Index>(n);
    p[k] = shares_.row(k).any() ? std::max(0.0, p[k] + weight_of(pieces_[n].x)) : 0.0;
  }
  return p;
}

template class NarrowGaps<2>;
template class NarrowGaps<3>;

}  // namespace tailwater
