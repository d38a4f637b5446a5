#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "checks/checks.h"
#include "checks/collision.h"
#include "checks/room_for_water.h"
#include "geometry/from_spec.h"
#include "motion/wall_motion.h"

namespace tailwater {
namespace {

/// m/s; a tenth of the speed of sound in water.
constexpr double largest_wall_speed = 150.0;

/// Least number of samples of a path, even where it does not seem to move.
constexpr int least_samples = 2000;

/// Pieces of the paths that are followed at most: 10 km at dx = 0.08 m, in less than a second.
constexpr int most_pieces = 500'000;

/// Follows the walls from the start to the end and checks them every dx/4 of their way.
template <int Dim>
class PathWalk {
 public:
  PathWalk(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid,
           const std::vector<int>& moving)
      : drawn_(drawn),
        dx_(spec.particles.spacing),
        moving_(moving.begin(), moving.end()),
        faces_(drawn.faces),
        faces_before_(drawn.faces) {
    for (std::size_t w = 0; w < spec.walls.size(); ++w) {
      paths_.emplace_back(spec, spec.walls[w], wall_label(drawn, static_cast<int>(w)));
    }
    places_ = places_of_room_ = places_at(0.0);
    // The room is unknown if water may leave or enter through an open end, or if a moving wall is not followed.
    const auto all = std::ranges::count_if(drawn.walls, [](const WallProperties& wall) { return wall.moves(); });
    const bool is_known = spec.inlets.empty() && spec.outlets.empty() && static_cast<std::size_t>(all) == moving.size();
    if (is_known && fluid.all > 0) room_.emplace(spec, drawn, fluid);
  }

  Findings findings(double end) {
    look_for_collisions(0.0);
    for (int k = 0; k < least_samples; ++k) {
      if (pieces_ > most_pieces) {
        findings_.push_back(
            Finding::warning("the walls move so far that their paths were followed only to t = {:.6g} s: what they "
                             "meet later is not known",
                             end * k / least_samples));
        break;
      }
      follow(end * k / least_samples, end * (k + 1) / least_samples);
      if (room_) look_for_room(end * (k + 1) / least_samples);
    }
    return std::move(findings_);
  }

 private:
  std::string label(int wall) const { return wall_label(drawn_, wall); }

  std::vector<AffineMap<Dim>> places_at(double time) const {
    std::vector<AffineMap<Dim>> places(paths_.size());
    for (const int wall : moving_) places[wall] = paths_[wall].at(time);
    return places;
  }

  /// The corner of a wall that moves farthest between two places of the wall, and how far it moves.
  std::pair<Vec<Dim>, double> farthest(int wall, const AffineMap<Dim>& before, const AffineMap<Dim>& after) const {
    std::pair<Vec<Dim>, double> result{Vec<Dim>::Zero(), 0.0};
    for (const WallFace<Dim>& face : drawn_.faces) {
      if (face.wall != wall) continue;
      for (const Vec<Dim>& corner : face.corners) {
        const double way = (after(corner) - before(corner)).norm();
        if (!(way <= result.second)) result = {before(corner), way};  // also if it is not a number
      }
    }
    return result;
  }

  /// Returns whether a wall may move by `length` (m) between two times. If not, adds an error and stops following the
  /// wall.
  bool accepts_way(int wall, const Vec<Dim>& where, double length, double from, double to) {
    if (!std::isfinite(length)) {
      findings_.push_back(Finding::error(
          "{} is at no finite place at t = {:.6g} s: correct its displacement or rotation", label(wall), to));
    } else if (length > 0.25 * dx_ && length > largest_wall_speed * (to - from)) {
      findings_.push_back(Finding::error(
          "{} is too fast: its point {} moves {:.3g} m in the {:.3g} s after t = {:.6g} s, but water is treated as "
          "incompressible, which limits walls to {:.0f} m/s; correct its displacement or rotation",
          label(wall), place(where), length, to - from, from, largest_wall_speed));
    } else {
      return true;
    }
    moving_.erase(wall);
    return false;
  }

  void follow(double from, double to) {
    if (++pieces_ > most_pieces) return;
    const std::vector<AffineMap<Dim>> start = places_at(from);
    const std::vector<AffineMap<Dim>> end = places_at(to);
    double longest = 0.0;
    bool is_far = false;
    for (const int wall : std::vector<int>(moving_.begin(), moving_.end())) {
      const auto [where, way] = farthest(wall, start[wall], end[wall]);
      if (!accepts_way(wall, where, way, from, to)) continue;
      longest = std::max(longest, way);
      is_far = is_far || farthest(wall, places_[wall], end[wall]).second > 0.25 * dx_;
    }
    if (longest > 0.25 * dx_) {
      follow(from, 0.5 * (from + to));
      follow(0.5 * (from + to), to);
    } else if (is_far) {
      places_ = end;
      faces_before_ = faces_;
      for (std::size_t f = 0; f < drawn_.faces.size(); ++f) {
        faces_[f] = moved(places_[drawn_.faces[f].wall], drawn_.faces[f]);
      }
      look_for_collisions(to);
    }
  }

  void look_for_collisions(double time) {
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const int wall = faces_[f].wall;
      if (!moving_.contains(wall)) continue;
      for (std::size_t other = 0; other < faces_.size(); ++other) {
        const int other_wall = faces_[other].wall;
        const std::pair<int, int> walls = std::minmax(wall, other_wall);
        if (drawn_.walls[wall].body == drawn_.walls[other_wall].body || collided_.contains(walls)) continue;
        const auto found = collision(faces_[f], faces_[other], faces_before_[f], faces_before_[other], dx_);
        if (!found) continue;
        collided_.insert(walls);
        findings_.push_back(
            found->is_crossing
                ? Finding::error("{} crosses {} at t = {:.6g} s at {}: change its path, or draw it shorter",
                                 label(wall), label(other_wall), time, place(found->where))
                : Finding::error("{} comes nearer than a spacing to {} at t = {:.6g} s at {}: the water between them "
                                 "would be crushed; end its path at least {:.6g} m before",
                                 label(wall), label(other_wall), time, place(found->where), dx_));
      }
    }
  }

  /// Checks that the water has room, each time a wall has moved by dx; not after an error.
  void look_for_room(double time) {
    const auto has_moved = [&](int wall) { return farthest(wall, places_of_room_[wall], places_[wall]).second > dx_; };
    if (!findings_.empty() || !std::ranges::any_of(moving_, has_moved)) return;
    std::vector<AffineMap<Dim>> way;
    for (const WallFace<Dim>& face : faces_) {
      way.push_back(way_between(places_of_room_[face.wall], places_[face.wall]));
    }
    room_->move(faces_, way);
    places_of_room_ = places_;
    const auto enclosed = room_->enclosed();
    if (!enclosed || enclosed->volume >= room_->water()) return;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const int wall = faces_[f].wall;
      if (!enclosed->walls[f] || !drawn_.walls[wall].moves()) continue;
      Vec<Dim> middle = Vec<Dim>::Zero();
      for (const Vec<Dim>& corner : faces_[f].corners) middle += corner / Dim;
      findings_.push_back(Finding::error(
          "{} crushes the water at t = {:.6g} s, when it is at {}: the walls leave {:.3g} m^{} to {:.3g} m^{} of water "
          "that cannot get out; end its path before, or leave the water a way out",
          label(wall), time, place(middle), enclosed->volume, Dim, room_->water(), Dim));
      return;
    }
  }

  const Boundary<Dim>& drawn_;
  double dx_;
  std::vector<WallPath<Dim>> paths_;
  std::set<int> moving_;                        ///< walls without an error of their own so far
  std::vector<AffineMap<Dim>> places_;          ///< of the walls at the last check
  std::vector<WallFace<Dim>> faces_;            ///< at the last check
  std::vector<WallFace<Dim>> faces_before_;     ///< at the check before it
  std::set<std::pair<int, int>> collided_;      ///< walls whose collision is reported
  std::optional<RoomForWater<Dim>> room_;       ///< none if it is unknown
  std::vector<AffineMap<Dim>> places_of_room_;  ///< of the walls at the last check of the room
  int pieces_ = 0;                              ///< followed so far
  Findings findings_;
};

}  // namespace

template <int Dim>
Findings check_paths(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid,
                     const std::vector<int>& moving) {
  // The last time step may pass the end.
  const double end = spec.time.end * (1.0 + 1.0 / least_samples);
  return PathWalk<Dim>(spec, drawn, fluid, moving).findings(end);
}

template Findings check_paths(const CaseSpec&, const Boundary<2>&, const FluidParticles<2>&, const std::vector<int>&);
template Findings check_paths(const CaseSpec&, const Boundary<3>&, const FluidParticles<3>&, const std::vector<int>&);

}  // namespace tailwater
