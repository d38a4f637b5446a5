#include "geometry/check_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "base/fp_traps.h"
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

template <int Dim>
class MotionCheck {
 public:
  MotionCheck(const CaseSpec& spec, const Boundary<Dim>& drawn)
      : spec_(spec), drawn_(drawn), now_(drawn), dx_(spec.particles.spacing) {
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
    std::vector<AffineMap<Dim>> places = places_at(0.0);
    before_ = now_.faces;
    look_for_contact(0.0);
    // The last step may pass the end.
    const double end = spec_.time.end * (1.0 + 1.0 / least_samples);
    for (int k = 0; k < least_samples; ++k) follow(end * k / least_samples, end * (k + 1) / least_samples, places);
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

  /// Looks at the walls on their way between two times, every dx/4. `places`: those of the last look.
  void follow(double from, double to, std::vector<AffineMap<Dim>>& places) {
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
        is_far = is_far || farthest(wall, places[wall], end[wall]).second > 0.25 * dx_;
      }
    }
    if (longest > 0.25 * dx_) {
      follow(from, 0.5 * (from + to), places);
      follow(0.5 * (from + to), to, places);
    } else if (is_far) {
      places = end;
      before_ = now_.faces;
      for (std::size_t f = 0; f < drawn_.faces.size(); ++f) {
        now_.faces[f] = moved(places[drawn_.faces[f].wall], drawn_.faces[f]);
      }
      look_for_contact(to);
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
        } else if (const std::optional<Vec<Dim>> where = narrowing(f, other)) {
          reported_.insert(pair);
          error(
              "{} comes nearer than a spacing to {} at t = {:.6g} s at {}: the water between them would be crushed; "
              "end "
              "its path at least {:.6g} m before",
              label(a.wall), label(b.wall), time, place(*where), dx_);
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
  std::vector<WallFace<Dim>> before_;  ///< at the last look
  double dx_;
  std::vector<WallPath<Dim>> paths_;
  std::set<int> is_sound_;  ///< moving walls without an error of their own so far
  std::set<std::pair<int, int>> reported_;
  std::vector<Finding> findings_;
};

}  // namespace

template <int Dim>
std::vector<Finding> check_motion(const CaseSpec& spec, const Boundary<Dim>& drawn) {
  return MotionCheck<Dim>(spec, drawn).findings();
}

template std::vector<Finding> check_motion(const CaseSpec&, const Boundary<2>&);
template std::vector<Finding> check_motion(const CaseSpec&, const Boundary<3>&);

}  // namespace tailwater
