// Fixed hulls, as a part of a flow: closed walls with water around them that are no bodies, such as a pipe on the bed.
// Where another wall is near such a hull, force probes get the integral of the pressure over its surface
// (narrow_gaps.h). Water that hulls seal has the pressure of that beyond the films (sealed_water.cpp). Other water is
// not changed.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "bodies/force_sums.h"
#include "bodies/hulls.h"
#include "bodies/narrow_gaps.h"
#include "flow/part.h"
#include "refinement/hulls_at_zones.h"

namespace tailwater {

template <int Dim>
class FixedHulls final : public Part<Dim> {
 public:
  FixedHulls() = default;  ///< none
  /// The walls in `hulls`, indices into Boundary::walls; `body_of_wall` has the body of each wall, or -1;
  /// `has_probes`, whether anything reads forces.
  FixedHulls(const Boundary<Dim>& boundary, std::vector<int> hulls, const std::vector<int>& body_of_wall,
             double spacing, bool has_probes);

  /// False where no wall is so near a hull that its force is not that of pairs, unless walls move.
  bool has_hulls() const { return !near_patches_.empty(); }

  std::string_view name() const override { return "fixed_hulls"; }
  bool changes_rows() const override { return sealed_.is_any(); }
  void begin(Flow<Dim>& flow) override;
  void claim(const Flow<Dim>& flow, std::span<Role> role) override;
  void write_rows(Flow<Dim>& flow) override;
  int pose(Flow<Dim>& flow, std::span<const Vec<Dim>> predicted, double dt) override;
  void stay(Flow<Dim>& flow) override;
  void correct(Flow<Dim>& flow, double dt) override;
  void project_again(Flow<Dim>& flow, const std::vector<double>& correction, double dt) override;
  void finish_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) override;

 private:
  Hulls<Dim> hulls(std::span<const WallPatch<Dim>> patches) const {
    return {.count = static_cast<int>(hulls_.size()),
            .of_wall = hull_of_wall_,
            .surfaces = surfaces_,
            .patches = patches,
            .can_stand = true,
            .reach = reach_of_shares};
  }
  /// The gaps beside these patches with their present water. Where nothing moves, all but the water is found once.
  NarrowGaps<Dim> find_gaps(const Flow<Dim>& flow, std::span<const WallPatch<Dim>> patches,
                            std::optional<NarrowGaps<Dim>>& at_rest) const;
  ForceSums<Dim> new_sums(const Flow<Dim>& flow) const;
  void report(Flow<Dim>& flow);
  void add_to_report(Flow<Dim>& flow, ForceSums<Dim>& sums) const;

  std::vector<int> hulls_;         ///< wall of each
  std::vector<int> hull_of_wall_;  ///< of each wall, or -1
  std::vector<ContactSurface<Dim>> surfaces_;
  std::vector<WallPatch<Dim>> all_patches_;   ///< of the hulls
  std::vector<WallPatch<Dim>> near_patches_;  ///< near other walls
  std::optional<NarrowGaps<Dim>> all_at_rest_;
  std::optional<NarrowGaps<Dim>> near_at_rest_;
  bool are_at_rest_ = false;  ///< whether no wall and no zone of refinement moves
  bool has_probes_ = false;
  bool can_seal_ = true;     ///< whether a hull touches another wall, or a film can be between them
  SealedWater sealed_;       ///< in this step
  bool has_report_ = false;  ///< whether a hull is in the report of this step
};

/// For the hulls that are outside of all zones of refinement; null if there are none.
template <int Dim>
std::unique_ptr<Part<Dim>> make_fixed_hulls(const CaseSpec& spec, const Setup<Dim>& setup,
                                            const Boundary<Dim>& boundary);

}  // namespace tailwater
