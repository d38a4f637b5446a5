#include "probes/wall_force.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/assert.h"
#include "base/box.h"
#include "base/for_each.h"
#include "case/formulation.h"
#include "geometry/face.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"
#include "motion/wall_motion.h"
#include "probes/chosen_walls.h"
#include "probes/force_memory.h"
#include "probes/force_shares.h"
#include "probes/nearby_parts.h"
#include "probes/patch_shares.h"
#include "probes/places.h"
#include "probes/wall_pressure.h"
#include "walls/patches.h"

namespace tailwater {
namespace {

template <int Dim>
class WallForceProbe {
 public:
  /// `boundary` is as drawn.
  WallForceProbe(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary)
      : about_(probe.moment_about.empty() ? Vec<Dim>(Vec<Dim>::Zero())
                                          : to_vec<Dim>(probe.moment_about, label(probe), "moment_about")),
        age_(age_of_forces(spec)),
        paths_(boundary.walls.size()),
        body_of_(boundary.walls.size(), -1),
        mover_(boundary.walls.size(), -1) {
    const std::vector<WallPatch<Dim>> patches = divide_into_patches<Dim>(spec, boundary);
    chosen_.taken = chosen_shares<Dim>(probe, spec, boundary, patches);
    takes_all_ = std::ranges::all_of(chosen_.taken, [](double share) { return share == 1.0; });
    for (std::size_t wall = 0; wall < paths_.size(); ++wall) {
      if (!boundary.walls[wall].moves()) continue;
      if (const Drive& drive = spec.walls[wall].drive; drive.by == Drive::By::body) {
        body_of_[wall] = static_cast<int>(drive.index);
        mover_[wall] = static_cast<int>(paths_.size() + drive.index);
        continue;
      }
      mover_[wall] = static_cast<int>(wall);
      paths_[wall].emplace(spec, spec.walls[wall], wall_label(boundary, static_cast<int>(wall)));
    }
    for (std::size_t k = 0; k < patches.size(); ++k) {
      has_power_ = has_power_ || (chosen_.taken[k] > 0.0 && moves(boundary.faces[patches[k].face].wall));
    }
  }

  /// Whether one of the chosen walls moves.
  bool has_power() const { return has_power_; }

  /// Collective.
  WallLoads<Dim> read(const ProbeContext<Dim>& context) {
    TAILWATER_ASSERT(context.wall_forces != nullptr && context.patches != nullptr, "the flow finds them for probes");
    TAILWATER_ASSERT(context.patches->all().size() == chosen_.taken.size(), "both divide the walls as drawn");
    follow_patches(context);
    const std::vector<AffineMap<Dim>> velocity = find_velocities(context);
    WallLoads<Dim> loads = sum_over(context.particles.owned, WallLoads<Dim>(), [&](std::size_t i) {
      const WallLoads<Dim> whole = loads_at(context, i);
      if (whole.force().isZero(0.0) || takes_all_and_rests()) return whole;
      if (!takes_all_ && !is_near(context, chosen_.around, context.particles.position[i])) return WallLoads<Dim>();
      return part_of(whole, context, i, velocity, chosen_);
    });
    loads.gather(context.ranks);
    return loads + loads_without_integral(context, velocity, chosen_, -1) +
           loads_of_balanced(context, velocity, chosen_) + loads_beside_walls(context, velocity) +
           loads_of_air(context, velocity);
  }

 private:
  /// Some of the patches, for the part of the loads on them.
  struct Selection {
    std::vector<double> taken;  ///< selected fraction of each patch
    Box<Dim> around = {};       ///< contains all forces of which these patches take some
    NearbyParts<Dim> nearby = {};
  };

  bool moves(std::size_t wall) const { return paths_[wall].has_value() || body_of_[wall] >= 0; }
  bool takes_all_and_rests() const { return takes_all_ && !has_power_; }

  void follow_patches(const ProbeContext<Dim>& context) {
    const bool needs_patches = context.air_pressure != nullptr || !context.wall_forces->beside_walls.empty() ||
                               !context.wall_forces->balanced.empty();
    if (takes_all_and_rests() && !needs_patches) return;
    context.patches->place(context.boundary);
    std::vector<bool> integrated = context.patches->walls_with(context.boundary, context.wall_forces->balanced);
    if (moves_ == context.patches->moves() && integrated_ == integrated) return;
    moves_ = context.patches->moves();
    integrated_ = std::move(integrated);
    chosen_ = select(context, std::move(chosen_.taken));
    selections_.clear();
  }

  static int wall_of(const ProbeContext<Dim>& context, std::size_t patch) {
    return context.boundary.faces[context.patches->all()[patch].face].wall;
  }

  /// The pressure force on a hull can differ from the force of its pairs. Beside another wall the difference has its
  /// reaction on that wall, so the sum over all walls does not change. Collective.
  WallLoads<Dim> loads_beside_walls(const ProbeContext<Dim>& context, const std::vector<AffineMap<Dim>>& velocity) {
    WallLoads<Dim> sum;
    const auto& all = context.wall_forces->beside_walls;
    for (const ForceBesideWall<Dim>& one : all) {
      const auto is_of_hull = [&](int wall) { return std::ranges::find(one.walls, wall) != one.walls.end(); };
      const bool has_hull = takes_all_of(context, is_of_hull);
      const bool has_wall = takes_all_of(context, [&](int wall) { return wall == one.beside; });
      const bool is_beside_hull = std::ranges::any_of(all, [&](const ForceBesideWall<Dim>& other) {
        return std::ranges::find(other.walls, one.beside) != other.walls.end();
      });  // which has a force of its own here
      if (has_hull ? has_wall && !is_beside_hull : !has_wall || is_beside_hull) continue;
      Selection& hull = hull_of(context, one.walls);
      const WallLoads<Dim> known =
          loads_of_pairs(context, velocity, hull, [&](std::size_t i) { return pressure_at(context, i); }) +
          loads_without_integral(context, velocity, hull, one.walls.front()) +
          loads_of_balanced(context, velocity, hull);
      const double sign = has_hull ? 1.0 : -1.0;
      const Vec<Dim> force = one.force - known.pressure;
      const Moment<Dim> about = moment(one.centre, one.force) + one.moment - known.moment;
      const Moment<Dim> about_centre = about - moment(one.centre, force);
      const AffineMap<Dim>& motion = velocity[one.walls.front()];
      sum.pressure += sign * force;
      sum.moment += sign * about;
      if (has_hull) sum.power -= force.dot(motion(one.centre)) + about_centre.dot(angular_velocity_of(motion));
    }
    return sum;
  }

  /// Whether the probe is for all of the walls for which is_part(wall).
  template <class IsPart>
  bool takes_all_of(const ProbeContext<Dim>& context, IsPart&& is_part) const {
    for (std::size_t k = 0; k < chosen_.taken.size(); ++k) {
      if (chosen_.taken[k] < 1.0 && is_part(wall_of(context, k))) return false;
    }
    return true;
  }

  /// All patches of the walls of a hull.
  Selection& hull_of(const ProbeContext<Dim>& context, const std::vector<int>& walls) {
    return selection(context, {walls.front(), false}, [&](std::size_t k) {
      return std::ranges::find(walls, wall_of(context, k)) != walls.end() ? 1.0 : 0.0;
    });
  }

  /// The selection of a key, with these fractions of the patches. It is made once for each place of the walls.
  template <class TakenOf>
  Selection& selection(const ProbeContext<Dim>& context, const std::pair<int, bool>& key, TakenOf&& taken_of) {
    const auto [known, is_new] = selections_.try_emplace(key);
    if (!is_new) return known->second;
    std::vector<double> taken(chosen_.taken.size());
    for (std::size_t k = 0; k < taken.size(); ++k) taken[k] = taken_of(k);
    known->second = select(context, std::move(taken));
    return known->second;
  }

  /// The part of forces of pairs on selected patches; force_at(i) is that through owned particle i. Collective.
  template <class ForceAt>
  WallLoads<Dim> loads_of_pairs(const ProbeContext<Dim>& context, const std::vector<AffineMap<Dim>>& velocity,
                                Selection& selection, ForceAt&& force_at) {
    WallLoads<Dim> loads = sum_over(context.particles.owned, WallLoads<Dim>(), [&](std::size_t i) {
      WallLoads<Dim> whole;
      whole.pressure = force_at(i);
      const bool is_part_of_it =
          !whole.pressure.isZero(0.0) && is_near(context, selection.around, context.particles.position[i]);
      return is_part_of_it ? part_of(whole, context, i, velocity, selection) : WallLoads<Dim>();
    });
    loads.gather(context.ranks);
    return loads;
  }

  /// The loads of the pairs of the balanced pressure on selected patches of walls without its integral. Collective.
  WallLoads<Dim> loads_without_integral(const ProbeContext<Dim>& context, const std::vector<AffineMap<Dim>>& velocity,
                                        const Selection& whole, int hull) {
    const std::vector<Vec<Dim>>& forces = context.wall_forces->of_balanced;
    if (forces.empty()) return {};
    Selection& rest = selection(context, {hull, true},
                                [&](std::size_t k) { return integrated_[wall_of(context, k)] ? 0.0 : whole.taken[k]; });
    return loads_of_pairs(context, velocity, rest, [&](std::size_t i) { return forces[i]; });
  }

  /// The loads of the pressure that balances the weight on the selected patches; the same on all ranks.
  WallLoads<Dim> loads_of_balanced(const ProbeContext<Dim>& context, const std::vector<AffineMap<Dim>>& velocity,
                                   const Selection& selection) const {
    WallLoads<Dim> loads;
    const std::vector<double>& balanced = context.wall_forces->balanced;
    const WettedPatches<Dim>& wetted = context.patches->wetted();
    for (std::size_t k = 0; k < balanced.size(); ++k) {
      const WallPatch<Dim>& patch = context.patches->all()[k];
      const double area = selection.taken[k] * wetted.share(static_cast<std::int32_t>(k)) * patch.measure;
      if (area == 0.0 || balanced[k] == 0.0) continue;
      const WallFace<Dim>& face = context.boundary.faces[patch.face];
      const Vec<Dim> force = -balanced[k] * area * face.normal;
      Vec<Dim> x = wetted.centres()[k];
      loads.pressure += force;
      if (moves(face.wall)) {
        const Vec<Dim> wall_velocity = velocity[face.wall](x);
        loads.power -= force.dot(wall_velocity);
        x -= age_ * context.dt * wall_velocity;
      }
      loads.moment += moment(x, force);
    }
    return loads;
  }

  /// For each wall, the map from a place on it to its velocity there when the forces act: the mean over a time of the
  /// step's length around that instant.
  std::vector<AffineMap<Dim>> find_velocities(const ProbeContext<Dim>& context) const {
    std::vector<AffineMap<Dim>> maps(paths_.size(), {Mat<Dim>::Zero(), Vec<Dim>::Zero()});
    for (std::size_t wall = 0; wall < paths_.size(); ++wall) {
      if (body_of_[wall] >= 0) {
        const BodyState<Dim>& body = context.bodies[body_of_[wall]];
        for (int d = 0; d < Dim; ++d) {
          maps[wall].linear.put_column(d, velocity_about<Dim>(body.angular_velocity(), Vec<Dim>::Unit(d)));
        }
        maps[wall].constant = body.linear_velocity() - maps[wall].linear * body.centre;
      }
      if (!paths_[wall] || context.dt == 0.0) continue;
      const AffineMap<Dim> now = paths_[wall]->at(context.time);
      const double from = std::max(0.0, context.time - (age_ + 0.5) * context.dt);
      const AffineMap<Dim> of_drawn = paths_[wall]->mean_velocity(from, context.time - (age_ - 0.5) * context.dt);
      maps[wall].linear = of_drawn.linear * now.linear.transpose();
      maps[wall].constant = of_drawn.constant - maps[wall].linear * now.constant;
    }
    return maps;
  }

  /// The loads of pockets of air on the selected patches beside them, as far as these are in front of all other walls;
  /// the same on all ranks. Collective.
  WallLoads<Dim> loads_of_air(const ProbeContext<Dim>& context, const std::vector<AffineMap<Dim>>& velocity) const {
    WallLoads<Dim> loads;
    if (!context.air_pressure) return loads;
    std::vector<double> taken = chosen_.taken;
    const WettedPatches<Dim>& wetted = context.patches->wetted();
    for (std::size_t k = 0; k < taken.size(); ++k) taken[k] *= wetted.share(static_cast<std::int32_t>(k));
    for (const AirPush<Dim>& push : pushes_of_air<Dim>(context, context.patches->all(), taken)) {
      loads.pressure += push.force;
      loads.moment += moment(push.centre, push.force);
      loads.power -= push.force.dot(velocity[push.wall](push.centre));
    }
    return loads;
  }

  Moment<Dim> moment(const Vec<Dim>& x, const Vec<Dim>& force) const { return moment_of<Dim>(x - about_, force); }

  /// All loads through owned particle i. The moment of friction is taken from the wall itself. Pressure acts across the
  /// wall, so its moment is the same from the particle as from the wall.
  WallLoads<Dim> loads_at(const ProbeContext<Dim>& context, std::size_t i) const {
    WallLoads<Dim> loads;
    loads.pressure = pressure_at(context, i);
    loads.friction = context.wall_forces->friction[i];
    const Vec<Dim>& x = context.particles.position[i];
    if (!loads.pressure.isZero(0.0)) loads.moment += moment(x, loads.pressure);
    if (!loads.friction.isZero(0.0)) loads.moment += moment(foot(context, x), loads.friction);
    return loads;
  }

  static Vec<Dim> pressure_at(const ProbeContext<Dim>& context, std::size_t i) {
    return context.wall_forces->pressure[i] + context.wall_forces->through_water[i];
  }

  Vec<Dim> foot(const ProbeContext<Dim>& context, const Vec<Dim>& x) const {
    const NearestWall<Dim> wall = context.boundary.nearest(x, context.patches->wetted().reach());
    return wall.face < 0 ? x : wall.point;
  }

  /// The part of the loads through particle i on selected patches. Those on walls that move are taken where the walls
  /// were when the forces acted.
  WallLoads<Dim> part_of(const WallLoads<Dim>& whole, const ProbeContext<Dim>& context, std::size_t i,
                         const std::vector<AffineMap<Dim>>& velocity, Selection& selection) {
    using Kind = NearbyPart::Kind;
    const Vec<Dim>& x = context.particles.position[i];
    const WettedPatches<Dim>& wetted = context.patches->wetted();
    const auto wall_of = [&](std::int32_t k) { return WallForceProbe::wall_of(context, k); };
    const auto mover_of = [&](std::int32_t k) { return mover_[wall_of(k)]; };
    const double finest = context.spacing_field == nullptr ? 1.0 : context.spacing_field->finest();
    const NearbyPart nearby = selection.nearby.at(x, wetted, finest * wetted.reach(), selection.taken, mover_of);
    const bool takes_all = &selection == &chosen_ && takes_all_;
    WallLoads<Dim> loads;
    if (nearby.kind == Kind::none && !takes_all) return loads;
    const Vec<Dim> on_wall = whole.friction.isZero(0.0) ? x : foot(context, x);
    const auto add = [&](int wall, const Vec<Dim>& pressure, const Vec<Dim>& friction) {
      if (!has_power_ || !moves(wall)) return;
      // Friction acts on the wall itself. Pressure acts across it, so its power is the same from the particle.
      for (const auto& [force, place] : {std::pair(pressure, x), std::pair(friction, on_wall)}) {
        loads.power -= force.dot(velocity[wall](place));
        loads.moment -= moment_of<Dim>(age_ * context.dt * velocity[wall](place), force);  // where the wall was
      }
    };
    if (nearby.kind == Kind::all) {
      loads.pressure = whole.pressure;
      loads.friction = whole.friction;
      add(wall_of(nearby.patch), whole.pressure, whole.friction);
    } else {
      const auto [all, chosen] = shares_.find(wetted, x, context.relative_spacing(x) * wetted.reach(),
                                              context.particles.is_fluid(i), selection.taken, has_power_);
      if (all.of_pressure.weight == 0.0) return takes_all ? whole : loads;
      const Vec<Dim> pressure = all.of_pressure.across_inverse(whole.pressure);
      const Vec<Dim> friction = all.of_friction.along_inverse(whole.friction);
      loads.pressure = chosen.of_pressure.across() * pressure;
      loads.friction = chosen.of_friction.along() * friction;
      for (const auto& near : shares_.list()) {
        if (!moves(wall_of(near.patch))) continue;
        Sharing<Dim> share;
        share.of_pressure.add(selection.taken[near.patch] * near.of_pressure, near.normal);
        share.of_friction.add(selection.taken[near.patch] * near.of_friction, near.normal);
        add(wall_of(near.patch), share.of_pressure.across() * pressure, share.of_friction.along() * friction);
      }
    }
    loads.moment += moment(x, loads.pressure) + moment(on_wall, loads.friction);
    return loads;
  }

  static bool is_near(const ProbeContext<Dim>& context, const Box<Dim>& around, const Vec<Dim>& x) {
    bool is_near = false;
    context.patches->wetted().visit_images_of(
        x, [&](const Vec<Dim>& image) { is_near = is_near || around.contains(image); });
    return is_near;
  }

  static Selection select(const ProbeContext<Dim>& context, std::vector<double> taken) {
    const WettedPatches<Dim>& wetted = context.patches->wetted();
    Selection selection{std::move(taken)};
    for (std::size_t k = 0; k < selection.taken.size(); ++k) {
      if (selection.taken[k] > 0.0) selection.around.extend(wetted.centres()[k]);
    }
    selection.around.widen(wetted.reach());
    return selection;
  }

  Selection chosen_;
  bool takes_all_ = false;
  Vec<Dim> about_;
  double age_;                                       ///< of forces (age_of_forces)
  std::vector<std::optional<WallPath<Dim>>> paths_;  ///< of the walls that move as prescribed
  std::vector<int> body_of_;                         ///< the floating body of each wall, or -1
  bool has_power_ = false;
  std::optional<std::size_t> moves_;  ///< of the walls, where the patches were selected
  std::vector<bool> integrated_;      ///< by wall, whether it had the integral of the balanced pressure there
  std::vector<int> mover_;            ///< of each wall: a number, equal for walls that move alike; -1: it rests
  /// By the first wall of a hull, or -1 for the chosen patches, and whether those with the integral are left out: the
  /// patches where they are now.
  std::map<std::pair<int, bool>, Selection> selections_;
  PatchShares<Dim> shares_;  ///< of the particle that is being read
};

/// Throws CaseError where the forces between particles are not equal and opposite.
void require_reactions(const ProbeTable& probe, const CaseSpec& spec) {
  const std::string_view why = traits_of(spec).no_reaction;
  if (why.empty()) return;
  throw CaseError("force-needs-robust",
                  {"{} = \"force\" does not go with this formulation: {}", label(probe).with_key("type"), why},
                  {"choose scheme.formulation = \"robust\", or measure with type = \"wall-pressure-mean\""});
}

}  // namespace

template <int Dim>
Reading<Dim> force_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  require_reactions(probe, spec);
  const auto walls = std::make_shared<WallForceProbe<Dim>>(probe, spec, boundary);
  const auto memory = std::make_shared<std::vector<double>>(ForceMemory<Dim>::count, 0.0);
  const bool has_moment = !probe.moment_about.empty();
  Reading<Dim> reading;
  reading.columns = columns_of(probe, Dim, walls->has_power());
  reading.take = [walls, memory, has_moment](const ProbeContext<Dim>& context) -> std::vector<Row> {
    const WallLoads<Dim> loads = walls->read(context);
    const Vec<Dim> force = loads.force();
    ForceMemory<Dim>{*memory}.add(context.time, force);
    Row row;
    for (const Vec<Dim>& vector : {force, loads.pressure, loads.friction}) {
      row.insert(row.end(), vector.begin(), vector.end());
    }
    if (has_moment) row.insert(row.end(), loads.moment.begin(), loads.moment.end());
    if (walls->has_power()) row.push_back(loads.power);
    return {row};
  };
  reading.memory = memory;
  reading.totals = [memory] { return ForceMemory<Dim>{*memory}.totals(); };
  return reading;
}

TAILWATER_IN_2D_AND_3D(force_reading);

}  // namespace tailwater
