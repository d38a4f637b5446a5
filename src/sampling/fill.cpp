#include "sampling/fill.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/box.h"
#include "geometry/face_grid.h"
#include "geometry/from_spec.h"
#include "geometry/opening.h"
#include "geometry/wall_label.h"

namespace tailwater {
namespace {

/// [dx]; openings may be drawn far too large: parts farther than this beyond the box around all walls are ignored.
constexpr double beyond_walls = 100.0;

template <int Dim>
class Fill {
 public:
  Fill(const CaseSpec& spec, const FluidTable& block, const CaseLabel& owner, const Boundary<Dim>& boundary,
       const Lattice<Dim>& lattice)
      : owner_(owner),
        boundary_(boundary),
        lattice_(lattice),
        dx_(spec.particles.spacing),
        tolerance_(mesh_tolerance * dx_),
        seed_(to_vec<Dim>(block.seed, owner, "seed")),
        level_(block.level),
        near_(2.0 * dx_) {
    boundary.visit_plain_faces([&](int f) { file(boundary.faces[f], boundary.faces[f].box()); });
    box_ = box_around(boundary.faces);
    Box<Dim> around = box_;
    around.widen(beyond_walls * dx_);
    for (const Opening<Dim>& end : make_open_ends<Dim>(spec)) {
      for (const WallFace<Dim>& face : end.as_faces()) {
        const Box<Dim> box = face.box().intersection(around);
        if (box.isEmpty()) continue;
        file(face, box);
        box_.extend(box);
      }
    }
    for (int axis = 0; axis < Dim; ++axis) {
      const std::vector<double>& range = periodic_range(spec.domain, axis);
      if (range.size() == 2) {
        period_[axis] = lattice[axis].count();
        box_.extend(Vec<Dim>(range[0] * Vec<Dim>::Unit(axis)));
        box_.max()[Dim - 1] = std::max(box_.max()[Dim - 1], level_);  // without side walls the level is above all walls
      }
    }
  }

  CellSet<Dim> run() {
    require_sound_seed();
    reached_ = CellSet<Dim>(corner_of(-1), corner_of(1));
    // Only the cells that the water has just reached are listed.
    std::vector<Cell<Dim>> front{first_cell()};
    while (!front.empty()) {
      std::vector<Cell<Dim>> beyond;
      for (const Cell<Dim>& cell : front) spread_from(cell, beyond);
      front = std::move(beyond);
    }
    return std::move(reached_);
  }

 private:
  /// So that it is found in a box.
  void file(const WallFace<Dim>& face, const Box<Dim>& box) {
    near_.add(static_cast<int>(plain_.size()), box.min(), box.max(),
              [&](const Vec<Dim>& x) { return (closest_point(face, x) - x).norm(); });
    plain_.push_back(face);
  }

  Vec<Dim> centre(const Cell<Dim>& cell) const {
    Vec<Dim> x;
    for (int axis = 0; axis < Dim; ++axis) x[axis] = lattice_[axis].centre(static_cast<int>(cell[axis]));
    return x;
  }

  /// Whether water gets from one place to a near one.
  bool is_open(const Vec<Dim>& from, const Vec<Dim>& to) const {
    if (to[Dim - 1] > level_) return false;
    for (const int f : near_.near(from)) {
      const WallFace<Dim>& face = plain_[f];
      if ((face.height(from) >= 0.0) == (face.height(to) >= 0.0)) continue;
      const Vec<Dim> hit = meet(face, from, to);
      if ((closest_point(face, hit) - hit).norm() <= tolerance_) return false;
    }
    // A line that begins in front of a mesh ends no farther behind it than it is long.
    const double length = (to - from).norm();
    const auto is_behind = [&](const WallMesh& mesh) { return boundary_.height_above(mesh, to, length) < 0.0; };
    return std::ranges::none_of(boundary_.meshes, is_behind);
  }

  void require_sound_seed() const {
    if (seed_[Dim - 1] >= level_) {
      throw CaseError("fill-seed-above-level",
                      {"{}: seed {} is not below level = {:.6g}", owner_, place(seed_), level_},
                      {"move the seed below the level, or raise the level"});
    }
    const NearestWall<Dim> wall = boundary_.nearest(seed_, std::numeric_limits<double>::infinity());
    if (wall.face < 0) {
      throw CaseError("fill-without-walls", {"{} = \"fill\" needs walls that hold the water", owner_.with_key("shape")},
                      {"draw them, or use a box"});
    }
    if (wall.signed_distance < 0.0) {
      throw CaseError("fill-seed-in-wall",
                      {"{}: seed {} is in {}, {:.6g} behind its surface at {}", owner_, place(seed_),
                       wall_label(boundary_, boundary_.faces[wall.face].wall), Amount{-wall.signed_distance, "m"},
                       place(wall.point)},
                      {"move it into the water, or give the wall the other fluid_side"});
    }
  }

  Cell<Dim> cell_at(const Vec<Dim>& x) const {
    Cell<Dim> cell;
    for (int axis = 0; axis < Dim; ++axis) cell[axis] = lattice_[axis].cell_at(x[axis]);
    return cell;
  }

  /// The lowest cell that the water may reach, for `side` -1, or the highest, for 1. A seed is tried with the cells
  /// around its own.
  Cell<Dim> corner_of(int side) const {
    Box<Dim> box = box_;
    box.max()[Dim - 1] = std::min(box.max()[Dim - 1], level_);
    box.extend(seed_);
    Cell<Dim> corner = cell_at(side < 0 ? box.min() : box.max());
    for (std::int64_t& number : corner) number += side;
    return corner;
  }

  void spread_from(const Cell<Dim>& cell, std::vector<Cell<Dim>>& beyond) {
    const Vec<Dim> here = centre(cell);
    for (int move = 0; move < 2 * Dim; ++move) {
      Cell<Dim> next = cell;
      next[move / 2] += move % 2 == 0 ? -1 : 1;
      if (!is_open(here, centre(next))) continue;
      if (period_[move / 2] > 0) next[move / 2] = (next[move / 2] + period_[move / 2]) % period_[move / 2];
      require_inside(centre(next), here);
      if (reached_.add(next)) beyond.push_back(next);
    }
  }

  Cell<Dim> first_cell() {
    std::optional<Cell<Dim>> first;
    for_each_around<Dim>(cell_at(seed_), [&](const Cell<Dim>& cell) {
      if (!first && is_open(seed_, centre(cell))) first = cell;
    });
    if (first) {
      reached_.add(*first);
      return *first;
    }
    throw CaseError("fill-seed-without-space",
                    {"{}: there is no space for a particle of spacing {:.6g} m at seed {}", owner_, dx_, place(seed_)},
                    {"move it away from the walls, or use a smaller spacing"});
  }

  /// Water outside the box around all walls has left the case.
  void require_inside(const Vec<Dim>& x, const Vec<Dim>& last) const {
    if (box_.exteriorDistance(x) <= tolerance_) return;
    const NearestWall<Dim> wall = boundary_.nearest(last, std::numeric_limits<double>::infinity());
    throw CaseError(
        "fill-runs-out",
        {"{}: water at level = {:.6g} runs out of the case at {}, near {}: the level is above the rim there, "
         "or the walls have a gap",
         owner_, level_, place(last), wall_label(boundary_, boundary_.faces[wall.face].wall)},
        {"lower the level, or close the walls"});
  }

  const CaseLabel& owner_;
  const Boundary<Dim>& boundary_;
  const Lattice<Dim>& lattice_;
  double dx_, tolerance_;
  Vec<Dim> seed_;
  double level_;
  std::vector<WallFace<Dim>> plain_;  ///< faces of walls that are no meshes, and of open ends
  FaceGrid<Dim> near_;
  Box<Dim> box_;
  std::array<int, Dim> period_{};  ///< cells after which an axis repeats; 0: never
  CellSet<Dim> reached_;
};

}  // namespace

template <int Dim>
CellSet<Dim> filled_cells(const CaseSpec& spec, const FluidTable& block, const CaseLabel& owner,
                          const Boundary<Dim>& boundary, const Lattice<Dim>& lattice) {
  return Fill<Dim>(spec, block, owner, boundary, lattice).run();
}

TAILWATER_IN_2D_AND_3D(filled_cells);

}  // namespace tailwater
