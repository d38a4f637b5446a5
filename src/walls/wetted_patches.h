// Parts of patches of walls that border on water. A hull is a closed wall that water surrounds. It may stand on another
// wall or in it, as a pile does in a bed. The part of its surface there then has no water, nor has the bed below the
// hull or inside it. Other walls may go on behind each other, as a bed beyond the sides of a tank. Only the places of
// particles show which of them has water, because a thin dam may consist of two such walls back to back.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "base/box.h"
#include "case/spec.h"
#include "geometry/images.h"
#include "geometry/some_walls.h"
#include "geometry/wall_patches.h"
#include "neighbours/cell_grid.h"

namespace tailwater {

template <int Dim>
class WettedPatches {
 public:
  /// `relative_spacing` is the spacing of particles at each patch, over that of the case; no edge is longer than
  /// `longest_patch_edge` of it. `reach` [m] is that of the grid. Patches twice as far behind other walls may count as
  /// wet.
  WettedPatches(const CaseSpec& spec, const Boundary<Dim>& boundary, std::vector<double> relative_spacing,
                double reach);

  /// Determines the parts at the present places of the faces. A moving hull may have left the domain at a periodic end.
  void place(const Boundary<Dim>& boundary, std::span<const WallPatch<Dim>> patches);

  /// m; of the wet part of each patch, or of a dry patch.
  const std::vector<Vec<Dim>>& centres() const { return centres_; }
  /// Fraction of a patch that is in front of all other walls.
  double share(std::int32_t patch) const { return share_[patch]; }
  /// Whether the patch is behind another wall, neither of them a hull, and borders on water only if it sees some.
  bool may_be_hidden(std::int32_t patch) const { return is_behind_open_[patch] != 0; }
  /// Whether no other such wall is between two places.
  bool sees(const Boundary<Dim>& boundary, int wall, const Vec<Dim>& from, const Vec<Dim>& to) const {
    return !is_crossed<Dim>(boundary, open_others_[wall], from, to, 1e-3 * spacing_);
  }
  /// Calls visit(image) for x, and for its images in other periods that are within reach of patches.
  template <class Visit>
  void visit_images_of(const Vec<Dim>& x, Visit&& visit) const {
    visit(x);
    visit_images<Dim>(domain_, Box<Dim>(x), around_, [&](const Vec<Dim>& moved) { visit(Vec<Dim>(x + moved)); });
  }
  /// The wet part of a patch.
  struct WetPart {
    Vec<Dim> centre;
    Vec<Dim> normal;
    double measure;      ///< m or m^2; 0 if the patch is dry
    std::int32_t patch;  ///< index
  };

  /// Calls visit(part, offset) for each part that is near an image of x, with the offset of that image from its centre.
  template <class Visit>
  void visit_near(const Vec<Dim>& x, Visit&& visit) const {
    visit_images_of(x, [&](const Vec<Dim>& image) {
      grid_.for_each_range_near(image, image, reach_, [&](std::int32_t begin, std::int32_t end) {
        for (std::int32_t n = begin; n < end; ++n) {
          if (parts_[n].measure > 0.0) visit(parts_[n], Vec<Dim>(image - parts_[n].centre));
        }
      });
    });
  }
  /// Calls visit(k, place) for each patch k that is not dry and near an image of the box. The place of its centre is
  /// relative to that image.
  template <class Visit>
  void visit_near(const Box<Dim>& box, Visit&& visit) const {
    const auto visit_image = [&](const Vec<Dim>& moved) {
      grid_.for_each_range_near(box.min() + moved, box.max() + moved, reach_,
                                [&](std::int32_t begin, std::int32_t end) {
                                  for (std::int32_t n = begin; n < end; ++n) {
                                    if (parts_[n].measure > 0.0)
                                      visit(parts_[n].patch, Vec<Dim>(parts_[n].centre - moved));
                                  }
                                });
    };
    visit_image(Vec<Dim>::Zero());
    visit_images<Dim>(domain_, box, around_, visit_image);
  }
  double reach() const { return reach_; }

 private:
  /// Walls that a place may be behind: a hull, or all walls that are no hulls.
  struct Others {
    int hull;                         ///< index into Boundary::walls, or -1
    std::vector<std::uint8_t> walls;  ///< by wall, whether it belongs to them
    Box<Dim> around = {};             ///< contains all places whose distance from them matters
  };

  NearestWall<Dim> nearest(const Boundary<Dim>& boundary, const Others& others, const Vec<Dim>& x) const;

  void find_behind_open(const Boundary<Dim>& boundary, std::span<const WallPatch<Dim>> patches);
  void find_part(const Boundary<Dim>& boundary, const WallPatch<Dim>& patch, std::size_t k);
  bool lies_on(int wall, int other) const;
  std::vector<std::uint8_t> find_covered_walls(const Boundary<Dim>& boundary) const;
  std::pair<std::int32_t, Vec<Dim>> patch_under(const Boundary<Dim>& boundary, std::span<const WallPatch<Dim>> patches,
                                                const std::vector<std::int32_t>& facing, const Vec<Dim>& place) const;
  std::vector<std::int32_t> patches_facing(const Boundary<Dim>& boundary, std::span<const WallPatch<Dim>> patches,
                                           std::int32_t k) const;
  double height_above_other_hulls(const Boundary<Dim>& boundary, const WallFace<Dim>& face, const Vec<Dim>& x) const;
  bool take_covered(const Boundary<Dim>& boundary, std::span<const WallPatch<Dim>> patches);

  PeriodicDomain<Dim> domain_;
  double spacing_;                        ///< m; of the case
  std::vector<double> relative_spacing_;  ///< by patch
  double reach_;
  std::vector<std::uint8_t> is_hull_;  ///< by wall
  std::vector<Others> others_;         ///< empty without hulls
  /// For each wall at rest that is no hull, the others of its kind, by wall; empty for other walls.
  std::vector<std::vector<std::uint8_t>> open_others_;
  std::vector<std::uint8_t> is_behind_open_;  ///< by patch
  /// The part of a patch that another such wall leaves, where it cuts one.
  struct OpenPart {
    Vec<Dim> centre;
    double share;
  };
  std::map<std::size_t, OpenPart> beside_open_;  ///< by patch
  std::vector<Vec<Dim>> centres_;
  std::vector<double> share_;
  CellGrid<Dim> grid_;          ///< the centres by place
  std::vector<WetPart> parts_;  ///< in the order of the grid
  Box<Dim> around_;             ///< contains all places within reach of the centres
};

}  // namespace tailwater
