#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "case/formulation.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"
#include "parallel/at_start.h"
#include "refinement/spacing_field.h"
#include "sampling/wall_particles.h"

namespace tailwater {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The expected places of the first particles in front of a wall, for the spacing of the case.
struct Standing {
  double regular;   ///< dx from the wall
  double least;     ///< m; nearer is too near
  double gap_from;  ///< m; farther is a gap
  double gap_to;    ///< m; from here on the fluid is away from the wall on purpose
};

Standing standing(const CaseSpec& spec) {
  const double dx = spec.particles.spacing;
  const double regular = traits_of(spec).walls.on_wall ? 1.0 : 0.5;
  const double play = std::max(0.25, spec.particles.jitter) + corner_tolerance;
  return {regular, (0.5 - play) * dx, (regular + play) * dx, (regular + 1.5) * dx};
}

/// The particles of one block beside one wall.
template <int Dim>
struct Contact {
  std::size_t in_front = 0;
  std::size_t behind = 0;
  std::size_t too_near = 0;
  double deepest = 0.0;        ///< m behind the wall, positive
  double nearest = unlimited;  ///< m in front of it
  Vec<Dim> deepest_at, nearest_at;

  /// If two places are equally near or deep, the first one counts.
  void add(const Contact& later) {
    in_front += later.in_front;
    behind += later.behind;
    too_near += later.too_near;
    if (later.deepest > deepest) {
      deepest = later.deepest;
      deepest_at = later.deepest_at;
    }
    if (later.nearest < nearest) {
      nearest = later.nearest;
      nearest_at = later.nearest_at;
    }
  }
};

/// Distance of a block from a face that it is straight in front of.
template <int Dim>
struct Approach {
  double distance = unlimited;  ///< m
  Vec<Dim> at;

  void add(const Approach& later) {
    if (later.distance < distance) *this = later;
  }
};

/// Whether a face is short, as the faces of a round wall. Each has few particles in front of it, of which the nearest
/// may stand anywhere up to a cell's diagonal away. A gap is then a property of the wall as a whole.
template <int Dim>
bool is_short(const WallFace<Dim>& face, double dx) {
  constexpr double long_enough = 2.0;  // dx
  return Dim == 2 && (face.corners[1] - face.corners[0]).norm() < long_enough * dx;
}

/// The least distance [m] at a place in a zone. Particles keep off walls by the spacing in the middle of their cells,
/// which differs by up to a fifth in a border.
template <int Dim>
double min_in(const SpacingField<Dim>& field, double least, const Vec<Dim>& x) {
  constexpr double change_in_cell = 0.8;
  const double relative = field.at(x);
  return relative < 1.0 ? change_in_cell * relative * least : least;
}

/// The results of all ranks, by the same keys.
template <class Found>
std::map<std::pair<int, int>, Found> together(const Communicator& ranks,
                                              const std::map<std::pair<int, int>, Found>& own) {
  struct Entry {
    int first, second;  // a pair is no plain value
    Found found;
  };
  std::vector<Entry> entries;
  for (const auto& [key, found] : own) entries.push_back({key.first, key.second, found});
  std::map<std::pair<int, int>, Found> all;
  for (const Entry& entry : gather_on_all(ranks, entries)) all[{entry.first, entry.second}].add(entry.found);
  return all;
}

/// The positions of the fluid beside the walls.
template <int Dim>
struct Contacts {
  std::map<std::pair<int, int>, Contact<Dim>> by_wall;   ///< by wall and block
  std::map<std::pair<int, int>, Approach<Dim>> by_face;  ///< by face and block
};

/// `least` [m]: nearer is too near at the spacing of the case. `far` [m]: particles farther in front of all walls do
/// not matter.
template <int Dim>
Contacts<Dim> contacts_of(const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid,
                          const SpacingField<Dim>& field, double least, double far, double dx) {
  Contacts<Dim> contacts;
  Vec<Dim> open = Vec<Dim>::Zero();  // a place in front of the walls, none of which is nearer than `clear` [m]
  double clear = 0.0;
  std::vector<bool> is_sheet(boundary.walls.size(), false);
  for (const WallPlate& plate : boundary.plates) is_sheet[plate.wall] = plate.sheet != nullptr;
  for (std::size_t i = 0; i < fluid.position.size(); ++i) {
    const Vec<Dim>& x = fluid.position[i];
    if ((x - open).norm() < clear - far) continue;
    const NearestWall<Dim> near = boundary.nearest(x, unlimited);
    if (near.signed_distance > 0.0) {
      open = x;
      clear = near.signed_distance;
    }
    const double height = boundary.faces[near.face].height(x);
    const int wall = boundary.faces[near.face].wall;
    Contact<Dim>& contact = contacts.by_wall[{wall, fluid.block[i]}];
    // Beyond a free end of a wall the sign is undefined. Only places straight in front of or behind a face count.
    const bool is_square = std::abs(std::abs(near.signed_distance) - std::abs(height)) < corner_tolerance * dx;
    if (near.signed_distance >= 0.0) {
      contact.in_front += is_square ? 1 : 0;
      contact.too_near += near.signed_distance < min_in(field, least, x) ? 1 : 0;
      if (near.signed_distance < contact.nearest) {
        contact.nearest = near.signed_distance;
        contact.nearest_at = x;
      }
      // The particles nearest to a small triangle of a mesh may all be farther away than those beside it.
      if (!is_square || is_sheet[wall] || boundary.mesh_of(near.face) != nullptr) continue;
      if (is_short(boundary.faces[near.face], dx)) continue;
      Approach<Dim>& approach = contacts.by_face[{near.face, fluid.block[i]}];
      if (near.signed_distance < approach.distance) approach = {near.signed_distance, x};
    } else if (is_square) {
      ++contact.behind;
      if (-near.signed_distance > contact.deepest) {
        contact.deepest = -near.signed_distance;
        contact.deepest_at = x;
      }
    }
  }
  return {together(fluid.ranks, contacts.by_wall), together(fluid.ranks, contacts.by_face)};
}

}  // namespace

template <int Dim>
Findings check_fluid_at_walls(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  if (boundary.faces.empty()) return {};
  const double dx = spec.particles.spacing;
  const auto [regular, least, gap_from, gap_to] = standing(spec);
  const SpacingField<Dim> field(spec, boundary);
  const Contacts<Dim> contacts = contacts_of(boundary, fluid, field, least, gap_to, dx);
  std::vector<std::size_t> in_front(boundary.walls.size(), 0);
  for (const auto& [key, contact] : contacts.by_wall) in_front[key.first] += contact.in_front;
  Findings findings;
  for (const auto& [key, contact] : contacts.by_wall) {
    const CaseLabel wall = wall_label(boundary, key.first);
    const CaseLabel block = fluid_label(spec, key.second);
    if (contact.behind > 0 && in_front[key.first] > 0) {
      findings.push_back(
          Finding::error("water-on-both-sides",
                         {"{} has fluid on both sides: {} particles of {} lie behind it, up to {:.6g} deep at {}", wall,
                          contact.behind, block, Amount{contact.deepest, "m"}, place(contact.deepest_at)},
                         {"end the block on the bed (shape = \"polygon\"), or draw a wall that stands in water with "
                          "two faces at least {} spacings apart",
                          dummy_layers(spec) + 1}));
    } else if (contact.behind > 0) {
      findings.push_back(Finding::error("water-behind-wall",
                                        {"{} lies behind {}: {} particles, up to {:.6g} deep at {}", block, wall,
                                         contact.behind, Amount{contact.deepest, "m"}, place(contact.deepest_at)},
                                        {"give the wall the other fluid_side, or move the block"}));
    }
    if (contact.too_near > 0) {
      findings.push_back(
          Finding::error("water-too-near-wall",
                         {"{} is too near to {}: {} particles are nearer than {:.6g} m, the nearest {:.3g} at {}",
                          block, wall, contact.too_near, min_in(field, least, contact.nearest_at),
                          Amount{contact.nearest, "m"}, place(contact.nearest_at)},
                         {"put the block's edge on the wall or a whole number of spacings ({:.6g} m) from it", dx}));
    }
  }
  std::set<std::pair<int, int>> reported;  // wall and block
  const auto report_gap = [&, gap_from = gap_from, gap_to = gap_to, regular = regular](
                              int wall, int block, double distance, const Vec<Dim>& at) {
    const bool is_gap = distance > gap_from && distance < gap_to;
    if (!is_gap || !reported.insert({wall, block}).second) return;
    findings.push_back(Finding::warning(
        "water-leaves-gap-at-wall",
        {"water may enter the gap between {} and {}: the nearest particle is {:.2f} from the wall, at {}, not {:.2f}",
         fluid_label(spec, block), wall_label(boundary, wall), Amount{distance / dx, "spacings"}, place(at), regular},
        {"put the block's edge on the wall, or at least two spacings away from it"}));
  };
  for (const auto& [key, approach] : contacts.by_face) {
    report_gap(boundary.faces[key.first].wall, key.second, approach.distance, approach.at);
  }
  std::vector<bool> is_round(boundary.walls.size(), false);
  for (const WallFace<Dim>& face : boundary.faces) is_round[face.wall] = is_short(face, dx);
  for (const WallFace<Dim>& face : boundary.faces) {
    if (!is_short(face, dx)) is_round[face.wall] = false;
  }
  for (const auto& [key, contact] : contacts.by_wall) {
    if (is_round[key.first] && contact.in_front > 0)
      report_gap(key.first, key.second, contact.nearest, contact.nearest_at);
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_fluid_at_walls);

}  // namespace tailwater
