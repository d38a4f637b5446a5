#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/box.h"
#include "checks/checks.h"
#include "checks/face_samples.h"
#include "geometry/from_spec.h"
#include "geometry/mesh_surface.h"
#include "geometry/plate_shape.h"
#include "geometry/wall_label.h"
#include "motion/wall_motion.h"
#include "refinement/spacing_field.h"

namespace tailwater {
namespace {

constexpr double closed = 0.5;  // dx; a plate that ends as near to a wall leaves no opening (Boundary::hang_screens)
constexpr double narrowest_drawn = 0.1;  // dx; smaller gaps are not drawn on purpose

/// [dx]; smaller gaps between two plates pass no water. A gap of 0.005 dx along a plate passed 15 % of the water above
/// it in 2 s: only walls that are no plates close the end of a plate (Boundary::hang_screens).
constexpr double narrowest_between_plates = 1e-3;

/// Rows of particles with which an opening passes about the right discharge.
constexpr double rows_of_good_gap = 5.0;

/// dx; narrower openings are reported. A little less than the rows above, as the spacing in the remedy is rounded.
constexpr double narrow = 4.95;

/// Minimum cosine of walls that face each other within 45 degrees.
constexpr double min_facing_of_gap = 0.7;

/// Minimum cosine: places within 60 degrees of the outward direction of an edge are beyond it, not beside the plate.
constexpr double min_beyond_edge = 0.5;

/// Fraction of the run's time; walls that are where they were then have come to rest.
constexpr double start_of_rest = 0.95;

/// An opening between two walls that is too narrow for water.
template <int Dim>
struct Gap {
  int wall;
  int other;
  double width;  ///< m
  Vec<Dim> where;
  bool is_between_faces = false;  ///< not beyond the edge of a plate
};

/// An edge at which a plate ends.
template <int Dim>
struct PlateEdge {
  std::vector<Vec<Dim>> points;  ///< at most dx apart
  Vec<Dim> out;                  ///< unit vector in the plate's plane
};

std::vector<PlateEdge<2>> edges_of(const Boundary<2>& boundary, const WallPlate& plate, double /*dx*/) {
  const WallFace<2>& first = boundary.faces[plate.first_face];
  const WallFace<2>& last = boundary.faces[plate.first_face + plate.pieces - 1];
  return {{{first.corners[0]}, (first.corners[0] - first.corners[1]).normalized()},
          {{last.corners[1]}, (last.corners[1] - last.corners[0]).normalized()}};
}

/// The edge from one corner to another of a plate that lies on the side of `inside`.
PlateEdge<3> make_edge(const Vec<3>& from, const Vec<3>& to, const Vec<3>& inside, double dx) {
  const Vec<3> along = (to - from).normalized();
  const Vec<3> away = from - inside;
  PlateEdge<3> edge{{}, (away - away.dot(along) * along).normalized()};
  const int pieces = std::max(1, static_cast<int>(std::ceil((to - from).norm() / dx)));
  for (int k = 0; k <= pieces; ++k) edge.points.push_back(from + k * (to - from) / pieces);
  return edge;
}

std::vector<PlateEdge<3>> edges_of(const Boundary<3>& boundary, const WallPlate& plate, double dx) {
  std::vector<PlateEdge<3>> edges;
  if (plate.sheet) {
    const TriangleMesh& mesh = plate.sheet->mesh();
    for (int t = 0; t < plate.pieces; ++t) {
      for (int e = 0; e < 3; ++e) {
        if (plate.sheet->neighbours()[t][e] >= 0) continue;
        edges.push_back(make_edge(mesh.corner(t, e), mesh.corner(t, (e + 1) % 3), mesh.corner(t, (e + 2) % 3), dx));
      }
    }
    return edges;
  }
  const std::array<Vec<3>, 3>& first = boundary.faces[plate.first_face].corners;
  const std::array<Vec<3>, 4> corners{first[0], first[1], first[2], boundary.faces[plate.first_face + 1].corners[2]};
  for (int e = 0; e < 4; ++e) edges.push_back(make_edge(corners[e], corners[(e + 1) % 4], corners[(e + 2) % 4], dx));
  return edges;
}

/// A place of an edge of a plate that is so near to a wall along its whole length that it counts as closed, but not on
/// it.
template <int Dim>
std::optional<Gap<Dim>> closed_gap_beside(const Boundary<Dim>& boundary, int plate, const PlateEdge<Dim>& edge,
                                          double dx) {
  std::optional<Gap<Dim>> widest;
  for (const Vec<Dim>& x : edge.points) {
    const WallBesidePlate beside = wall_beside_plate(boundary, x);
    if (beside.distance > closed * dx) return std::nullopt;
    if (widest && beside.distance <= widest->width) continue;
    widest = Gap<Dim>{plate, boundary.faces[beside.face].wall, beside.distance, x};
  }
  if (!widest || widest->width <= narrowest_drawn * dx) return std::nullopt;
  return widest;
}

template <int Dim>
using EdgeBox = Box<Dim>;

template <int Dim>
EdgeBox<Dim> box_of(const PlateEdge<Dim>& edge) {
  EdgeBox<Dim> box;
  for (const Vec<Dim>& x : edge.points) box.extend(x);
  return box;
}

/// The faces, among these, within `reach` of a box.
template <int Dim>
std::vector<int> faces_near(const Boundary<Dim>& boundary, const std::vector<int>& faces, const EdgeBox<Dim>& box,
                            double reach) {
  std::vector<int> near;
  for (const int f : faces) {
    if (box.exteriorDistance(boundary.faces[f].box()) < reach) near.push_back(f);
  }
  return near;
}

/// Walls at some time, and which of them count as at rest then. Borrows the walls.
template <int Dim>
struct WallsAtRest {
  const Boundary<Dim>& boundary;
  const std::vector<std::uint8_t>& rests;  ///< by wall
};

/// Faces of other walls at rest within `reach` of an edge of a plate.
template <int Dim>
std::vector<int> faces_near_plate(const WallsAtRest<Dim>& walls, int plate, const std::vector<PlateEdge<Dim>>& edges,
                                  double reach) {
  const Boundary<Dim>& boundary = walls.boundary;
  EdgeBox<Dim> box;
  for (const PlateEdge<Dim>& edge : edges) box.extend(box_of(edge));
  std::vector<int> others;
  for (int f = 0; f < static_cast<int>(boundary.faces.size()); ++f) {
    const int wall = boundary.faces[f].wall;
    if (wall != plate && walls.rests[wall] != 0) others.push_back(f);
  }
  return faces_near<Dim>(boundary, others, box, reach);
}

/// Whether a gap is between two plates. Water passes it although it is narrower than half a spacing.
template <int Dim>
bool is_between_plates(const Boundary<Dim>& boundary, const Gap<Dim>& gap) {
  return boundary.walls[gap.wall].is_plate && boundary.walls[gap.other].is_plate;
}

/// A place of the narrow opening between an edge of a plate and a wall that is near along the whole edge. Walls beside
/// the plate do not count, as those of a flume at its top edge. `faces` are those that may be near.
template <int Dim>
std::optional<Gap<Dim>> narrow_gap_beyond(const Boundary<Dim>& boundary, const std::vector<int>& faces, int plate,
                                          const PlateEdge<Dim>& edge, double dx) {
  const std::vector<int> near = faces_near<Dim>(boundary, faces, box_of(edge), narrow * dx);
  std::optional<Gap<Dim>> widest;
  for (const Vec<Dim>& x : edge.points) {
    std::optional<Gap<Dim>> nearest;
    for (const int f : near) {
      const Vec<Dim> offset = closest_point(boundary.faces[f], x) - x;
      const double width = offset.norm();
      // A wall that touches the edge is on no side of it.
      const bool is_beside = width > narrowest_drawn * dx && offset.dot(edge.out) < min_beyond_edge * width;
      if (width >= narrow * dx || is_beside) continue;
      if (!nearest || width < nearest->width) nearest = Gap<Dim>{plate, boundary.faces[f].wall, width, x};
    }
    if (!nearest) return std::nullopt;
    if (!widest || nearest->width > widest->width) widest = nearest;
  }
  if (!widest) return std::nullopt;
  const double narrowest = is_between_plates(boundary, *widest) ? narrowest_between_plates : narrowest_drawn;
  if (widest->width <= narrowest * dx) return std::nullopt;
  return widest;
}

/// Whether two faces have a place in common, as at a corner between walls.
template <int Dim>
bool meet_somewhere(const WallFace<Dim>& face, const WallFace<Dim>& other, double tolerance) {
  const auto has_corner_on = [&](const WallFace<Dim>& a, const WallFace<Dim>& b) {
    return std::any_of(a.corners.begin(), a.corners.end(),
                       [&](const Vec<Dim>& x) { return (closest_point(b, x) - x).norm() <= tolerance; });
  };
  return has_corner_on(face, other) || has_corner_on(other, face);
}

/// The place of the gap where a face directly faces another that is near.
template <int Dim>
std::optional<Gap<Dim>> gap_between(const WallFace<Dim>& face, const WallFace<Dim>& other, double dx) {
  const double facing = -face.normal.dot(other.normal);
  if (facing < min_facing_of_gap || face.box().exteriorDistance(other.box()) >= narrow * dx) return std::nullopt;
  const double tolerance = corner_tolerance * dx;
  const int samples = samples_along(face, dx);
  std::optional<Gap<Dim>> narrowest;
  for (int k = 0; k < samples; ++k) {
    const Vec<Dim> foot = sample_of(face, k, samples);
    const double width = other.height(foot) / facing;
    if (width <= narrowest_drawn * dx || width >= (narrowest ? narrowest->width : narrow * dx)) continue;
    const Vec<Dim> hit = foot + width * face.normal;
    if ((closest_point(other, hit) - hit).norm() <= tolerance) {
      narrowest = Gap<Dim>{face.wall, other.wall, width, foot, true};
    }
  }
  if (narrowest && meet_somewhere(face, other, narrowest_drawn * dx)) return std::nullopt;
  return narrowest;
}

/// Gaps between walls, except walls of one body that are no plates: near a corner, and in a fold, these are as near.
template <int Dim>
std::vector<Gap<Dim>> gaps_of(const WallsAtRest<Dim>& walls, double dx) {
  const Boundary<Dim>& boundary = walls.boundary;
  std::vector<Gap<Dim>> gaps;
  for (const WallPlate& plate : boundary.plates) {
    const bool is_drawn_elsewhere = plate.sheet && boundary.walls[plate.wall].moves();  // edges_of
    if (walls.rests[plate.wall] == 0 || is_drawn_elsewhere) continue;
    const std::vector<PlateEdge<Dim>> edges = edges_of(boundary, plate, dx);
    const std::vector<int> faces = faces_near_plate<Dim>(walls, plate.wall, edges, narrow * dx);
    for (const PlateEdge<Dim>& edge : edges) {
      auto gap = closed_gap_beside<Dim>(boundary, plate.wall, edge, dx);
      if (!gap) gap = narrow_gap_beyond<Dim>(boundary, faces, plate.wall, edge, dx);
      if (gap) gaps.push_back(*gap);
    }
  }
  boundary.visit_plain_faces([&](int f) {
    const WallFace<Dim>& face = boundary.faces[f];
    if (walls.rests[face.wall] == 0) return;
    boundary.visit_plain_faces([&](int g) {
      const WallFace<Dim>& other = boundary.faces[g];
      if (other.wall == face.wall || walls.rests[other.wall] == 0) return;
      if (const auto gap = gap_between<Dim>(face, other, dx)) gaps.push_back(*gap);
    });
  });
  return gaps;
}

/// The walls where those on a path are at `time` [s].
template <int Dim>
Boundary<Dim> walls_at(const CaseSpec& spec, const Boundary<Dim>& drawn, double time) {
  Boundary<Dim> boundary = drawn;
  WallParticles<Dim> no_particles;
  const WallMotion<Dim> motion(spec, boundary, no_particles);
  motion.place(time, initial_motion<Dim>(spec), boundary, no_particles);
  return boundary;
}

/// Adds the gaps that a gate or another wall on a path leaves where it comes to rest before the end of the run, unless
/// they are as wide as when drawn: a piston may slide along a narrow gap.
template <int Dim>
void append_gaps_at_end(const CaseSpec& spec, const Boundary<Dim>& drawn, std::vector<Gap<Dim>>& gaps) {
  const double dx = spec.particles.spacing;
  std::vector<std::uint8_t> has_stopped(drawn.walls.size(), 0);
  for (std::size_t wall = 0; wall < drawn.walls.size(); ++wall) {
    const Drive::By by = spec.walls[wall].drive.by;
    has_stopped[wall] = drawn.walls[wall].moves() && by != Drive::By::body && by != Drive::By::wave_maker ? 1 : 0;
  }
  const auto has_any = [&] { return std::ranges::find(has_stopped, 1) != has_stopped.end(); };
  if (!has_any()) return;
  const Boundary<Dim> before = walls_at<Dim>(spec, drawn, start_of_rest * spec.time.end);
  const Boundary<Dim> end = walls_at<Dim>(spec, drawn, spec.time.end);
  for (std::size_t f = 0; f < end.faces.size(); ++f) {
    const WallFace<Dim>& face = end.faces[f];
    for (int c = 0; c < Dim; ++c) {
      const double way = (face.corners[c] - before.faces[f].corners[c]).norm();
      if (!(way < narrowest_drawn * dx)) has_stopped[face.wall] = 0;
    }
  }
  if (!has_any()) return;
  std::vector<std::uint8_t> rests = has_stopped;
  for (std::size_t wall = 0; wall < rests.size(); ++wall) rests[wall] |= drawn.walls[wall].moves() ? 0 : 1;
  const std::vector<Gap<Dim>> gaps_as_drawn = gaps_of<Dim>({drawn, rests}, dx);
  for (const Gap<Dim>& gap : gaps_of<Dim>({end, rests}, dx)) {
    const auto is_the_same = [&](const Gap<Dim>& other) {
      return other.wall == gap.wall && other.other == gap.other &&
             std::abs(other.width - gap.width) < narrowest_drawn * dx;
    };
    if (has_stopped[gap.wall] == 0 && has_stopped[gap.other] == 0) continue;
    if (std::ranges::none_of(gaps_as_drawn, is_the_same)) gaps.push_back(gap);
  }
}

/// `local` is the spacing in the gap [m]. Whether it counts as closed depends on that of the case (hang_screens).
template <int Dim>
Finding finding_of(const Boundary<Dim>& boundary, const Gap<Dim>& gap, double dx, double local) {
  const CaseLabel a = wall_label(boundary, gap.wall);
  const CaseLabel b = wall_label(boundary, gap.other);
  const Amount width{gap.width, "m"};
  const bool has_moved = boundary.walls[gap.wall].moves() || boundary.walls[gap.other].moves();
  const std::string_view when = has_moved ? " at the end of the run" : "";
  const double good_spacing = gap.width / rows_of_good_gap;
  if (gap.width <= closed * dx && is_between_plates(boundary, gap)) {
    return Finding::warning(
        "gap-between-plates",
        {"the gap of {:.3g} between {} and {} at {}{} is narrower than half a spacing, but water leaks through it, "
         "because the ends of plates close only at other walls or where they meet",
         width, a, b, place(gap.where), when},
        {"let the plates end at the same point, or use a spacing of at most {:.3g} m for an opening", good_spacing});
  }
  if (gap.width <= closed * dx) {
    return Finding::warning(
        "gap-closed",
        {"the gap of {:.3g} between {} and {} at {}{} counts as closed, because it is narrower than half a spacing",
         width, a, b, place(gap.where), when},
        {"let the walls touch, or use a spacing of at most {:.3g} m to let water pass", good_spacing});
  }
  return Finding::warning(
      "gap-few-rows",
      {"the gap of {:.3g} between {} and {} at {}{} is {:.1f} spacings wide, so too little water "
       "passes: under a plate above a bed about 20 % less with half a spacing, 9 % with one and 4 % with four",
       width, a, b, place(gap.where), when, gap.width / local},
      {"use a spacing of at most {:.3g} m", good_spacing});
}

/// Findings of force probes on one side of a narrow gap beside a plate. Wall particles behind the plate stand in the
/// place of water that would act on the wall across the gap, and pairs of wall particles are no force.
template <int Dim>
void report_forces_across(const CaseSpec& spec, const Boundary<Dim>& boundary, const Gap<Dim>& gap,
                          Findings& findings) {
  const bool is_beside_plate = boundary.walls[gap.wall].is_plate || boundary.walls[gap.other].is_plate;
  if (!gap.is_between_faces || !is_beside_plate) return;
  for (const ProbeTable& probe : spec.probes) {
    const auto reads = [&](int wall) { return std::ranges::count(probe.walls, boundary.walls[wall].name) > 0; };
    if (probe.type != ProbeType::force || reads(gap.wall) == reads(gap.other)) continue;
    findings.push_back(Finding::warning(
        "force-across-gap",
        {"{}: across the narrow gap at {} the probe cannot separate the forces on {} and {}: in a gap of 1, 2, 3 or 4 "
         "spacings, 37, 22, 12 or 3 % of the force on one side of the plate go to the wrong wall",
         label(probe), place(gap.where), wall_label(boundary, gap.wall), wall_label(boundary, gap.other)},
        {"let the probe read both walls, use wall-pressure probes, or use a spacing of at most {:.3g} m",
         gap.width / rows_of_good_gap}));
  }
}

}  // namespace

template <int Dim>
Findings check_closed_gaps(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const double dx = spec.particles.spacing;
  const SpacingField<Dim> field(spec, boundary);
  std::vector<std::uint8_t> rests;
  for (const WallProperties& wall : boundary.walls) rests.push_back(wall.moves() ? 0 : 1);
  std::vector<Gap<Dim>> gaps = gaps_of<Dim>({boundary, rests}, dx);
  append_gaps_at_end(spec, boundary, gaps);
  std::stable_sort(gaps.begin(), gaps.end(), [](const auto& a, const auto& b) { return a.width < b.width; });
  Findings findings;
  std::set<std::pair<int, int>> reported;
  for (const Gap<Dim>& gap : gaps) {
    const double local = dx * field.at(gap.where);
    if (gap.width > closed * dx && gap.width >= narrow * local) continue;
    if (!reported.insert(std::minmax(gap.wall, gap.other)).second) continue;
    findings.push_back(finding_of(boundary, gap, dx, local));
    if (gap.width > closed * dx) report_forces_across(spec, boundary, gap, findings);
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_closed_gaps);

}  // namespace tailwater
