#include "checks/collision.h"

#include <algorithm>
#include <limits>

#include "checks/face_samples.h"

namespace tailwater {
namespace {

/// Minimum cosine: walls that close at less than 45 degrees crush the water; others push it out of the wedge.
constexpr double min_facing = 0.7;

template <int Dim>
double distance_from_rim(const WallFace<Dim>& face, const Vec<Dim>& x) {
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

/// A place where an edge of `from` passes through the inside of `through`.
template <int Dim>
std::optional<Vec<Dim>> edge_through(const WallFace<Dim>& from, const WallFace<Dim>& through, double tolerance) {
  for (int c = 0; c < (Dim == 2 ? 1 : 3); ++c) {
    const Vec<Dim>& low = from.corners[c];
    const Vec<Dim>& high = from.corners[(c + 1) % Dim];
    if (!crosses(through, low, high, tolerance)) continue;
    // Walls may touch: a wall that slides along another has its rim on it.
    const Vec<Dim> hit = meet(through, low, high);
    if (distance_from_rim(through, hit) > 2.0 * tolerance) return hit;
  }
  return std::nullopt;
}

template <int Dim>
std::optional<Vec<Dim>> crossing(const WallFace<Dim>& a, const WallFace<Dim>& b, double tolerance) {
  const std::optional<Vec<Dim>> one = edge_through(a, b, tolerance);
  if (Dim == 3) return one ? one : edge_through(b, a, tolerance);
  return one && edge_through(b, a, tolerance) ? one : std::nullopt;
}

/// A place where `a` faces `b` at less than dx, and nearer than before.
template <int Dim>
std::optional<Vec<Dim>> narrowing(const WallFace<Dim>& a, const WallFace<Dim>& b, const WallFace<Dim>& a_before,
                                  const WallFace<Dim>& b_before, double dx) {
  if (-a.normal.dot(b.normal) < min_facing) return std::nullopt;
  const double tolerance = corner_tolerance * dx;
  const int samples = samples_along(a, dx);
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
      const double before = gap(a_before, point(a_before), b_before);
      if (now < -tolerance || now > dx - tolerance || now > before - 2.0 * tolerance) continue;
      const Vec<Dim> hit = foot + now * a.normal;
      if ((closest_point(b, hit) - hit).norm() <= tolerance) return foot;
    }
  }
  return std::nullopt;
}

}  // namespace

template <int Dim>
std::optional<Collision<Dim>> collision(const WallFace<Dim>& a, const WallFace<Dim>& b, const WallFace<Dim>& a_before,
                                        const WallFace<Dim>& b_before, double dx) {
  if (a.box().exteriorDistance(b.box()) > dx) return std::nullopt;
  if (const auto where = crossing(a, b, corner_tolerance * dx)) return Collision<Dim>{*where, true};
  if (const auto where = narrowing(a, b, a_before, b_before, dx)) return Collision<Dim>{*where, false};
  return std::nullopt;
}

TAILWATER_IN_2D_AND_3D(collision);

}  // namespace tailwater
