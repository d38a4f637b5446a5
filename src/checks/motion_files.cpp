#include <algorithm>
#include <cmath>

#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"
#include "motion/wall_motion.h"

namespace tailwater {
namespace {

/// Walls in laboratories are not faster than this multiple of sqrt(2 g L), the speed of water that falls from its own
/// height. Faster walls would make every step shorter by the same factor.
constexpr double fastest_over_water = 10.0;

/// Fraction of the largest displacement in a file by which the curve may exceed the values of two neighbouring lines. A
/// sine exceeds them by 1 % with 20 lines per period and by 10 % with 7.
constexpr double largest_overshoot = 0.1;

/// The samples of one file, as motions of the wall's corners.
template <int Dim>
class FileWalk {
 public:
  FileWalk(const CaseSpec& spec, const Boundary<Dim>& drawn, int wall, const TimeSeries& series, double start)
      : series_(series),
        start_(start),
        label_(wall_label(drawn, wall)),
        path_(spec, spec.walls[wall], label_),
        dx_(spec.particles.spacing) {
    for (const WallFace<Dim>& face : drawn.faces) {
      if (face.wall == wall) corners_.insert(corners_.end(), face.corners.begin(), face.corners.end());
    }
  }

  /// A jump, or else the largest overshoot; empty if the motion is smooth.
  Findings findings(double fastest) const {
    double largest_displacement = 0.0;
    double worst = 0.0;
    std::size_t worst_at = 0;
    const AffineMap<Dim> start = path_.at(0.0);
    for (std::size_t k = 0; k + 1 < series_.time.size(); ++k) {
      const double from = start_ + series_.time[k];
      const double to = start_ + series_.time[k + 1];
      const AffineMap<Dim> before = path_.at(from);
      const AffineMap<Dim> after = path_.at(to);
      for (const Vec<Dim>& corner : corners_) {
        const double displacement = (after(corner) - before(corner)).norm();
        if (fastest > 0.0 && displacement > 0.25 * dx_ && displacement > fastest * (to - from))
          return {jump(k, displacement, to - from, fastest)};
        largest_displacement = std::max(largest_displacement, (after(corner) - start(corner)).norm());
        const double overshoot = overshoot_of(corner, before, after, from, to);
        if (overshoot > worst) {
          worst = overshoot;
          worst_at = k;
        }
      }
    }
    if (worst <= std::max(0.25 * dx_, largest_overshoot * largest_displacement)) return {};
    return {
        Finding::warning("motion-overshoots-file",
                         {"{} moves {:.3g} beyond lines {} and {} of {}, because its speed changes more suddenly "
                          "than these lines resolve",
                          label_, Amount{worst, "m"}, series_.line[worst_at], series_.line[worst_at + 1], series_.file},
                         {"give more lines there"})};
  }

 private:
  Finding jump(std::size_t k, double displacement, double duration, double fastest) const {
    return Finding::error(
        "motion-file-jumps",
        {"{} jumps between lines {} and {} of {}: it moves {:.3g} m in {:.3g} s, at {:.3g}, which is more than {:.0f} "
         "times the speed of a fall from the height of the water ({:.3g} m/s)",
         label_, series_.line[k], series_.line[k + 1], series_.file, displacement, duration,
         Amount{displacement / duration, "m/s"}, fastest_over_water, fastest / fastest_over_water},
        {"correct the lines, or the units in the file's header"});
  }

  /// The distance of a corner from the straight line between two samples, along that line and beyond its ends; for a
  /// corner at rest, in any direction.
  double overshoot_of(const Vec<Dim>& corner, const AffineMap<Dim>& before, const AffineMap<Dim>& after, double from,
                      double to) const {
    const Vec<Dim> begin = before(corner);
    const Vec<Dim> displacement = after(corner) - begin;
    double largest = 0.0;
    for (const double share : {0.25, 0.5, 0.75}) {
      const Vec<Dim> off = path_.at(from + share * (to - from))(corner) - begin;
      const double along = displacement.norm() > 0.0 ? off.dot(displacement.normalized()) : off.norm();
      largest = std::max({largest, along - displacement.norm(), displacement.norm() > 0.0 ? -along : 0.0});
    }
    return largest;
  }

  const TimeSeries& series_;
  double start_;
  CaseLabel label_;
  WallPath<Dim> path_;
  double dx_;
  std::vector<Vec<Dim>> corners_;
};

}  // namespace

template <int Dim>
Findings check_motion_files(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid) {
  Findings findings;
  const double fastest = fastest_over_water * std::sqrt(2.0 * gravity_of<Dim>(spec).norm() * water_height(spec, fluid));
  for (std::size_t w = 0; w < spec.walls.size(); ++w) {
    const Drive& drive = spec.walls[w].drive;
    const bool is_gate = drive.by == Drive::By::gate;
    const TimeSeries& series = is_gate ? spec.gates[drive.index].series : spec.walls[w].series;
    if (series.empty()) continue;
    const double start = is_gate ? spec.gates[drive.index].start : 0.0;
    append(findings, FileWalk<Dim>(spec, drawn, static_cast<int>(w), series, start).findings(fastest));
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_motion_files);

}  // namespace tailwater
