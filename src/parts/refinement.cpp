#include "parts/refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>

#include "base/for_each.h"
#include "case/spec.h"
#include "flow/flow.h"
#include "neighbours/neighbourhood.h"
#include "operators/graded_sums.h"
#include "operators/gradient_corrected.h"
#include "sampling/fluid_particles.h"

namespace tailwater {
namespace {

/// Steps between adaptations, and the step of these at which one is made: not one at which particles are sorted,
/// because the neighbours of the last step are used. Water goes a spacing in about five steps.
constexpr std::int64_t steps_between = 5;
constexpr std::int64_t step_of_adaptation = 2;

/// Distance of the two parts of a particle from its place, over V^(1/Dim).
constexpr double offset_of_part = 0.27;

/// Volumes over the wanted one: two particles become one up to the first; up to the second if one of them is below the
/// third.
constexpr double volume_to_merge = 1.0;
constexpr double volume_to_merge_small = 1.3;
constexpr double small_volume = 0.35;
/// Largest distance of two particles that become one, over V^(1/Dim) of their mean volume.
constexpr double distance_to_merge = 1.35;

/// V^(1/Dim); a particle nearer to a wall than the first is split along the wall, and no particle is put nearer than
/// the second.
constexpr double split_along_wall = 0.8;
constexpr double min_distance_from_wall = 0.1;

/// C/C_0 below which a particle is split along the surface.
constexpr double surface_concentration = 0.9;

/// Directions along which a particle may be split, of length 1.
template <int Dim>
std::vector<Vec<Dim>> make_directions() {
  std::vector<Vec<Dim>> all;
  if constexpr (Dim == 2) {
    constexpr int count = 16;
    for (int n = 0; n < count; ++n) {
      const double angle = n * std::numbers::pi / count;
      all.push_back({std::cos(angle), std::sin(angle)});
    }
  } else {
    for (int n = 1; n <= 13; ++n) {  // half of the neighbours of a cell
      const int code = 13 + n;
      const std::array<int, 3> step{code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1};
      all.push_back(Vec<3>(step[0], step[1], step[2]).normalized());
    }
  }
  return all;
}

/// A particle that becomes two.
template <int Dim>
struct Split {
  std::size_t particle;
  Vec<Dim> offset;    ///< m; of one part, that of the other is opposite
  Vec<Dim> velocity;  ///< m/s; by which that part is faster
};

/// Two particles that become one, in the place of the first.
struct Merge {
  std::size_t kept;
  std::size_t removed;
};

/// m; centre of mass of two particles.
template <int Dim>
Vec<Dim> centre_of(const Particles<Dim>& particles, std::size_t i, std::size_t j) {
  const double share = particles.volume[j] / (particles.volume[i] + particles.volume[j]);
  return particles.position[i] + share * (particles.position[j] - particles.position[i]);
}

/// The choice of the particles of a rank that split and merge.
template <int Dim>
class Adaptation {
 public:
  explicit Adaptation(const Flow<Dim>& flow)
      : flow_(flow),
        particles_(flow.state.particles),
        velocity_(as_float4<Dim>(particles_.velocity)),
        directions_(make_directions<Dim>()) {}

  std::vector<Split<Dim>> find_splits() const {
    const std::vector<std::size_t> large = indices_where(particles_.owned, [&](std::size_t i) {
      return is_free(i) && particles_.volume[i] > volume_to_split * wanted_volume(particles_.position[i]);
    });
    std::vector<Split<Dim>> splits;
    for (const std::size_t i : large) {
      const double offset = offset_of_part * edge_of<Dim>(particles_.volume[i]);
      const Vec<Dim> step = offset * widest_gap(i);
      if (!has_room(i, particles_.position[i] + step) || !has_room(i, particles_.position[i] - step)) continue;
      splits.push_back({i, step, velocity_gradient(i) * step});
    }
    return splits;
  }

  std::vector<Merge> find_merges() const {
    std::vector<Merge> merges;
    std::vector<std::uint8_t> is_used(particles_.owned, 0);
    for (std::size_t i = 0; i < particles_.owned; ++i) {  // in order: a particle merges once
      const double wanted = wanted_volume(particles_.position[i]);
      if (is_used[i] != 0 || !is_free(i) || particles_.volume[i] > 0.5 * volume_to_merge_small * wanted) continue;
      const std::size_t j = partner_of(i, is_used);
      if (j == i) continue;
      is_used[i] = is_used[j] = 1;
      merges.push_back({std::min(i, j), std::max(i, j)});
    }
    return merges;
  }

 private:
  /// Whether particle i is water that no part of the flow claims.
  bool is_free(std::size_t i) const { return particles_.is_fluid(i) && flow_.role[i] == Role::water; }

  double wanted_volume(const Vec<Dim>& x) const {
    return power<Dim>(flow_.setup.scale.spacing * flow_.setup.relative_spacing(x));
  }

  /// Whether particle i can go to x: not into a wall, nor to the other side of one without thickness.
  bool has_room(std::size_t i, const Vec<Dim>& x) const {
    const Boundary<Dim>& boundary = flow_.walls.boundary;
    const Vec<Dim>& from = particles_.position[i];
    if (is_hidden<Dim>(boundary.screens, boundary.screens_near(x, (x - from).norm()), from, x)) return false;
    const double distance = min_distance_from_wall * flow_.setup.scale.spacing * flow_.setup.relative_spacing(x);
    return boundary.nearest_to_water(x, distance).face < 0;
  }

  /// The direction along which neighbours count least: sum_j w_j W_ij (e . d_ij/r_ij)^8. Not out of the surface, nor
  /// towards a wall beside the particle.
  Vec<Dim> widest_gap(std::size_t i) const {
    const Pairs<Dim>& pairs = flow_.pairs();
    std::vector<double> filled(directions_.size(), 0.0);
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const double weight = particles_.volume[pairs.j[k]] * pairs.value(i, k);
      const Vec<Dim> e = pairs.e(i, k);
      for (std::size_t n = 0; n < filled.size(); ++n) filled[n] += weight * std::pow(directions_[n].dot(e), 8);
    }
    const auto keep_across = [&](const Vec<Dim>& normal) {
      constexpr double closed = 10.0;  // more than any neighbours add up to
      for (std::size_t n = 0; n < filled.size(); ++n) {
        const double along = directions_[n].dot(normal);
        filled[n] += closed * along * along;
      }
    };
    const Vec<Dim>& crowding = flow_.surroundings.crowding[i];
    if (flow_.surroundings.concentration[i] < surface_concentration && crowding.norm() > 0.0) {
      keep_across(crowding.normalized());
    }
    const NearestWall<Dim> wall = flow_.walls.boundary.nearest_to_water(
        particles_.position[i], split_along_wall * edge_of<Dim>(particles_.volume[i]));
    if (wall.face >= 0) keep_across(flow_.walls.boundary.faces[wall.face].normal);
    return directions_[std::ranges::min_element(filled) - filled.begin()];
  }

  Mat<Dim> velocity_gradient(std::size_t i) const {
    if (flow_.surroundings.concentration[i] < surface_concentration) return Mat<Dim>::Zero();
    const Pairs<Dim>& pairs = flow_.pairs();
    if (pairs.sees_wall[i] != 0) return gradient_in_water<Dim>(pairs, i, velocity_);
    return corrected_gradient<Dim>(pairs, i, unpacked<Dim>(flow_.surroundings.first_moment[i]), velocity_);
  }

  /// The nearest particle with which i may become one; i if there is none. Ghosts are left to the next adaptation.
  std::size_t partner_of(std::size_t i, const std::vector<std::uint8_t>& is_used) const {
    const Pairs<Dim>& pairs = flow_.pairs();
    std::size_t partner = i;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = static_cast<std::size_t>(pairs.j[k]);
      if (j >= particles_.owned || is_used[j] != 0 || !is_free(j)) continue;
      const double r = pairs.r(i, k);
      if (r < least && may_merge(i, j, r)) {
        least = r;
        partner = j;
      }
    }
    return partner;
  }

  bool may_merge(std::size_t i, std::size_t j, double r) const {
    const double volume = particles_.volume[i] + particles_.volume[j];
    if (r > distance_to_merge * edge_of<Dim>(0.5 * volume)) return false;
    const Vec<Dim> middle = centre_of(particles_, i, j);
    const double wanted = wanted_volume(middle);
    const bool is_small = std::min(particles_.volume[i], particles_.volume[j]) < small_volume * wanted;
    return volume <= (is_small ? volume_to_merge_small : volume_to_merge) * wanted && has_room(i, middle) &&
           has_room(j, middle);
  }

  const Flow<Dim>& flow_;
  const Particles<Dim>& particles_;
  std::vector<Float4> velocity_;
  std::vector<Vec<Dim>> directions_;
};

/// Appends the second parts of split particles, with ids from `first_id` on. There must be no ghosts.
template <int Dim>
void split_particles(const std::vector<Split<Dim>>& splits, std::int64_t first_id, Particles<Dim>& particles) {
  const std::size_t before = particles.owned;
  particles.owned += splits.size();
  particles.resize(particles.owned);
  for (std::size_t n = 0; n < splits.size(); ++n) {
    const Split<Dim>& split = splits[n];
    const std::size_t i = split.particle;
    const std::size_t part = before + n;
    particles.volume[i] *= 0.5;
    particles.apply_to_fields([&](auto&... field) { ((field[part] = field[i]), ...); });
    particles.id[part] = first_id + static_cast<std::int64_t>(n);
    particles.position[i] += split.offset;
    particles.position[part] -= split.offset;
    particles.velocity[i] += split.velocity;
    particles.velocity[part] -= split.velocity;
  }
}

/// Gives the kept particles what both have; the others are to be removed.
template <int Dim>
void merge_particles(const std::vector<Merge>& merges, Particles<Dim>& particles) {
  for (const auto [i, j] : merges) {
    const double volume = particles.volume[i] + particles.volume[j];
    const double share = particles.volume[j] / volume;
    particles.position[i] = centre_of(particles, i, j);
    particles.velocity[i] += share * (particles.velocity[j] - particles.velocity[i]);
    particles.pressure[i] = std::lerp(particles.pressure[i], particles.pressure[j], share);
    particles.second_pressure[i] = std::lerp(particles.second_pressure[i], particles.second_pressure[j], share);
    particles.wall_distance[i] = std::min(particles.wall_distance[i], particles.wall_distance[j]);
    particles.volume[i] = volume;
  }
}

/// The ways of the water of particles that are about to split and merge.
template <int Dim>
std::vector<MovedWater<Dim>> find_moved_water(const Flow<Dim>& flow, const std::vector<Split<Dim>>& splits,
                                              const std::vector<Merge>& merges) {
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<MovedWater<Dim>> moved;
  for (const Split<Dim>& split : splits) {
    const Vec<Dim>& x = particles.position[split.particle];
    const double half = 0.5 * flow.water_volume_of(split.particle);
    moved.push_back({x, x + split.offset, half});
    moved.push_back({x, x - split.offset, half});
  }
  for (const auto [i, j] : merges) {
    const Vec<Dim> middle = centre_of(particles, i, j);
    for (const std::size_t n : {i, j}) moved.push_back({particles.position[n], middle, flow.water_volume_of(n)});
  }
  return moved;
}

/// [J]; change of the kinetic energy on this rank.
template <int Dim>
double energy_of(const std::vector<Split<Dim>>& splits, const std::vector<Merge>& merges,
                 const Particles<Dim>& particles, double density) {
  double energy = 0.0;
  for (const Split<Dim>& split : splits) {
    energy += 0.5 * density * particles.volume[split.particle] * split.velocity.squaredNorm();
  }
  for (const auto [i, j] : merges) {
    const double reduced = particles.volume[i] * particles.volume[j] / (particles.volume[i] + particles.volume[j]);
    energy -= 0.5 * density * reduced * (particles.velocity[i] - particles.velocity[j]).squaredNorm();
  }
  return energy;
}

template <int Dim>
void remove_merged(Flow<Dim>& flow, const std::vector<Merge>& merges) {
  std::vector<std::uint8_t> is_removed(flow.state.particles.owned, 0);
  for (const Merge& merge : merges) is_removed[merge.removed] = 1;
  const std::vector<std::size_t> kept =
      indices_where(is_removed.size(), [&](std::size_t i) { return is_removed[i] == 0; });
  flow.neighbourhood->keep(flow.state.particles, std::vector<std::int32_t>(kept.begin(), kept.end()));
}

}  // namespace

template <int Dim>
Json Refinement<Dim>::save() const {
  return {{"next_id", next_id_}, {"splits", splits_}, {"merges", merges_}, {"energy", energy_}};
}

template <int Dim>
bool Refinement<Dim>::restore(const Json& saved) {
  saved.at("next_id").get_to(next_id_);
  saved.at("splits").get_to(splits_);
  saved.at("merges").get_to(merges_);
  saved.at("energy").get_to(energy_);
  return true;
}

template <int Dim>
void Refinement<Dim>::adapt(Flow<Dim>& flow) {
  if (flow.state.step % steps_between != step_of_adaptation) return;
  const Communicator& ranks = flow.setup.ranks;
  std::vector<Split<Dim>> splits;
  std::vector<Merge> merges;
  if (flow.surroundings.are_current && flow.neighbourhood->has_pairs()) {
    const Adaptation<Dim> adaptation(flow);
    splits = adaptation.find_splits();
    merges = adaptation.find_merges();
  }
  Particles<Dim>& particles = flow.state.particles;
  double energy = energy_of(splits, merges, particles, flow.setup.liquid.density);
  const std::vector<std::int64_t> of_ranks = ranks.all_gather(static_cast<std::int64_t>(splits.size()));
  std::int64_t first_id = next_id_;
  for (int rank = 0; rank < ranks.size(); ++rank) {
    if (rank < ranks.rank()) first_id += of_ranks[rank];
    next_id_ += of_ranks[rank];
    splits_ += of_ranks[rank];
  }
  auto merged = static_cast<std::int64_t>(merges.size());
  ranks.sum_each(energy, merged);
  merges_ += merged;
  energy_ += energy;
  if (merged > 0) {
    for (const auto& part : flow.parts) part->reordered(Reordering::removed);
  }
  if (merged + std::reduce(of_ranks.begin(), of_ranks.end()) == 0) return;
  const std::vector<MovedWater<Dim>> moved = find_moved_water(flow, splits, merges);
  for (const auto& part : flow.parts) part->follow_moved_water(flow, moved);
  if (splits.empty() && merges.empty()) return;
  flow.neighbourhood->forget(particles);
  merge_particles(merges, particles);
  split_particles(splits, first_id, particles);
  if (!merges.empty()) remove_merged(flow, merges);
}

template <int Dim>
void Refinement<Dim>::add_to_summary(const Flow<Dim>& /*flow*/, Json& summary) const {
  summary["refinement"] = {{"splits", splits_}, {"merges", merges_}, {"energy_J", energy_}};
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_refinement(const CaseSpec& /*spec*/, const Setup<Dim>& setup,
                                           const Boundary<Dim>& /*boundary*/) {
  if (setup.graded == nullptr) return nullptr;
  return std::make_unique<Refinement<Dim>>(first_id_after_start(setup.graded->field(), setup.first_wall_id));
}

template class Refinement<2>;
template class Refinement<3>;
TAILWATER_IN_2D_AND_3D(make_refinement);

}  // namespace tailwater
