// Keeps the volumes of the water's particles near those that the field of spacings asks for
// (refinement/spacing_field.h). Between steps a particle larger than 1.34 times its wanted volume becomes two of half
// its volume, and two neighbours that are together no larger than the wanted volume become one:
//
//   split   at x +- 0.27 V^(1/Dim) e, with u +- grad u . (0.27 V^(1/Dim) e), along the direction e of the widest gap
//   merge   at the centre of mass, with the momentum and the volume of both
//
// Volume, momentum and potential energy are exact. The change of the kinetic energy is recorded.
#pragma once

#include "flow/part.h"

namespace tailwater {

template <int Dim>
class Refinement final : public Part<Dim> {
 public:
  Refinement() = default;
  /// `first_id` is above all ids of particles of the start.
  explicit Refinement(std::int64_t first_id) : next_id_(first_id) {}

  std::int64_t splits() const { return splits_; }
  std::int64_t merges() const { return merges_; }
  /// J; by which splits and merges have changed the kinetic energy.
  double energy() const { return energy_; }

  std::string_view name() const override { return "refinement"; }
  Json save() const override;
  bool restore(const Json& saved) override;
  void adapt(Flow<Dim>& flow) override;
  void add_to_summary(const Flow<Dim>& flow, Json& summary) const override;

 private:
  std::int64_t next_id_ = 0;  ///< the same on all ranks
  std::int64_t splits_ = 0;
  std::int64_t merges_ = 0;
  double energy_ = 0.0;
};

/// Null without zones of refinement.
template <int Dim>
std::unique_ptr<Part<Dim>> make_refinement(const CaseSpec& spec, const Setup<Dim>& setup,
                                           const Boundary<Dim>& boundary);

}  // namespace tailwater
