#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "base/box.h"
#include "checks/checks.h"
#include "checks/collision.h"
#include "checks/room_for_water.h"
#include "geometry/from_spec.h"
#include "geometry/largest_speed.h"
#include "geometry/wall_label.h"
#include "motion/wall_motion.h"

namespace tailwater {
namespace {

/// Minimum number of samples of a path, even where it does not seem to move.
constexpr int min_samples = 2000;

/// Maximum cost of following the paths, in evaluations of the place of a wall: 10 km of one wall at dx = 0.01 m. It
/// takes some seconds.
constexpr double max_looks = 4e6;

constexpr double looks_per_letter = 0.01;    ///< per letter of an expression
constexpr double looks_per_corner = 0.01;    ///< per corner of a wall
constexpr double looks_per_collision = 0.1;  ///< per pair of faces

/// A moving wall, as drawn.
template <int Dim>
struct Mover {
  int wall;
  WallPath<Dim> path;
  std::vector<int> faces;         ///< indices into Boundary::faces
  std::vector<Vec<Dim>> corners;  ///< corners of the faces, each once
  double looks;                   ///< cost of one evaluation
  bool is_followed = true;        ///< no error of its own so far
};

template <int Dim>
Mover<Dim> make_mover(const CaseSpec& spec, const Boundary<Dim>& drawn, int wall) {
  const WallTable& table = spec.walls[wall];
  Mover<Dim> mover{wall, WallPath<Dim>(spec, table, wall_label(drawn, wall)), {}, {}, 1.0};
  const auto is_before = [](const Vec<Dim>& a, const Vec<Dim>& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::set<Vec<Dim>, decltype(is_before)> known(is_before);
  for (int f = 0; f < static_cast<int>(drawn.faces.size()); ++f) {
    if (drawn.faces[f].wall != wall) continue;
    mover.faces.push_back(f);
    for (const Vec<Dim>& corner : drawn.faces[f].corners) {
      if (known.insert(corner).second) mover.corners.push_back(corner);
    }
  }
  const auto letters = [](const Varying& value) {
    const auto* text = std::get_if<std::string>(&value);
    return text == nullptr ? 0.0 : static_cast<double>(text->size());
  };
  double length = letters(table.rotation);
  for (const Varying& component : table.displacement) length += letters(component);
  mover.looks += looks_per_letter * length + looks_per_corner * static_cast<double>(mover.corners.size());
  return mover;
}

/// Follows the walls from the start to the end and checks them every dx/4 of their displacement.
template <int Dim>
class PathWalk {
 public:
  PathWalk(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid,
           const std::vector<int>& moving)
      : drawn_(drawn),
        dx_(spec.particles.spacing),
        faces_(drawn.faces),
        faces_before_(drawn.faces),
        faces_of_(drawn.walls.size()),
        boxes_(drawn.walls.size()) {
    for (const int wall : moving) movers_.push_back(make_mover(spec, drawn, wall));
    for (const WallTable& wall : spec.walls) floats_.push_back(wall.drive.by == Drive::By::body);
    for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
      faces_of_[faces_[f].wall].push_back(f);
      boxes_[faces_[f].wall].extend(faces_[f].box());
    }
    places_ = places_of_water_ = places_at(0.0);
    // The space is unknown if water may leave or enter through an open end, or if a moving wall is not followed.
    const auto all = std::ranges::count_if(drawn.walls, [](const WallProperties& wall) { return wall.moves(); });
    const bool is_known = spec.inlets.empty() && spec.outlets.empty() && static_cast<std::size_t>(all) == moving.size();
    if (is_known && fluid.all > 0) room_.emplace(spec, drawn, fluid);
  }

  Findings findings(double end) {
    look_for_collisions(0.0);
    Places before = places_at(0.0);
    for (int k = 0; k < min_samples; ++k) {
      if (looks_ > max_looks) {
        findings_.push_back(
            Finding::warning("path-checked-in-part",
                             {"{} or another wall moves so far that collisions are only checked up to t = {:.6g}",
                              label(movers_.front().wall), Amount{end * k / min_samples, "s"}},
                             {"check the paths after that time by eye"}));
        break;
      }
      const double to = end * (k + 1) / min_samples;
      Places after = places_at(to);
      follow(end * k / min_samples, before, to, after);
      if ((room_ || !drawn_.ends.empty()) && has_moved()) look_at_water(to);
      before = std::move(after);
    }
    return std::move(findings_);
  }

 private:
  using Places = std::vector<AffineMap<Dim>>;  ///< by mover

  CaseLabel label(int wall) const { return wall_label(drawn_, wall); }

  Places places_at(double time) {
    Places places(movers_.size());
    for (std::size_t m = 0; m < movers_.size(); ++m) {
      if (!movers_[m].is_followed) continue;
      places[m] = movers_[m].path.at(time);
      looks_ += movers_[m].looks;
    }
    return places;
  }

  /// The corner of a wall that moves farthest between two places of the wall, and its displacement.
  std::pair<Vec<Dim>, double> farthest(const Mover<Dim>& mover, const AffineMap<Dim>& before,
                                       const AffineMap<Dim>& after) const {
    std::pair<Vec<Dim>, double> result{Vec<Dim>::Zero(), 0.0};
    for (const Vec<Dim>& corner : mover.corners) {
      const double displacement = (after(corner) - before(corner)).norm();
      if (!(displacement <= result.second)) result = {before(corner), displacement};  // also if it is not a number
    }
    return result;
  }

  /// Returns whether a wall may move by `length` (m) between two times. If not, adds an error and stops following the
  /// wall.
  bool accepts_displacement(Mover<Dim>& mover, const Vec<Dim>& where, double length, double from, double to) {
    if (!std::isfinite(length)) {
      findings_.push_back(Finding::error("path-not-finite",
                                         {"{} is at no finite place at t = {:.6g}", label(mover.wall), Amount{to, "s"}},
                                         {"correct its displacement or rotation"}));
    } else if (length > 0.25 * dx_ && length > largest_speed_of_case * (to - from)) {
      findings_.push_back(Finding::error(
          "wall-too-fast",
          {"{} is too fast: its point {} moves {:.3g} in the {:.3g} s after t = {:.6g} s, but water is treated as "
           "incompressible, which limits walls to {:.0f} m/s",
           label(mover.wall), place(where), Amount{length, "m"}, to - from, from, largest_speed_of_case},
          {"correct its displacement or rotation"}));
    } else {
      return true;
    }
    mover.is_followed = false;
    return false;
  }

  void follow(double from, const Places& start, double to, const Places& end) {
    if (looks_ > max_looks) return;
    double longest = 0.0;
    bool is_far = false;
    for (std::size_t m = 0; m < movers_.size(); ++m) {
      if (!movers_[m].is_followed) continue;
      const auto [where, displacement] = farthest(movers_[m], start[m], end[m]);
      if (!accepts_displacement(movers_[m], where, displacement, from, to)) continue;
      longest = std::max(longest, displacement);
      is_far = is_far || farthest(movers_[m], places_[m], end[m]).second > 0.25 * dx_;
    }
    if (longest > 0.25 * dx_) {
      const double middle = 0.5 * (from + to);
      const Places half = places_at(middle);
      follow(from, start, middle, half);
      follow(middle, half, to, end);
    } else if (is_far) {
      move_to(end);
      look_for_collisions(to);
    }
  }

  void move_to(const Places& places) {
    places_ = places;
    for (std::size_t m = 0; m < movers_.size(); ++m) {
      Box<Dim>& box = boxes_[movers_[m].wall];
      box = {};
      for (const int f : movers_[m].faces) {
        faces_before_[f] = faces_[f];
        // A wall that is no longer followed counts at its drawn place.
        faces_[f] = movers_[m].is_followed ? moved(places_[m], drawn_.faces[f]) : drawn_.faces[f];
        box.extend(faces_[f].box());
      }
    }
  }

  void look_for_collisions(double time) {
    for (const Mover<Dim>& mover : movers_) {
      if (!mover.is_followed) continue;
      const int wall = mover.wall;
      for (int other = 0; other < static_cast<int>(boxes_.size()); ++other) {
        if (drawn_.walls[wall].body == drawn_.walls[other].body) continue;
        if (time > 0.0 && (floats_[wall] || floats_[other])) continue;  // a floating body gives way
        if (boxes_[other].isEmpty() || boxes_[wall].exteriorDistance(boxes_[other]) > dx_) continue;
        if (!collided_.contains(std::minmax(wall, other))) look_for_collision(wall, other, time);
      }
    }
  }

  void look_for_collision(int wall, int other, double time) {
    for (const int f : faces_of_[wall]) {
      for (const int g : faces_of_[other]) {
        looks_ += looks_per_collision;
        const auto found = collision(faces_[f], faces_[g], faces_before_[f], faces_before_[g], dx_);
        if (!found) continue;
        collided_.insert(std::minmax(wall, other));
        findings_.push_back(
            found->is_crossing ? Finding::error("walls-cross",
                                                {"{} crosses {} at t = {:.6g} at {}", label(wall), label(other),
                                                 Amount{time, "s"}, place(found->where)},
                                                {"change its path, or draw it shorter"})
                               : Finding::error("walls-closer-than-spacing",
                                                {"{} comes closer than a spacing to {} at t = {:.6g} at {}: the water "
                                                 "between them would be compressed",
                                                 label(wall), label(other), Amount{time, "s"}, place(found->where)},
                                                {"end its path at least {:.6g} m before, where some water still "
                                                 "passes, or draw it with shape = \"plate\", which may end on the wall",
                                                 dx_}));
        return;
      }
    }
  }

  /// Whether a wall has moved by dx since the last look at the water.
  bool has_moved() const {
    for (std::size_t m = 0; m < movers_.size(); ++m) {
      if (movers_[m].is_followed && farthest(movers_[m], places_of_water_[m], places_[m]).second > dx_) return true;
    }
    return false;
  }

  void look_at_water(double time) {
    const bool has_error =
        std::ranges::any_of(findings_, [](const Finding& finding) { return finding.severity == Severity::error; });
    if (has_error) return;
    if (room_) look_for_room(time);
    if (!drawn_.ends.empty()) look_for_gaps();
    places_of_water_ = places_;
  }

  /// Checks that no end of a moving wall comes off the wall that closes it. A wall with water on one side only does not
  /// hold the water that gets behind it there.
  void look_for_gaps() {
    Boundary<Dim> boundary = drawn_;
    boundary.faces = faces_;
    boundary.hang_screens();
    for (std::size_t e = 0; e < drawn_.ends.size(); ++e) {
      const WallEnd& end = boundary.ends[e];
      const int wall = faces_[end.face].wall;
      const bool opens = end.is_free && !drawn_.ends[e].is_free && !end.is_at_plate && !floats_[wall];
      if (!opens || !drawn_.walls[wall].moves() || !opened_.insert(wall).second) continue;
      findings_.push_back(Finding::warning(
          "wall-comes-off",
          {"{} comes off another wall as it moves, at its end {}: water can get behind it there, and nothing holds "
           "this water",
           label(wall), place(drawn_.faces[end.face].corners[end.corner])},
          {"draw the wall longer there (as the side of a block), with shape = \"plate\", or with two faces"}));
    }
  }

  /// Checks that the water has enough space.
  void look_for_room(double time) {
    std::vector<AffineMap<Dim>> displacement(faces_.size());
    for (std::size_t m = 0; m < movers_.size(); ++m) {
      for (const int f : movers_[m].faces) displacement[f] = displacement_between(places_of_water_[m], places_[m]);
    }
    room_->move(faces_, displacement);
    const auto enclosed = room_->enclosed();
    if (!enclosed || enclosed->volume >= room_->water()) return;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const int wall = faces_[f].wall;
      if (!enclosed->walls[f] || !drawn_.walls[wall].moves()) continue;
      Vec<Dim> middle = Vec<Dim>::Zero();
      for (const Vec<Dim>& corner : faces_[f].corners) middle += corner / Dim;
      findings_.push_back(Finding::error(
          "wall-crushes-water",
          {"{} crushes the water at t = {:.6g}, when it is at {}: the walls leave a space of {:.3g} m^{} "
           "for {:.3g} m^{} of water that cannot leave",
           label(wall), Amount{time, "s"}, place(middle), enclosed->volume, Dim, room_->water(), Dim},
          {"end its path before, or leave the water a way out"}));
      return;
    }
  }

  const Boundary<Dim>& drawn_;
  double dx_;
  std::vector<Mover<Dim>> movers_;
  Places places_;                            ///< of the walls at the last check
  std::vector<WallFace<Dim>> faces_;         ///< at the last check
  std::vector<WallFace<Dim>> faces_before_;  ///< at the check before it
  std::vector<std::vector<int>> faces_of_;   ///< by wall
  std::vector<bool> floats_;                 ///< by wall; whether it is of a floating body
  std::vector<Box<Dim>> boxes_;              ///< around each wall at the last check
  std::set<std::pair<int, int>> collided_;   ///< walls whose collision is reported
  std::set<int> opened_;                     ///< walls whose end has come off another wall, which is reported
  std::optional<RoomForWater<Dim>> room_;    ///< none if the space is unknown
  Places places_of_water_;                   ///< of the walls at the last look at the water
  double looks_ = 0.0;                       ///< so far
  Findings findings_;
};

}  // namespace

template <int Dim>
Findings check_paths(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid,
                     const std::vector<int>& moving) {
  // The last time step may pass the end.
  const double end = spec.time.end * (1.0 + 1.0 / min_samples);
  return PathWalk<Dim>(spec, drawn, fluid, moving).findings(end);
}

TAILWATER_IN_2D_AND_3D(check_paths);

}  // namespace tailwater
