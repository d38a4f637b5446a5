// Walls that lie on each other and share the force of the water.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "base/box.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/some_walls.h"
#include "geometry/wall_label.h"
#include "geometry/wall_patches.h"

namespace tailwater {
namespace {

/// dx; walls that are not farther apart lie on each other.
constexpr double reach_of_other = 0.05;
constexpr double same_normal = 0.999;  // cosine between walls that face the same water

/// Whether the face of a wall lies on a place of another face, and faces the same water.
template <int Dim>
bool lies_on(const WallFace<Dim>& face, const WallFace<Dim>& own, const Vec<Dim>& x, double dx) {
  const Vec<Dim> away = x - closest_point(face, x);
  const Vec<Dim> along = away - away.dot(face.normal) * face.normal;
  return face.normal.dot(own.normal) > same_normal && along.norm() < corner_tolerance * dx;
}

/// The common part of two walls.
template <int Dim>
struct CommonPart {
  double measure = 0.0;  ///< m or m^2
  Vec<Dim> at;
};

/// The parts of walls that a probe names on which walls that it does not name lie, by both walls.
template <int Dim>
std::map<std::pair<int, int>, CommonPart<Dim>> common_parts(const ProbeTable& probe, const Boundary<Dim>& drawn,
                                                            const std::vector<WallPatch<Dim>>& patches, double dx) {
  std::map<std::pair<int, int>, CommonPart<Dim>> parts;
  const auto is_named = [&](const WallProperties& wall) {
    return std::ranges::find(probe.walls, wall.name) != probe.walls.end();
  };
  std::map<int, std::vector<std::uint8_t>> others;  // by body: walls that the probe does not name
  std::map<int, Box<Dim>> around;                   // by body: the box around these walls
  for (std::size_t w = 0; w < drawn.walls.size(); ++w) {
    const WallProperties& wall = drawn.walls[w];
    if (is_named(wall) || wall.is_duct || wall.is_plate) continue;
    others.try_emplace(wall.body, drawn.walls.size(), 0).first->second[w] = 1;
  }
  for (const WallFace<Dim>& face : drawn.faces) {
    const int body = drawn.walls[face.wall].body;
    if (others.contains(body) && others[body][face.wall] != 0) around[body].extend(face.box());
  }
  for (auto& [body, box] : around) box.widen(reach_of_other * dx);
  for (const WallPatch<Dim>& patch : patches) {
    const WallFace<Dim>& own = drawn.faces[patch.face];
    const WallProperties& wall = drawn.walls[own.wall];
    if (!is_named(wall) || wall.is_plate || !around.contains(wall.body)) continue;
    const Vec<Dim> x = patch.centre(drawn);
    if (!around[wall.body].contains(x)) continue;
    const NearestWall<Dim> other = nearest_among<Dim>(drawn, others[wall.body], x, reach_of_other * dx);
    if (other.face < 0 || !lies_on(drawn.faces[other.face], own, x, dx)) continue;
    const Vec<Dim> before = x + 0.5 * dx * own.normal;
    if (drawn.nearest(before, std::numeric_limits<double>::infinity()).signed_distance < 0.0) continue;
    CommonPart<Dim>& part = parts[{own.wall, drawn.faces[other.face].wall}];
    if (part.measure == 0.0) part.at = x;
    part.measure += patch.measure;
  }
  return parts;
}

}  // namespace

template <int Dim>
Findings check_shared_force(const CaseSpec& spec, const Boundary<Dim>& drawn) {
  Findings findings;
  const double dx = spec.particles.spacing;
  std::vector<WallPatch<Dim>> patches;
  for (const ProbeTable& probe : spec.probes) {
    if (probe.type != ProbeType::force || probe.walls.empty()) continue;
    if (patches.empty()) patches = make_wall_patches(drawn, longest_patch_edge * dx);
    for (const auto& [walls, part] : common_parts(probe, drawn, patches, dx)) {
      findings.push_back(
          Finding::warning("walls-share-force",
                           {"{} names {} but not {}, which lies on it over {:.4g} from {} on: the two share the force "
                            "of the water there",
                            label(probe), wall_label(drawn, walls.first), wall_label(drawn, walls.second),
                            Amount{part.measure, Dim == 2 ? "m" : "m^2"}, place(part.at)},
                           {"name both walls, or leave their common part out of one of them"}));
    }
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_shared_force);

}  // namespace tailwater
