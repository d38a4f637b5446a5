#include "base/fp_traps.h"
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

}  // namespace

template <int Dim>
Findings check_moving_walls(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid) {
  const SuspendFpTraps suspended;  // a path may not be finite
  Findings findings;
  std::vector<int> moving;
  for (int wall = 0; wall < static_cast<int>(spec.walls.size()); ++wall) {
    if (starts_where_it_is_drawn(spec, drawn, wall, findings) && drawn.walls[wall].moves()) moving.push_back(wall);
  }
  if (moving.empty()) return findings;
  append(findings, check_motion_files(spec, drawn, fluid));
  if (has_error(findings)) return findings;  // a path that jumps is not checked further
  if constexpr (Dim == 2) append(findings, check_free_ends(spec, drawn));
  append(findings, check_touching_rows(spec, drawn));
  append(findings, check_paths(spec, drawn, fluid, moving));
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_moving_walls);

}  // namespace tailwater
