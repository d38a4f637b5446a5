#include "bodies/narrow_gaps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/for_each.h"
#include "bodies/contacts.h"
#include "flow/pressure_equation.h"
#include "neighbours/halo.h"
#include "operators/support_operators.h"

namespace tailwater {
namespace {

/// [dx]; water in a narrower gap is held at rest. Results for 0.6 to 0.9 are similar. With 0.5 water from both sides
/// piles up in the gap; with 1 the water held at its rim prevents inflow when the gap opens.
constexpr double closed_gap = 0.75;
/// [dx]; a row of particles fits into a wider gap.
constexpr double open_gap = 1.0;
/// [dx]; width of gaps beside fixed hulls in which the film takes the place of the water for the force. One or two rows
/// there have too high a pressure, because they have less area than the gap. With 2 the lift in water at rest is within
/// 3 % for all shapes, but in flows the water that runs through gaps of 1.5 to 2.5 dx is left out.
constexpr double closed_gap_of_fixed = 1.5;
/// [dx]; the effect of a film without water in it decreases from `open_gap` on, and ends at a gap wider by this.
constexpr double fading_film = 0.5;

/// [dx]; pieces nearer to each other than this are neighbours.
constexpr double reach_of_neighbours = 1.6;

/// [dx]; a pair whose middle is farther than this from all pieces belongs to the rest of the hull.
constexpr double reach_of_pairs = 3.0;

}  // namespace

template <int Dim>
NarrowGaps<Dim>::NarrowGaps(const Flow<Dim>& flow, const Hulls<Dim>& hulls, double time) : flow_(flow), hulls_(hulls) {
  find_pieces(time);
  if (pieces_.empty()) return;
  std::vector<Vec<Dim>> places;
  for (const Piece& piece : pieces_) places.push_back(piece.x);
  places_ = CellGrid<Dim>(places, reach_of_pairs * flow_.setup.scale.spacing);
  around_.resize(static_cast<std::size_t>(hulls_.count));
  for (const Piece& piece : pieces_) around_[static_cast<std::size_t>(piece.hull)].extend(piece.x);
  for (Box<Dim>& around : around_) around.widen(reach_of_pairs * flow_.setup.scale.spacing);
  number_gaps();
  find_nearest();
  find_water();
}

template <int Dim>
template <class Visit>
void NarrowGaps<Dim>::visit_near(const Piece& piece, double reach, Visit&& visit) const {
  places_.for_each_near(piece.x, [&](std::int32_t m) {
    const Piece& other = pieces_[m];
    if (other.hull == piece.hull && (other.x - piece.x).norm() < reach * piece.spacing) {
      visit(static_cast<std::size_t>(m));
    }
  });
}

template <int Dim>
void NarrowGaps<Dim>::number_gaps() {
  std::vector<Contact> all = contacts_;  // then the pieces
  for (const Piece& piece : pieces_) all.push_back({piece.hull, piece.x, piece.spacing});
  std::vector<Vec<Dim>> places;
  for (const Contact& one : all) places.push_back(one.x);
  const CellGrid<Dim> grid(places, reach_of_pairs * flow_.setup.scale.spacing);
  std::vector<std::int32_t> number(all.size(), -1);
  const auto is_in_gap = [&](std::size_t n) {
    return n < contacts_.size() || pieces_[n - contacts_.size()].other_wall >= 0;
  };
  std::vector<std::size_t> next;
  for (std::size_t n = 0; n < all.size(); ++n) {
    if (number[n] >= 0 || !is_in_gap(n)) continue;
    number[n] = gap_count_;
    next.push_back(n);
    while (!next.empty()) {
      const std::size_t k = next.back();
      next.pop_back();
      grid.for_each_near(all[k].x, [&](std::int32_t near) {
        const auto m = static_cast<std::size_t>(near);
        if (all[m].hull != all[k].hull || (all[m].x - all[k].x).norm() >= reach_of_neighbours * all[k].spacing) return;
        if (k < contacts_.size() && m >= contacts_.size()) pieces_[m - contacts_.size()].is_at_contact = true;
        if (number[m] >= 0 || !is_in_gap(m)) return;
        number[m] = gap_count_;
        next.push_back(m);
      });
    }
    ++gap_count_;
  }
  for (std::size_t n = 0; n < pieces_.size(); ++n) pieces_[n].gap_number = number[contacts_.size() + n];
}

template <int Dim>
void NarrowGaps<Dim>::find_nearest() {
  narrowest_.assign(static_cast<std::size_t>(hulls_.count), hulls_.reach);
  for (Piece& piece : pieces_) {
    double& narrowest = narrowest_[static_cast<std::size_t>(piece.hull)];
    if (piece.faces) narrowest = std::min(narrowest, piece.gap / piece.spacing);
    piece.nearest = piece.gap;
    visit_near(piece, reach_of_pairs, [&](std::size_t m) { piece.nearest = std::min(piece.nearest, pieces_[m].gap); });
  }
}

template <int Dim>
bool NarrowGaps<Dim>::is_film(const Piece& piece) const {
  return piece.film > 0.0 && piece.wetness < 1.0;
}

template <int Dim>
void NarrowGaps<Dim>::find_shares() {
  films_.clear();
  rim_.clear();
  std::vector<std::uint8_t> is_rim(pieces_.size(), 0);
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    if (!is_film(pieces_[n])) continue;
    films_.push_back(n);
    visit_near(pieces_[n], reach_of_neighbours, [&](std::size_t m) { is_rim[m] = !is_film(pieces_[m]); });
  }
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    if (is_rim[n] != 0) rim_.push_back(n);
  }
  find_pieces_beyond();
  const auto count = [](std::size_t n) { return static_cast<Eigen::Index>(n); };
  shares_.setZero(count(films_.size()), count(rim_.size()));
  for (std::size_t f = 0; f < films_.size(); ++f) {
    auto shares = shares_.row(count(f));
    const Piece& film = pieces_[films_[f]];
    for (std::size_t e = 0; e < rim_.size(); ++e) {
      const Piece& edge = pieces_[rim_[e]];
      if (edge.gap_number == film.gap_number) shares[count(e)] = std::pow((edge.x - film.x).norm(), 1 - Dim);
    }
    if (shares.any()) shares /= shares.sum();
  }
}

/// Rows of particles that are squeezed between two walls have too high a pressure. A film beside a fixed hull therefore
/// has the head of pieces farther from the other wall, where there is water.
template <int Dim>
void NarrowGaps<Dim>::find_pieces_beyond() {
  beyond_.assign(rim_.size(), {});
  if (!hulls_.can_stand) return;
  for (std::size_t e = 0; e < rim_.size(); ++e) {
    visit_near(pieces_[rim_[e]], reach_of_pairs, [&](std::size_t m) {
      const double gap = pieces_[m].gap / pieces_[m].spacing;
      if (gap >= widest_film() && gap < widest_film() + 1.0 && pieces_[m].wetness == 1.0) beyond_[e].push_back(m);
    });
  }
}

template <int Dim>
void NarrowGaps<Dim>::find_water() {
  water_.clear();
  const Particles<Dim>& particles = flow_.state.particles;
  for (int hull = 0; hull < hulls_.count; ++hull) {
    if (std::ranges::none_of(pieces_, [&](const Piece& piece) { return piece.hull == hull && piece.film > 0.0; })) {
      continue;
    }
    for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: few are in gaps
      if (!particles.is_fluid(i)) continue;
      const std::int32_t piece = nearest_piece(hull, particles.position[i]);
      if (piece < 0 || pieces_[piece].other_wall < 0) continue;
      const WaterInGap water{i, hull, width_at(hull, particles.position[i]), spacing_at(particles.position[i])};
      if (water.width < widest_film() * water.spacing) water_.push_back(water);
    }
  }
}

template <int Dim>
std::vector<std::size_t> NarrowGaps<Dim>::find_stagnant() const {
  std::vector<std::size_t> stagnant;
  const double closed = hulls_.can_stand ? closed_gap_of_fixed : closed_gap;
  for (const WaterInGap& water : water_) {
    if (water.width < closed * water.spacing && flow_.role[water.i] == Role::water) {
      stagnant.push_back(water.i);
    }
  }
  std::ranges::sort(stagnant);
  stagnant.erase(std::unique(stagnant.begin(), stagnant.end()), stagnant.end());
  return stagnant;
}

// Writes rows like that of a dummy: stagnant water acts like a dummy on the water beside it.
template <int Dim>
void NarrowGaps<Dim>::hold_water(Flow<Dim>& flow, std::span<const std::size_t> stagnant) const {
  if (pieces_.empty()) return;
  Particles<Dim>& particles = flow.state.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  const Eigen::VectorXd p = find_pressure(particles.pressure);
  for (const std::size_t i : stagnant) {
    flow.role[i] = Role::stagnant;
    particles.velocity[i].setZero();
    Vec<Dim> offsets = Vec<Dim>::Zero();
    LinearSystem::Row row = flow.equation->rows.row(i);
    const double sum = row.set_weights([&](std::size_t k) {
      const auto j = static_cast<std::size_t>(pairs.j[k]);
      if (!particles.is_fluid(j) || is_stagnant_[j] != 0.0) return 0.0;
      const double weight = particles.volume[j] * pairs.value(i, k);
      offsets += weight * (particles.position[i] - particles.position[j]);
      return weight;
    });
    if (sum > 0.0) {
      row.finish(sum, weight_of(offsets));
    } else {
      const auto own = std::ranges::find(water_, i, &WaterInGap::i);
      row.finish(1.0, p[nearest_piece(own->hull, particles.position[i])]);
    }
  }
}

template <int Dim>
void NarrowGaps<Dim>::find_films(std::span<const std::size_t> stagnant) {
  if (pieces_.empty()) return;
  is_stagnant_.assign(flow_.state.particles.size(), 0.0);
  stagnant_.assign(stagnant.begin(), stagnant.end());
  for (const std::size_t i : stagnant_) is_stagnant_[i] = 1.0;
  flow_.halo().exchange(is_stagnant_);
  look_at_water();
  find_shares();
}

template <int Dim>
void NarrowGaps<Dim>::measure(std::span<const std::size_t> stagnant) {
  find_films(stagnant);
  if (!pieces_.empty()) measure_pairs();
}

template <int Dim>
std::int32_t NarrowGaps<Dim>::nearest_piece(int hull, const Vec<Dim>& x) const {
  std::int32_t nearest = -1;
  if (pieces_.empty() || !around_[static_cast<std::size_t>(hull)].contains(x)) return nearest;
  double least = reach_of_pairs * flow_.setup.scale.spacing;
  places_.for_each_near(x, [&](std::int32_t n) {
    const double distance = (x - pieces_[n].x).norm();
    if (pieces_[n].hull != hull || distance >= std::min(least, reach_of_pairs * pieces_[n].spacing)) return;
    nearest = n;
    least = distance;
  });
  return nearest;
}

template <int Dim>
double NarrowGaps<Dim>::widest_film() const {
  return (hulls_.can_stand ? closed_gap_of_fixed : open_gap) + fading_film;
}

template <int Dim>
double NarrowGaps<Dim>::film_share(double width) const {
  return std::clamp((widest_film() - width) / fading_film, 0.0, 1.0);
}

/// Fraction of the missing pair forces that is added: 1 beside a gap too narrow for a row of particles. All pieces of a
/// fixed hull with such a gap have this fraction. If it changed along the hull, the force components along the surface
/// would no longer cancel over the whole hull.
template <int Dim>
double NarrowGaps<Dim>::share_beside(const Piece& piece) const {
  if (hulls_.can_stand) return film_share(narrowest_[static_cast<std::size_t>(piece.hull)]);
  return std::clamp((resolved_gap - piece.nearest / piece.spacing) / (resolved_gap - open_gap), 0.0, 1.0);
}

/// Weight of a piece beside a narrow gap, or of a pair that acts `beyond` [m] it along the surface. The weight depends
/// on the distance from the other wall: up to half a support the pairs in the space of this wall are missing.
template <int Dim>
double NarrowGaps<Dim>::share_at(const Piece& piece, double beyond) const {
  if (hulls_.can_stand) return 1.0;
  return std::clamp(2.0 - 2.0 * (piece.gap + beyond) / (widest_gap * piece.spacing), 0.0, 1.0);
}

template <int Dim>
double NarrowGaps<Dim>::share_of_pair(const Piece& piece, const Vec<Dim>& middle) const {
  const Vec<Dim> normal = piece.surface.normalized();
  const Vec<Dim> along = middle - piece.x - normal.dot(middle - piece.x) * normal;
  return share_beside(piece) * share_at(piece, piece.towards_hull.dot(along));
}

template <int Dim>
double NarrowGaps<Dim>::share_replaced(std::size_t i, int hull, const Vec<Dim>& x) const {
  const bool is_in_gap_of_hull =
      std::ranges::any_of(water_, [&](const WaterInGap& water) { return water.i == i && water.hull == hull; });
  if (is_in_gap_of_hull) return 1.0;
  const Vec<Dim> middle = 0.5 * (x + flow_.state.particles.position[i]);
  const std::int32_t n = nearest_piece(hull, middle);
  return n < 0 ? 0.0 : share_of_pair(pieces_[n], middle);
}

template <int Dim>
void NarrowGaps<Dim>::add(std::int32_t n, const Vec<Dim>& x, const Vec<Dim>& force, std::vector<double>& sums) const {
  const Twist<Dim> both = twist_of<Dim>(force, moment_of<Dim>(x - pieces_[n].x, force));
  both.add_to(sums.data() + static_cast<std::size_t>(n) * twist_size);
}

// The force of a pair acts midway between its ends, which is on the surface of the hull on average. Acting at the wall
// particle, it would move a force of first order in dx from one side of an edge to the other (docs/theory/probes.md).
template <int Dim>
void NarrowGaps<Dim>::subtract_pairs(std::size_t i, int hull, std::vector<double>& sums) const {
  const Particles<Dim>& particles = flow_.state.particles;
  const Pairs<Dim>& pairs = flow_.pairs();
  const SupportTerms<Dim>& terms = flow_.surroundings.support_terms;
  const Vec<Dim>& x = flow_.walls.particles.position[particles.wall_row[i]];
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = static_cast<std::size_t>(pairs.j[k]);
    if (!particles.is_fluid(j) || is_stagnant_[j] != 0.0) continue;
    const Vec<Dim> middle = x - 0.5 * pairs.d(i, k);
    const std::int32_t n = nearest_piece(hull, middle);
    if (n < 0) continue;
    const double share = share_of_pair(pieces_[n], middle);
    if (share == 0.0) continue;
    const double both = inverse_reference(terms, i) + inverse_reference(terms, j);
    const double unit = both * share * particles.volume[i] * particles.volume[j];
    add(n, middle, unit * flow_.surroundings.pair_vectors.at(pairs, i, k), sums);
  }
}

template <int Dim>
void NarrowGaps<Dim>::measure_pairs() {
  const Particles<Dim>& particles = flow_.state.particles;
  const WallParticles<Dim>& table = flow_.walls.particles;
  std::vector<double> sums(twist_size * pieces_.size(), 0.0);
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: pairs beside one piece add up
    if (particles.is_fluid(i)) continue;
    const int hull = hulls_.of_wall[table.wall[particles.wall_row[i]]];
    if (hull < 0 || nearest_piece(hull, table.position[particles.wall_row[i]]) < 0) continue;
    if (flow_.surroundings.is_wet[i]) subtract_pairs(i, hull, sums);
  }
  flow_.setup.ranks.sum_of_each(sums);
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    Piece& piece = pieces_[n];
    const auto sum = Twist<Dim>::Map(sums.data() + n * twist_size);
    piece.area = sum.template head<Dim>() + share_beside(piece) * share_at(piece, 0.0) * piece.surface;
    piece.couple = sum.template tail<turns<Dim>>();
  }
}

template <int Dim>
std::vector<double> NarrowGaps<Dim>::heads_beside(const std::vector<double>& pressure) const {
  std::vector<double> sums(2 * pieces_.size(), 0.0);
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    const Piece& piece = pieces_[n];
    for (std::size_t k = 0; k < piece.water.size(); ++k) {
      sums[2 * n] += piece.weights[k];
      sums[2 * n + 1] += piece.weights[k] * (pressure[piece.water[k]] - weight_of(piece.places[k]));
    }
  }
  flow_.setup.ranks.sum_of_each(sums);
  return sums;
}

template <int Dim>
Eigen::VectorXd NarrowGaps<Dim>::find_pressure(const std::vector<double>& pressure) const {
  const auto count = [](std::size_t n) { return static_cast<Eigen::Index>(n); };
  const std::vector<double> sums = heads_beside(pressure);
  Eigen::VectorXd p = Eigen::VectorXd::Zero(count(pieces_.size()));
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    if (sums[2 * n] == 0.0) continue;
    const double beside = sums[2 * n + 1] / sums[2 * n] + weight_of(pieces_[n].x);
    p[count(n)] = pieces_[n].wetness * std::max(-flow_.setup.liquid.tension, beside);
  }
  Eigen::VectorXd heads(count(rim_.size()));
  std::vector<double> largest(static_cast<std::size_t>(gap_count_),
                              -std::numeric_limits<double>::infinity());  // of water, by gap
  const auto head_at = [&](std::size_t n) { return p[count(n)] - weight_of(pieces_[n].x); };
  for (std::size_t e = 0; e < rim_.size(); ++e) {
    const double on_rim = p[count(rim_[e])];
    heads[count(e)] = head_at(rim_[e]);
    if (on_rim > 0.0 && !beyond_[e].empty()) {
      double sum = 0.0;
      for (const std::size_t n : beyond_[e]) sum += head_at(n);
      heads[count(e)] = sum / static_cast<double>(beyond_[e].size());
    }
    double& largest_of_gap = largest[static_cast<std::size_t>(pieces_[rim_[e]].gap_number)];
    if (on_rim > 0.0) largest_of_gap = std::max(largest_of_gap, heads[count(e)]);
  }
  const Eigen::VectorXd in_films = shares_ * heads;
  for (std::size_t f = 0; f < films_.size(); ++f) {
    const Piece& film = pieces_[films_[f]];
    // Air at a high part of the rim has a larger head than any water there could have.
    const double head = std::min(in_films[count(f)], largest[static_cast<std::size_t>(film.gap_number)]);
    p[count(films_[f])] += (1.0 - film.wetness) * film.film * std::max(0.0, head + weight_of(film.x));
  }
  return p;
}

template class NarrowGaps<2>;
template class NarrowGaps<3>;

}  // namespace tailwater
