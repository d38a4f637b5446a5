#include "geometry/screen.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/box.h"

namespace tailwater {
namespace {

double distance_to(const RimPiece<2>& piece, const Vec<2>& x) { return (x - piece[0]).norm(); }
double distance_to(const RimPiece<3>& piece, const Vec<3>& x) {
  const Vec<3> edge = piece[1] - piece[0];
  const double share = std::clamp(edge.dot(x - piece[0]) / edge.squaredNorm(), 0.0, 1.0);
  return (x - piece[0] - share * edge).norm();
}

}  // namespace

template <int Dim>
double distance_to_rim(std::span<const RimPiece<Dim>> rim, const Vec<Dim>& x) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const RimPiece<Dim>& piece : rim) nearest = std::min(nearest, distance_to(piece, x));
  return nearest;
}

template <int Dim>
bool Screen<Dim>::find_passage(const Vec<Dim>& from, const Vec<Dim>& to, Vec<Dim>& passage) const {
  const double before = height(from);
  const double after = height(to);
  if ((before >= 0.0) == (after >= 0.0)) return false;
  passage = from + before / (before - after) * (to - from);
  const Vec<Dim> hit = passage - corner;
  std::array<double, 2> place{};
  for (int axis = 0; axis < Dim - 1; ++axis) {
    place[axis] = along[axis].dot(hit);
    if (place[axis] < range[axis][0] || place[axis] > range[axis][1]) return false;
  }
  return std::ranges::all_of(
      cuts, [&](const ScreenCut& cut) { return cut.outwards[0] * place[0] + cut.outwards[1] * place[1] <= cut.most; });
}

template <int Dim>
bool Screen<Dim>::is_between(const Vec<Dim>& from, const Vec<Dim>& to) const {
  Vec<Dim> passage;
  return find_passage(from, to, passage);
}

template <int Dim>
double Screen<Dim>::hidden_fraction(const Vec<Dim>& from, const Vec<Dim>& to) const {
  Vec<Dim> passage;
  if (is_beyond_corner() || !find_passage(from, to, passage)) return 0.0;
  if (rim.empty()) return 1.0;
  return faded((is_beyond ? -1.0 : 1.0) * distance_to_rim<Dim>(rim, passage));
}

template <int Dim>
double Screen<Dim>::fraction_at(const ScreenCorner<Dim>& at, const Vec<Dim>& from, const Vec<Dim>& to) const {
  Vec<Dim> passage;
  if (!find_passage(from, to, passage)) return 0.0;
  return faded((is_beyond ? -1.0 : 1.0) * distance_to(at.piece, passage));
}

template <int Dim>
double Screen<Dim>::faded(double inside) const {
  const double q = std::clamp(0.5 * (1.0 + inside / fade), 0.0, 1.0);
  return q * q * (3.0 - 2.0 * q);
}

template <int Dim>
double Screen<Dim>::distance(const Vec<Dim>& x) const {
  double squared = height(x) * height(x);
  for (int axis = 0; axis < Dim - 1; ++axis) {
    const double place = along[axis].dot(x - corner);
    const double beyond = place - std::clamp(place, range[axis][0], range[axis][1]);
    squared += beyond * beyond;
  }
  return std::sqrt(squared);
}

template <int Dim>
Box<Dim> Screen<Dim>::box() const {
  Box<Dim> box;
  for (int c = 0; c < (Dim == 2 ? 2 : 4); ++c) {
    Vec<Dim> x = corner;
    for (int axis = 0; axis < Dim - 1; ++axis) x += range[axis][c >> axis & 1] * along[axis];
    box.extend(x);
  }
  return box;
}

namespace {

/// Fraction of the way from one point to another at which the line passes the plane of a screen.
template <int Dim>
double passed_at(const Screen<Dim>& screen, const Vec<Dim>& from, const Vec<Dim>& to) {
  const double before = screen.height(from);
  return before / (before - screen.height(to));
}

/// Passages that differ by less are at one place, such as the line along which two plates meet. The wall with the lower
/// index counts as the first one there.
constexpr double same_passage = 1e-9;

/// Squared sine of the angle between two plates that meet; with less they go straight on.
constexpr double min_square_of_sine = 0.01;

/// Hidden fraction between two points by one of the screens `near` them. A corner of two plates hides all from one of
/// its sides to the other. From a side to the same side it acts as a free rim of both plates.
template <int Dim>
double hidden_by(std::span<const Screen<Dim>> screens, std::span<const int> near, int s, const Vec<Dim>& from,
                 const Vec<Dim>& to) {
  const Screen<Dim>& screen = screens[s];
  double fraction = screen.hidden_fraction(from, to);
  for (const ScreenCorner<Dim>& corner : screen.corners) {
    const double at_corner = screen.fraction_at(corner, from, to);
    if (at_corner == 0.0 || at_corner == fraction) continue;
    bool passes_own = false;
    bool passes_other = false;
    for (const int r : near) {
      const Screen<Dim>& other = screens[r];
      const bool has_corner =
          std::ranges::any_of(other.corners, [&](const auto& one) { return one.number == corner.number; });
      if (other.is_beyond || !has_corner || !other.is_between(from, to)) continue;
      // A line through the corner itself counts as one that passes a single plate.
      const double apart = passed_at(other, from, to) - passed_at(screen, from, to);
      if (other.wall == screen.wall) {
        passes_own = true;
      } else if (screen.is_beyond || std::abs(apart) > same_passage) {
        passes_other = true;
      }
    }
    if (screen.is_beyond) return passes_own || passes_other ? 0.0 : at_corner;
    if (passes_other) fraction = std::min(fraction, at_corner);
  }
  return fraction;
}

/// Where the line from water to a wall particle first passes the wall through whose screens the particle acts; infinite
/// if it does not.
template <int Dim>
double first_passage(std::span<const Screen<Dim>> screens, std::span<const int> near, const Vec<Dim>& water,
                     const Vec<Dim>& particle, int felt) {
  double first = std::numeric_limits<double>::infinity();
  for (const int s : near) {
    if (screens[s].wall != felt || hidden_by(screens, near, s, water, particle) == 0.0) continue;
    first = std::min(first, passed_at(screens[s], water, particle));
  }
  return first;
}

/// The place on a line at which two flat pieces meet, seen along the line in which their planes cross.
template <int Dim>
struct Meeting {
  Vec<Dim> place;
  Vec<Dim> axis = Vec<Dim>::Zero();  ///< unit vector along both pieces in 3D; 0 in 2D
};

/// Whether a screen has a part on one side of another one, at the place where they meet.
template <int Dim>
bool reaches_to_side(const Screen<Dim>& screen, const Meeting<Dim>& meeting, const Screen<Dim>& other, double side) {
  const Vec<Dim> into = other.normal - other.normal.dot(screen.normal) * screen.normal;
  const Vec<Dim> x = meeting.place + side * 0.5 * screen.fade * into.normalized();
  return screen.distance(x) <= 0.1 * screen.fade;
}

/// Where two screens of plates meet, nearest to the point `x`; none if they do not.
template <int Dim>
std::optional<Meeting<Dim>> meeting_of(const Screen<Dim>& a, const Screen<Dim>& b, const Vec<Dim>& x) {
  const double cosine = a.normal.dot(b.normal);
  const double square_of_sine = 1.0 - cosine * cosine;
  if (square_of_sine < min_square_of_sine) return std::nullopt;
  // From x to both planes, along their normals only.
  const double to_a = -a.height(x);
  const double to_b = -b.height(x);
  Meeting<Dim> meeting{x + ((to_a - cosine * to_b) * a.normal + (to_b - cosine * to_a) * b.normal) / square_of_sine};
  if constexpr (Dim == 3) meeting.axis = a.normal.cross(b.normal).normalized();
  const double near = 0.1 * a.fade;
  if (a.distance(meeting.place) > near || b.distance(meeting.place) > near) return std::nullopt;
  return meeting;
}

/// Distance [m] of a straight line from a place at which two pieces meet, seen along the pieces.
template <int Dim>
double distance_of_line(const Meeting<Dim>& meeting, const Vec<Dim>& from, const Vec<Dim>& to) {
  const auto across = [&](const Vec<Dim>& v) { return Vec<Dim>(v - v.dot(meeting.axis) * meeting.axis); };
  const Vec<Dim> along = across(to - from);
  const Vec<Dim> away = across(meeting.place - from);
  return (away - away.dot(along) / along.squaredNorm() * along).norm();
}

/// The fraction of the hidden water that another plate replaces, where the line from the water to a wall particle first
/// passes one plate near the place where it meets the other one. The particle is hidden by both plates from an angle
/// between them. So one plate takes over from the other as the line moves past the place.
template <int Dim>
double taken_over(const Screen<Dim>& first, const Screen<Dim>& other, const Vec<Dim>& water, const Vec<Dim>& particle) {
  const double side_of_first = first.height(water) >= 0.0 ? 1.0 : -1.0;
  const double side_of_other = other.height(water) >= 0.0 ? 1.0 : -1.0;
  if (side_of_other * other.height(particle) >= 0.0) return 0.0;
  const auto meeting = meeting_of(first, other, water);
  if (!meeting || !reaches_to_side(other, *meeting, first, side_of_first) ||
      !reaches_to_side(first, *meeting, other, side_of_other)) {
    return 0.0;
  }
  const double q = 0.5 * (1.0 - std::min(1.0, distance_of_line(*meeting, water, particle) / first.fade));
  return q * q * (3.0 - 2.0 * q);
}

/// Change of the visible fraction of a wall particle because plates that meet take over from each other.
template <int Dim>
double change_at_meetings(std::span<const Screen<Dim>> screens, std::span<const int> near, const Vec<Dim>& water,
                          const Vec<Dim>& particle, int felt, double visible) {
  const auto is_of_other = [&](int s) { return screens[s].is_plate && screens[s].wall != felt; };
  if (std::ranges::none_of(near, is_of_other)) return 0.0;
  int first = -1;
  double passage = std::numeric_limits<double>::infinity();
  for (const int s : near) {
    if (!screens[s].is_plate || screens[s].is_beyond || !screens[s].is_between(water, particle)) continue;
    const double at = passed_at(screens[s], water, particle);
    if (at > passage + same_passage || (at > passage - same_passage && screens[s].wall > screens[first].wall)) continue;
    first = s;
    passage = at;
  }
  if (first < 0) return 0.0;
  double taken = 0.0;
  for (const int s : near) {
    const Screen<Dim>& other = screens[s];
    if (!other.is_plate || other.is_beyond || other.wall == screens[first].wall) continue;
    if (screens[first].wall != felt && other.wall != felt) continue;
    taken = std::max(taken, taken_over(screens[first], other, water, particle));
  }
  if (taken == 0.0) return 0.0;
  if (screens[first].wall == felt) return -taken * visible;
  return taken * hidden_by(screens, near, first, water, particle);
}

}  // namespace

template <int Dim>
double visible_fraction(std::span<const Screen<Dim>> screens, std::span<const int> near, const Vec<Dim>& from,
                        const Vec<Dim>& to, int felt, bool is_wall_first) {
  if (felt == never_felt) return 0.0;
  const bool has_own = felt >= 0;
  const Vec<Dim>& water = is_wall_first ? to : from;
  const Vec<Dim>& particle = is_wall_first ? from : to;
  const double own_passage = has_own ? first_passage<Dim>(screens, near, water, particle, felt) : 0.0;
  const auto is_behind_own = [&](const Screen<Dim>& screen) {
    const double behind = passed_at(screen, water, particle) - own_passage;
    return behind > (screen.wall < felt ? same_passage : -same_passage);
  };
  double through_own = has_own ? 0.0 : 1.0;
  double visible = 1.0;
  double hidden = 0.0;  // by the last wall
  int wall = -1;
  for (const int s : near) {
    const Screen<Dim>& screen = screens[s];
    const double fraction = hidden_by(screens, near, s, from, to);
    if (fraction == 0.0) continue;
    if (screen.wall == felt) {
      through_own = std::max(through_own, fraction);
    } else if ((screen.is_plate || felt == felt_past_screens) && !(has_own && is_behind_own(screen))) {
      if (screen.wall != wall) {
        visible *= 1.0 - hidden;
        hidden = 0.0;
        wall = screen.wall;
      }
      hidden = std::max(hidden, fraction);
    }
  }
  const double fraction = through_own * visible * (1.0 - hidden);
  return has_own ? fraction + change_at_meetings(screens, near, water, particle, felt, fraction) : fraction;
}

template struct Screen<2>;
template struct Screen<3>;
template double distance_to_rim(std::span<const RimPiece<2>>, const Vec<2>&);
template double distance_to_rim(std::span<const RimPiece<3>>, const Vec<3>&);
template double visible_fraction(std::span<const Screen<2>>, std::span<const int>, const Vec<2>&, const Vec<2>&, int,
                                 bool);
template double visible_fraction(std::span<const Screen<3>>, std::span<const int>, const Vec<3>&, const Vec<3>&, int,
                                 bool);

}  // namespace tailwater
