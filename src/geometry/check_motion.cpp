#include "geometry/check_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "base/fp_traps.h"
#include "geometry/cell_space.h"
#include "geometry/from_spec.h"
#include "geometry/wall_motion.h"

namespace tailwater {
namespace {

/// m/s; a tenth of the speed of sound in water.
constexpr double largest_wall_speed = 150.0;

/// A path is looked at this often at least, also where it does not seem to move.
constexpr int least_samples = 2000;

/// Walls that close at less than 45 degrees crush; others push the water out of the wedge.
constexpr double least_facing = 0.7;

/// The room that the walls leave to the water, where it cannot get out.
template <int Dim>
class Room {
 public:
  Room(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid)
      : space_(spec, drawn.faces, fluid.position, most_cells),
        water_(static_cast<double>(fluid.position.size()) * std::pow(spec.particles.spacing, Dim)) {
    Vec<Dim> down = to_vec<Dim>(spec.physics.gravity, "[physics]", "gravity");
    if (down.norm() > 0.0) down.normalize();
    Spread<Dim> rest = spread(space_, cells_of<Dim>(space_, fluid.position), down);
    if (!rest.way_out) wet_ = std::move(rest.cells);
  }

  double water() const { return water_; }  ///< m^Dim

  /// Walls have moved, each face by its `way`: cells that one has passed over hold no water any more.
  void move(std::vector<WallFace<Dim>> faces, const std::vector<AffineMap<Dim>>& way) {
    std::vector<bool> is_passed(space_.count(), false);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (way[f].linear == Mat<Dim>::Identity() && way[f].constant == Vec<Dim>::Zero()) continue;
      const WallFace<Dim>& before = space_.faces()[f];
      const AffineMap<Dim> back = way_between(way[f], {});
      space_.visit_around(before, faces[f], [&](const auto& cell) {
        // As seen from the wall, it is the cell that moves.
        const Vec<Dim> x = space_.centre(cell);
        if (space_.passes(before, x, back(x))) is_passed[space_.index(cell)] = true;
      });
    }
    std::erase_if(wet_, [&](const auto& cell) { return is_passed[space_.index(cell)]; });
    space_.set_faces(std::move(faces));
  }

  struct Enclosed {
    double volume;            ///< m^Dim, at most
    std::vector<bool> walls;  ///< by face
  };
  /// Empty where the water can get out.
  std::optional<Enclosed> enclosed() const {
    Spread<Dim> room = spread(space_, wet_, Vec<Dim>(Vec<Dim>::Zero()));
    if (room.way_out) return std::nullopt;
    // A cell at a wall counts whole or not at all: half of it may be missing.
    const double cells = static_cast<double>(room.cells.size()) + 0.5 * static_cast<double>(room.sides);
    return Enclosed{cells * space_.volume(), std::move(room.met)};
  }

 private:
  static constexpr double most_cells = 2e4;

  CellSpace<Dim> space_;
  double water_;
  std::vector<typename CellSpace<Dim>::Cell> wet_;
};

template <int Dim>
class MotionCheck {
 public:
  MotionCheck(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid)
      : spec_(spec), drawn_(drawn), now_(drawn), fluid_(fluid), dx_(spec.particles.spacing) {
    for (std::size_t w = 0; w < spec.walls.size(); ++w) {
      paths_.emplace_back(spec, spec.walls[w], wall_label(drawn, static_cast<int>(w)));
    }
  }

  std::vector<Finding> findings() {
    const SuspendFpTraps suspended;  // a path need not be finite
    for (std::size_t w = 0; w < paths_.size(); ++w) {
      if (starts_where_it_is_drawn(static_cast<int>(w)) && drawn_.walls[w].moves())
        is_sound_.insert(static_cast<int>(w));
    }
    if (is_sound_.empty()) return std::move(findings_);
    if constexpr (Dim == 2) warn_of_free_ends();
    if (spec_.scheme.walls != WallTreatment::dummies) look_for_common_rows();
    places_ = places_of_room_ = places_at(0.0);
    before_ = now_.faces;
    // Water leaves through an outlet.
    if (spec_.outlets.empty() && !fluid_.position.empty()) room_.emplace(spec_, drawn_, fluid_);
    look_for_contact(0.0);
    // The last step may pass the end.
    const double end = spec_.time.end * (1.0 + 1.0 / least_samples);
    for (int k = 0; k < least_samples; ++k) {
      follow(end * k / least_samples, end * (k + 1) / least_samples);
      if (room_) look_for_room(end * (k + 1) / least_samples);
    }
    return std::move(findings_);
  }

 private:
  template <class... Arguments>
  void error(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    findings_.push_back({Severity::error, fmt::format(text, std::forward<Arguments>(arguments)...)});
  }

  std::string label(int wall) const { return wall_label(drawn_, wall); }

  bool starts_where_it_is_drawn(int wall) {
    const AffineMap<Dim> start = paths_[wall].at(0.0);
    for (const WallFace<Dim>& face : drawn_.faces) {
      if (face.wall != wall) continue;
      const Vec<Dim> way = start(face.corners[0]) - face.corners[0];
      if (way.norm() <= corner_tolerance * dx_) continue;
      error(
          "{} is not where it is drawn at t = 0: its point {} has moved by {} m; displacement and rotation must begin "
          "with 0, so subtract their start or draw the wall elsewhere",
          label(wall), place(face.corners[0]), place(way));
      return false;
    }
    return true;
  }

  std::vector<AffineMap<Dim>> places_at(double time) const {
    std::vector<AffineMap<Dim>> places(paths_.size());
    for (const int wall : is_sound_) places[wall] = paths_[wall].at(time);
    return places;
  }

  /// The point of a wall that gets farthest between two places of it, and how far.
  std::pair<Vec<Dim>, double> farthest(int wall, const AffineMap<Dim>& before, const AffineMap<Dim>& after) const {
    std::pair<Vec<Dim>, double> result{Vec<Dim>::Zero(), 0.0};
    for (const WallFace<Dim>& face : drawn_.faces) {
      if (face.wall != wall) continue;
      for (const Vec<Dim>& corner : face.corners) {
        const double way = (after(corner) - before(corner)).norm();
        if (!(way <= result.second)) result = {before(corner), way};  // not a number as well
      }
    }
    return result;
  }

  /// Looks at the walls on their way between two times, every dx/4.
  void follow(double from, double to) {
    const std::vector<AffineMap<Dim>> start = places_at(from);
    const std::vector<AffineMap<Dim>> end = places_at(to);
    double longest = 0.0;
    bool is_far = false;
    for (const int wall : std::vector<int>(is_sound_.begin(), is_sound_.end())) {
      const auto [where, way] = farthest(wall, start[wall], end[wall]);
      if (!std::isfinite(way)) {
        error("{} is at no finite place at t = {:.6g} s: mend its displacement or rotation", label(wall), to);
        is_sound_.erase(wall);
      } else if (way > 0.25 * dx_ && way > largest_wall_speed * (to - from)) {
        error(
            "{} is too fast: its point {} moves {:.3g} m in the {:.3g} s from t = {:.6g} s on, and walls may have "
            "{:.0f} m/s at most, since water is taken for incompressible; mend its displacement or rotation",
            label(wall), place(where), way, to - from, from, largest_wall_speed);
        is_sound_.erase(wall);
      } else {
        longest = std::max(longest, way);
        is_far = is_far || farthest(wall, places_[wall], end[wall]).second > 0.25 * dx_;
      }
    }
    if (longest > 0.25 * dx_) {
      follow(from, 0.5 * (from + to));
      follow(0.5 * (from + to), to);
    } else if (is_far) {
      places_ = end;
      before_ = now_.faces;
      for (std::size_t f = 0; f < drawn_.faces.size(); ++f) {
        now_.faces[f] = moved(places_[drawn_.faces[f].wall], drawn_.faces[f]);
      }
      look_for_contact(to);
    }
  }

  /// Looks whether the water has room, when a wall has moved by dx since the last time.
  void look_for_room(double time) {
    const auto is_sound = [](const Finding& finding) { return finding.severity != Severity::error; };
    const auto has_moved = [&](int wall) { return farthest(wall, places_of_room_[wall], places_[wall]).second > dx_; };
    if (!std::ranges::all_of(findings_, is_sound) || !std::ranges::any_of(is_sound_, has_moved)) return;
    std::vector<AffineMap<Dim>> way;
    for (const WallFace<Dim>& face : now_.faces) {
      way.push_back(way_between(places_of_room_[face.wall], places_[face.wall]));
    }
    room_->move(now_.faces, way);
    places_of_room_ = places_;
    const auto enclosed = room_->enclosed();
    if (!enclosed || enclosed->volume >= room_->water()) return;
    for (std::size_t f = 0; f < now_.faces.size(); ++f) {
      const int wall = now_.faces[f].wall;
      if (!enclosed->walls[f] || !drawn_.walls[wall].moves()) continue;
      Vec<Dim> middle = Vec<Dim>::Zero();
      for (const Vec<Dim>& corner : now_.faces[f].corners) middle += corner / Dim;
      error(
          "{} crushes the water at t = {:.6g} s, when it is at {}: the walls leave {:.3g} m^{} to {:.3g} m^{} of water "
          "that cannot get out; end its path before, or leave the water a way out",
          label(wall), time, place(middle), enclosed->volume, Dim, room_->water(), Dim);
      return;
    }
  }

  /// Where rows of particles stand on the walls, and not only behind them, those of bodies that touch lie in each
  /// other.
  void look_for_common_rows() {
    for (const WallFace<Dim>& face : drawn_.faces) {
      for (const WallFace<Dim>& other : drawn_.faces) {
        if (are_one_body(face, other)) continue;
        for (const Vec<Dim>& corner : face.corners) {
          const double distance = (closest_point(other, corner) - corner).norm();
          if (distance > (1.0 - corner_tolerance) * dx_) continue;
          const auto [moving, near] = std::minmax(
              face.wall, other.wall, [&](int a, int b) { return drawn_.walls[a].moves() && !drawn_.walls[b].moves(); });
          error(
              "{} is {:.3g} m from {} at {}, and scheme.walls = \"{}\" puts particles on both: draw it at a distance "
              "of "
              "{:.6g} m, or choose scheme.walls = \"{}\"",
              label(moving), distance, label(near), place(corner), name_of(spec_.scheme.walls), dx_,
              name_of(WallTreatment::dummies));
          return;
        }
      }
    }
  }

  bool are_one_body(const WallFace<Dim>& a, const WallFace<Dim>& b) const {
    return drawn_.walls[a.wall].body == drawn_.walls[b.wall].body;
  }

  void look_for_contact(double time) {
    for (std::size_t f = 0; f < now_.faces.size(); ++f) {
      if (!is_sound_.contains(now_.faces[f].wall)) continue;
      for (std::size_t other = 0; other < now_.faces.size(); ++other) {
        const WallFace<Dim>& a = now_.faces[f];
        const WallFace<Dim>& b = now_.faces[other];
        if (are_one_body(a, b) || are_apart(a, b)) continue;
        const std::pair<int, int> pair = std::minmax(a.wall, b.wall);
        if (reported_.contains(pair)) continue;
        if (const std::optional<Vec<Dim>> where = crossing(a, b)) {
          reported_.insert(pair);
          error("{} crosses {} at t = {:.6g} s at {}: change its path, or draw it shorter", label(a.wall),
                label(b.wall), time, place(*where));
        } else if (const std::optional<Vec<Dim>> foot = narrowing(f, other)) {
          reported_.insert(pair);
          error(
              "{} comes nearer than a spacing to {} at t = {:.6g} s at {}: the water between them would be crushed; "
              "end "
              "its path at least {:.6g} m before",
              label(a.wall), label(b.wall), time, place(*foot), dx_);
        }
      }
    }
  }

  /// Farther than a spacing from each other, by the boxes around them.
  bool are_apart(const WallFace<Dim>& a, const WallFace<Dim>& b) const {
    Eigen::AlignedBox<double, Dim> box_a, box_b;
    for (const Vec<Dim>& corner : a.corners) box_a.extend(corner);
    for (const Vec<Dim>& corner : b.corners) box_b.extend(corner);
    return box_a.exteriorDistance(box_b) > dx_;
  }

  double distance_from_rim(const WallFace<Dim>& face, const Vec<Dim>& x) const {
    double least = std::numeric_limits<double>::max();
    for (int c = 0; c < Dim; ++c) {
      const Vec<Dim>& from = face.corners[c];
      if constexpr (Dim == 2) {
        least = std::min(least, (x - from).norm());
      } else {
        const Vec<Dim> edge = (face.corners[(c + 1) % Dim] - from).normalized();
        least = std::min(least, (x - from - edge.dot(x - from) * edge).norm());
      }
    }
    return least;
  }

  std::optional<Vec<Dim>> crossing(const WallFace<Dim>& a, const WallFace<Dim>& b) const {
    const double tolerance = corner_tolerance * dx_;
    const auto edge_through = [&](const WallFace<Dim>& from, const WallFace<Dim>& through) -> std::optional<Vec<Dim>> {
      for (int c = 0; c < (Dim == 2 ? 1 : 3); ++c) {
        const Vec<Dim>& low = from.corners[c];
        const Vec<Dim>& high = from.corners[(c + 1) % Dim];
        if (!crosses(through, low, high, tolerance)) continue;
        // Walls may touch: what slides along a wall has its rim on it.
        const Vec<Dim> hit = meet(through, low, high);
        if (distance_from_rim(through, hit) > 2.0 * tolerance) return hit;
      }
      return std::nullopt;
    };
    const std::optional<Vec<Dim>> one = edge_through(a, b);
    if (Dim == 3) return one ? one : edge_through(b, a);
    return one && edge_through(b, a) ? one : std::nullopt;
  }

  /// A place where face f, a moving one, looks at another nearer than dx and nearer than at the last look.
  std::optional<Vec<Dim>> narrowing(std::size_t f, std::size_t other) const {
    const WallFace<Dim>& a = now_.faces[f];
    const WallFace<Dim>& b = now_.faces[other];
    if (-a.normal.dot(b.normal) < least_facing) return std::nullopt;
    const double tolerance = corner_tolerance * dx_;
    const int samples = std::clamp(static_cast<int>(std::ceil((a.corners[1] - a.corners[0]).norm() / dx_)), 1, 50);
    const auto gap = [](const WallFace<Dim>& face, const Vec<Dim>& foot, const WallFace<Dim>& opposite) {
      return opposite.height(foot) / -face.normal.dot(opposite.normal);
    };
    for (int k = 0; k < samples; ++k) {
      for (int m = 0; m < (Dim == 2 ? 1 : samples); ++m) {
        const auto point = [&](const WallFace<Dim>& face) {
          const double s = (k + 0.5) / samples;
          Vec<Dim> x = face.corners[0] + s * (face.corners[1] - face.corners[0]);
          if constexpr (Dim == 3) x += s * (m + 0.5) / samples * (face.corners[2] - face.corners[1]);
          return x;
        };
        const Vec<Dim> foot = point(a);
        const double now = gap(a, foot, b);
        const double before = gap(before_[f], point(before_[f]), before_[other]);
        if (now < -tolerance || now > dx_ - tolerance || now > before - 2.0 * tolerance) continue;
        const Vec<Dim> hit = foot + now * a.normal;
        if ((closest_point(b, hit) - hit).norm() <= tolerance) return foot;
      }
    }
    return std::nullopt;
  }

  void warn_of_free_ends() {
    for (const WallFace<Dim>& face : drawn_.faces) {
      if (drawn_.walls[face.wall].moves()) continue;
      for (const Vec<Dim>& end : face.corners) {
        int moving = -1;
        bool goes_on = false;
        for (const WallFace<Dim>& other : drawn_.faces) {
          if (&other == &face) continue;
          const bool is_here = std::ranges::any_of(
              other.corners, [&](const Vec<Dim>& x) { return (x - end).norm() <= corner_tolerance * dx_; });
          if (is_here && drawn_.walls[other.wall].moves()) moving = other.wall;
          goes_on = goes_on || (is_here && !drawn_.walls[other.wall].moves());
        }
        if (moving < 0 || goes_on) continue;
        findings_.push_back(
            {Severity::warning,
             fmt::format(
                 "{} ends at {}, where {} begins, which moves: there is no wall behind it; draw the first on by "
                 "{:.6g} m or more",
                 label(face.wall), place(end), label(moving), dummy_layers(spec_) * dx_)});
      }
    }
  }

  const CaseSpec& spec_;
  const Boundary<Dim>& drawn_;
  Boundary<Dim> now_;
  const FluidParticles<Dim>& fluid_;
  std::vector<AffineMap<Dim>> places_;  ///< of the walls, at the last look
  std::vector<WallFace<Dim>> before_;   ///< at the look before
  std::optional<Room<Dim>> room_;
  std::vector<AffineMap<Dim>> places_of_room_;  ///< when it was looked at
  double dx_;
  std::vector<WallPath<Dim>> paths_;
  std::set<int> is_sound_;  ///< moving walls without an error of their own so far
  std::set<std::pair<int, int>> reported_;
  std::vector<Finding> findings_;
};

}  // namespace

template <int Dim>
std::vector<Finding> check_motion(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid) {
  return MotionCheck<Dim>(spec, drawn, fluid).findings();
}

template std::vector<Finding> check_motion(const CaseSpec&, const Boundary<2>&, const FluidParticles<2>&);
template std::vector<Finding> check_motion(const CaseSpec&, const Boundary<3>&, const FluidParticles<3>&);

}  // namespace tailwater
