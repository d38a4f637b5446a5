// Water that walls, films and dry contacts close off from all other water, such as that between a pipe and the corner
// of bed and side wall. No surface fixes its pressure. The equation determines it up to a constant, and because the
// volume of so small a space is no multiple of a particle's, the density source made that constant tens of kPa. Real
// water passes through films and contacts until the heads on both sides are equal. So sealed water does not expand on
// average, and its rows beside films and contacts have the additional term
//
//   D_i (1/s - 1) (p_i - p_f),
//
// with the diagonal D_i and the pressure p_f of the water beyond at the place of the particle. The term keeps the
// matrix symmetric and is 0 in water at rest.
#include "bodies/sealed_water.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>

#include "bodies/narrow_gaps.h"
#include "flow/pressure_equation.h"
#include "neighbours/halo.h"

namespace tailwater {
namespace {

/// s. The lift of a fixed pipe in a corner is the same for 0.1 to 0.9. Water that follows a body is thin at times, and
/// counts partly as air: a cylinder has left a corner by 72, 69, 41 and 11 mm after 0.4 s with 0.1, 0.2, 0.5 and 0.9.
constexpr double share_of_row = 0.2;

/// C/C_0; water with less is at a surface, or beside air.
constexpr double min_inside = 0.8;

/// dx; water is between particles that are farther apart, or a wall, or a film.
constexpr double longest_pair = 2.0;

constexpr double none = std::numeric_limits<double>::lowest();
constexpr double anywhere = std::numeric_limits<double>::max();

/// The waters of a flow: sets of particles that pairs join, on all ranks.
template <int Dim>
class Waters {
 public:
  /// Without the water for which `is_left_out` is not 0. surface_at(x) is the head [Pa] of a surface at x. Collective.
  template <class Surface>
  Waters(const Flow<Dim>& flow, const std::vector<double>& is_left_out, Surface&& surface_at)
      : flow_(flow), parent_(flow.state.particles.size()) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    const Particles<Dim>& particles = flow.state.particles;
    const auto counts = [&](std::size_t i) { return particles.is_fluid(i) && is_left_out[i] == 0.0; };
    const Pairs<Dim>& pairs = flow.pairs();
    number.assign(particles.size(), std::numeric_limits<double>::max());
    surface.assign(particles.size(), none);
    for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: sets grow
      if (!counts(i)) continue;
      number[i] = static_cast<double>(particles.id[i]);
      if (flow.role[i] != Role::water) {
        surface[i] = anywhere;
      } else if (flow.surroundings.concentration[i] < min_inside) {
        surface[i] = surface_at(particles.position[i]);
      }
      for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
        const auto j = static_cast<std::size_t>(pairs.j[k]);
        if (counts(j) && pairs.d(i, k).norm() < longest_pair * flow.setup.scale.spacing)
          parent_[root_of(j)] = root_of(i);
      }
    }
    join_ranks();
  }

  std::vector<double> number;   ///< of all particles: the least id in their water
  std::vector<double> surface;  ///< Pa; of all particles: the largest head of a surface of their water, or `none`

 private:
  std::size_t root_of(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  /// Gives each set the least number and the largest head of a surface of its members, ghosts too, until none changes.
  void join_ranks() {
    bool has_changed = true;
    while (flow_.setup.ranks.any(has_changed)) {
      has_changed = false;
      flow_.halo().exchange(number, surface);
      for (std::size_t i = 0; i < parent_.size(); ++i) {
        const std::size_t root = root_of(i);
        has_changed = has_changed || number[i] < number[root] || surface[i] > surface[root];
        number[root] = std::min(number[root], number[i]);
        surface[root] = std::max(surface[root], surface[i]);
      }
      for (std::size_t i = 0; i < parent_.size(); ++i) {
        number[i] = number[root_of(i)];
        surface[i] = surface[root_of(i)];
      }
    }
  }

  const Flow<Dim>& flow_;
  std::vector<std::size_t> parent_;
};

}  // namespace

/// Beside the film itself, rows of particles that are squeezed between the walls have too high a pressure. So the head
/// is that of pieces farther from the other wall, where there are any.
template <int Dim>
std::optional<double> NarrowGaps<Dim>::head_beyond(std::size_t e, std::span<const double> water,
                                                   std::span<const double> heads) const {
  const auto is_beyond = [&](std::size_t n) {
    return pieces_[n].gap_number == pieces_[e].gap_number && heads[2 * n] > 0.0 && water[n] >= 0.0 &&
           water[n] != water[e];
  };
  double farthest = 0.0;
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    if (is_beyond(n)) farthest = std::max(farthest, pieces_[n].gap);
  }
  const double least = std::min(farthest, widest_film() * pieces_[e].spacing);
  double sum = 0.0;
  int count = 0;
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    if (!is_beyond(n) || pieces_[n].gap < least) continue;
    sum += heads[2 * n + 1] / heads[2 * n];
    ++count;
  }
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

template <int Dim>
SealedWater NarrowGaps<Dim>::find_sealed(const std::vector<double>& pressure) const {
  SealedWater sealed;
  if ((films_.empty() && contacts_.empty()) || !flow_.setup.has_air()) return sealed;
  // A space beside a hull that is thinly filled is full of water where it lies below the level of the water beyond.
  const Waters<Dim> waters(flow_, is_stagnant_, [&](const Vec<Dim>& x) {
    for (int hull = 0; hull < hulls_.count; ++hull) {
      if (nearest_piece(hull, x) >= 0) return -weight_of(x);
    }
    return anywhere;
  });
  // Three numbers for each piece: the least and the largest number of the water beside it, and the head of its surface.
  // The last two are negative.
  std::vector<double> least(3 * pieces_.size(), std::numeric_limits<double>::max());
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    for (const std::size_t i : pieces_[n].water) {
      least[3 * n] = std::min(least[3 * n], waters.number[i]);
      least[3 * n + 1] = std::min(least[3 * n + 1], -waters.number[i]);
      least[3 * n + 2] = std::min(least[3 * n + 2], -waters.surface[i]);
    }
  }
  flow_.setup.ranks.min_of_each(least);
  std::vector<double> water(pieces_.size());  // of each piece, -1: none or several
  for (std::size_t n = 0; n < water.size(); ++n) water[n] = least[3 * n] == -least[3 * n + 1] ? least[3 * n] : -1.0;
  const auto one = std::ranges::find_if(water, [](double number) { return number >= 0.0; });
  const bool has_others = std::any_of(one, water.end(), [&](double other) { return other >= 0.0 && other != *one; });
  if (!has_others) return sealed;
  const std::vector<double> heads = heads_beside(pressure);
  std::vector<double> spaces;
  std::vector<double> target(flow_.state.particles.owned, -1.0);
  for (std::size_t e = 0; e < pieces_.size(); ++e) {
    const bool is_beside_seal = pieces_[e].is_at_contact || std::ranges::binary_search(rim_, e);  // it is in order
    if (!is_beside_seal || water[e] < 0.0) continue;
    const std::optional<double> head = head_beyond(e, water, heads);
    if (!head || *head <= -least[3 * e + 2]) continue;
    if (std::ranges::find(spaces, water[e]) == spaces.end()) spaces.push_back(water[e]);
    for (std::size_t k = 0; k < pieces_[e].water.size(); ++k) {
      target[pieces_[e].water[k]] = std::max(0.0, *head + weight_of(pieces_[e].places[k]));
    }
  }
  sealed.spaces = spaces.size();
  for (std::size_t i = 0; sealed.is_any() && i < target.size(); ++i) {
    const auto space = std::ranges::find(spaces, waters.number[i]);
    if (space == spaces.end()) continue;
    sealed.members.push_back({i, static_cast<std::size_t>(space - spaces.begin())});
    if (target[i] >= 0.0) sealed.rims.push_back({i, target[i]});
  }
  return sealed;
}

template <int Dim>
void let_through_films(const SealedWater& sealed, Flow<Dim>& flow) {
  LinearSystem& rows = flow.equation->rows;
  const std::vector<double>& volume = flow.state.particles.volume;
  std::vector<double> sums(2 * sealed.spaces, 0.0);  // of each space: volume, and volume times source
  const auto source_of = [&](std::size_t i) { return rows.scale(i) == 0.0 ? 0.0 : rows.rhs()[i] / rows.scale(i); };
  for (const auto& [i, space] : sealed.members) {
    sums[2 * space] += volume[i];
    sums[2 * space + 1] += volume[i] * source_of(i);
  }
  flow.setup.ranks.sum_of_each(sums);
  for (const auto& [i, space] : sealed.members) rows.set_rhs(i, source_of(i) - sums[2 * space + 1] / sums[2 * space]);
  for (const auto& [i, pressure] : sealed.rims) rows.divide_diagonal(i, share_of_row, pressure);
}

void let_correction_through_films(const SealedWater& sealed, LinearSystem& rows) {
  for (const auto& rim : sealed.rims) rows.divide_diagonal(rim.i, share_of_row);
}

#define TAILWATER_INSTANTIATE(Dim)                                                     \
  template SealedWater NarrowGaps<Dim>::find_sealed(const std::vector<double>&) const; \
  template void let_through_films(const SealedWater&, Flow<Dim>&);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
