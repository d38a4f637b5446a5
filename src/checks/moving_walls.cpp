#include <algorithm>
#include <numbers>

#include "base/fp_traps.h"
#include "case/named_numbers.h"
#include "case/time_function.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"
#include "motion/wall_motion.h"

namespace tailwater {
namespace {

/// ", in its file motion.csv," for a wall whose motion is in a file.
std::string file_of(const CaseSpec& spec, int wall) {
  const std::string& file = spec.walls[wall].series.file;
  return file.empty() ? "" : fmt::format(", in its file {},", file);
}

/// Adds an error if the wall is not at its drawn place at t = 0; returns whether it is there.
template <int Dim>
bool starts_where_it_is_drawn(const CaseSpec& spec, const Boundary<Dim>& drawn, int wall, Findings& findings) {
  const AffineMap<Dim> start = WallPath<Dim>(spec, spec.walls[wall], wall_label(drawn, wall)).at(0.0);
  for (const WallFace<Dim>& face : drawn.faces) {
    if (face.wall != wall) continue;
    const Vec<Dim> displacement = start(face.corners[0]) - face.corners[0];
    if (displacement.norm() <= corner_tolerance * spec.particles.spacing) continue;
    findings.push_back(Finding::error(
        "motion-starts-displaced",
        {"{} is not where it is drawn at t = 0: its point {} has moved by {} m, but displacement and "
         "rotation{} must begin with 0",
         wall_label(drawn, wall), place(face.corners[0]), vector_text(displacement), file_of(spec, wall)},
        {"subtract their values at t = 0, or move the drawing of the wall"}));
    return false;
  }
  return true;
}

/// Adds an error for a wall that turns and also slides along a periodic direction: it is moved by whole periods by its
/// displacement alone, as if it did not turn.
void check_turns_in_period(const CaseSpec& spec, const CaseLabel& label, int wall, Findings& findings) {
  const WallTable& table = spec.walls[wall];
  const bool turns =
      table.series.empty() ? std::holds_alternative<std::string>(table.rotation) : !table.series.columns[3].empty();
  if (!turns) return;
  for (std::size_t axis = 0; axis < table.displacement.size(); ++axis) {
    const bool is_in_file = !table.series.empty() && !table.series.columns[axis].empty();
    const bool slides = is_in_file || std::holds_alternative<std::string>(table.displacement[axis]);
    if (!slides || periodic_range(spec.domain, static_cast<int>(axis)).empty()) continue;
    findings.push_back(Finding::error(
        "turning-wall-in-period",
        {"{} turns and also moves along {}, in which the case repeats itself (domain.periodic_{}): such a wall would "
         "vanish at some angles",
         label, "xyz"[axis], "xyz"[axis]},
        {"leave out the rotation, or give the component of the displacement as 0 without an expression"}));
  }
}

/// Adds a warning for a wall that swings back and forth by more than half a turn: its angle is most likely in degrees.
void check_swing(const CaseSpec& spec, const CaseLabel& label, int wall, Findings& findings) {
  constexpr int looks = 1000;
  if (!std::holds_alternative<std::string>(spec.walls[wall].rotation)) return;
  const TimeFunction rotation(spec.walls[wall].rotation, named_numbers(spec));
  double lowest = 0.0, highest = 0.0, rise = 0.0, fall = 0.0;  // rad
  for (int k = 0; k <= looks; ++k) {
    const double angle = rotation.at(spec.time.end * k / looks);
    lowest = std::min(lowest, angle);
    highest = std::max(highest, angle);
    rise = std::max(rise, angle - lowest);
    fall = std::max(fall, highest - angle);
  }
  const double swing = std::min(rise, fall);
  if (swing <= std::numbers::pi) return;
  findings.push_back(Finding::warning(
      "swing-beyond-half-turn",
      {"{} swings back and forth by {:.3g}, more than half a turn", label.with_key("rotation"), Amount{swing, "rad"}},
      {"give the angle in rad: a degree is pi/180"}));
}

/// Adds a warning for each zone of damping at a wall that moves, as in a tank that is shaken.
template <int Dim>
void check_damping_at(const CaseSpec& spec, const Boundary<Dim>& drawn, int wall, Findings& findings) {
  if (spec.walls[wall].drive.by != Drive::By::wall) return;
  for (const DampingTable& zone : spec.damping) {
    const CaseLabel owner("damping", zone.name);
    const Box<Dim> box(to_vec<Dim>(zone.min, owner, "min"), to_vec<Dim>(zone.max, owner, "max"));
    const bool is_there = std::ranges::any_of(
        drawn.faces, [&](const WallFace<Dim>& face) { return face.wall == wall && face.box().intersects(box); });
    if (!is_there) continue;
    findings.push_back(Finding::warning(
        "damping-at-moving-wall",
        {"{} lies at {}, which moves, and the zone stays where it is drawn and slows the water down to rest", owner,
         wall_label(drawn, wall)},
        {"leave out the zone, or end it before the wall"}));
  }
}

}  // namespace

template <int Dim>
Findings check_moving_walls(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid) {
  const SuspendFpTraps suspended;  // a path may not be finite
  Findings findings;
  std::vector<int> moving;
  for (int wall = 0; wall < static_cast<int>(spec.walls.size()); ++wall) {
    check_turns_in_period(spec, wall_label(drawn, wall), wall, findings);
    check_swing(spec, wall_label(drawn, wall), wall, findings);
    if (starts_where_it_is_drawn(spec, drawn, wall, findings) && drawn.walls[wall].moves()) moving.push_back(wall);
  }
  if (moving.empty()) return findings;
  for (const int wall : moving) check_damping_at(spec, drawn, wall, findings);
  append(findings, check_motion_files(spec, drawn, fluid));
  if (has_error(findings)) return findings;  // a path that jumps is not checked further
  if constexpr (Dim == 2) append(findings, check_free_ends(spec, drawn));
  append(findings, check_touching_rows(spec, drawn));
  append(findings, check_paths(spec, drawn, fluid, moving));
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_moving_walls);

}  // namespace tailwater
