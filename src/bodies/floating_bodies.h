// Floating bodies with their moorings, as a part of a flow. Their motion is solved for together with the pressure
// (coupling.h). Their positions belong to the state of the flow, because bodies are moving walls.
#pragma once

#include <vector>

#include "bodies/hulls.h"
#include "bodies/sealed_water.h"
#include "flow/flow.h"
#include "flow/part.h"
#include "geometry/wall_patches.h"
#include "motion/body_contact.h"
#include "operators/support_operators.h"

namespace tailwater {

template <int Dim>
class NarrowGaps;

template <int Dim>
class FloatingBodies final : public Part<Dim> {
 public:
  FloatingBodies() = default;  ///< no bodies
  FloatingBodies(const CaseSpec& spec, const Setup<Dim>& setup, const Boundary<Dim>& boundary);

  // Properties of the case.
  std::vector<FloatingBody<Dim>> bodies;
  std::vector<Mooring<Dim>> moorings;
  std::vector<int> body_of_wall;  ///< index into `bodies` of each wall, or -1
  ContactSurfaces<Dim> contact;
  std::vector<WallPatch<Dim>> patches;  ///< of all bodies, at most dx long; they move with their faces

  // Data of the present step.
  std::vector<Twist<Dim>> start_velocity;  ///< of each body
  std::vector<std::size_t> stagnant;       ///< owned water that rests in narrow gaps
  bool has_stagnant_water = false;         ///< on any rank
  SealedWater sealed;                      ///< by the bodies
  /// For each body: 1 without other walls within 3 dx, 0 in gaps up to 2 dx and out of the water.
  std::vector<double> clearance;
  std::vector<Twist<Dim>> error_of_pairs;  ///< of each body, in the force of the balanced pressure
  /// Whether a body has fallen below all other walls, and nothing can bring it back; for each body. In free fall it
  /// would shorten the time step of all water, so it stops there and takes no further part.
  std::vector<bool> is_lost;

  /// Finds `error_of_pairs` and `clearance` at the present positions, with the gaps beside bodies. Collective.
  void find_errors_of_pairs(const Flow<Dim>& flow, const NarrowGaps<Dim>& gaps);
  /// Degrees of freedom of all bodies that are not lost.
  std::size_t freedom_count() const;
  Hulls<Dim> hulls() const {
    return {.count = static_cast<int>(bodies.size()),
            .of_wall = body_of_wall,
            .surfaces = contact.each,
            .patches = patches};
  }
  /// Sets the velocity of each body after a step of dt with its present acceleration.
  void steer(Flow<Dim>& flow, double dt) const;

  std::string_view name() const override { return "bodies"; }
  bool needs_wall_forces() const override { return true; }
  bool changes_rows() const override { return has_stagnant_water || sealed.is_any(); }
  StepLimits step_limits(const Flow<Dim>& flow) const override;
  double lowest_unbalanced(const Flow<Dim>& flow, const Vec<Dim>& down) const override;
  void claim(const Flow<Dim>& flow, std::span<Role> role) override;
  /// Starts with the acceleration of the last step.
  void begin_step(Flow<Dim>& flow, double dt) override;
  void write_rows(Flow<Dim>& flow) override;
  std::unique_ptr<CoupledUnknowns> couple(Flow<Dim>& flow, const PosedEquation& equation,
                                          WallDrive<Dim>& drive) override;
  void add_work(const Flow<Dim>& flow, const std::vector<double>& on_walls, double dt, Works& works) const override;
  /// The impulses of the second projection's pressure reach the bodies in the next step.
  void project_again(Flow<Dim>& flow, const std::vector<double>& correction, double dt) override;
  void stay(Flow<Dim>& flow) override;
  /// The impulses that the last guard took from the water in front of bodies reach them in the next step.
  void finish_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) override;
  void warn(const Flow<Dim>& flow) override;

 private:
  /// Whether the body falls freely below all walls that belong to no body.
  bool is_below_all_walls(const Flow<Dim>& flow, std::size_t b) const;

  /// Whether the body is nearer to the end of a period than a support of the kernel, without reaching from end to end.
  bool is_at_end_of_period(const Flow<Dim>& flow, std::size_t b) const;

  std::vector<bool> is_told_;         ///< of each body, whether it was reported as lost
  std::vector<bool> is_told_of_end_;  ///< of each body, whether it was reported to be at the end of a period
};

template <int Dim>
const FloatingBodies<Dim>& bodies_of(const Flow<Dim>& flow) {
  return flow.template part<FloatingBodies<Dim>>();
}

/// Calls visit(j, force [N]) for the force of water particle i on each particle j by their pair.
template <int Dim, class Visit>
void visit_pair_forces(const Flow<Dim>& flow, std::size_t i, const std::vector<double>& pressure, Visit&& visit) {
  const Particles<Dim>& particles = flow.state.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  const SupportTerms<Dim>& terms = flow.surroundings.support_terms;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = static_cast<std::size_t>(pairs.j[k]);
    const double sum = inverse_reference(terms, i) * pressure[i] + inverse_reference(terms, j) * pressure[j];
    const double strength = particles.volume[i] * particles.volume[j] * sum;
    visit(j, Vec<Dim>(strength * flow.surroundings.pair_vectors.at(pairs, i, k)));
  }
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_floating_bodies(const CaseSpec& spec, const Setup<Dim>& setup,
                                                const Boundary<Dim>& boundary);

}  // namespace tailwater
