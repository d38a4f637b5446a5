// Counts the water that passes the sections of discharge probes: particles times their volumes, with sign. Water also
// passes where particles beside a section split or merge.
#pragma once

#include <vector>

#include "flow/part.h"
#include "geometry/opening.h"

namespace tailwater {

template <int Dim>
class SectionCounters final : public Part<Dim> {
 public:
  SectionCounters() = default;
  explicit SectionCounters(std::vector<Opening<Dim>> sections)
      : sections_(std::move(sections)), volumes_(sections_.size(), 0.0) {}

  const std::vector<Opening<Dim>>& sections() const { return sections_; }
  /// m^Dim; net volume that has passed each section since the start
  const std::vector<double>& volumes() const { return volumes_; }

  std::string_view name() const override { return "sections"; }
  Json save() const override;
  bool restore(const Json& saved) override;
  void add_to_summary(const Flow<Dim>& flow, Json& summary) const override;
  void follow_moved_water(const Flow<Dim>& flow, std::span<const MovedWater<Dim>> moved) override;
  void finish_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) override;

 private:
  std::vector<Opening<Dim>> sections_;  ///< one per discharge probe
  std::vector<double> volumes_;
};

template <int Dim>
std::unique_ptr<Part<Dim>> make_section_counters(const CaseSpec& spec, const Setup<Dim>& setup,
                                                 const Boundary<Dim>& boundary);

}  // namespace tailwater
