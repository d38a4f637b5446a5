// Ends a run whose fluid has come to rest, a part of a flow. The fluid must have been faster than `time.end_at_rest`
// once, and then slower for a hundredth of `time.end`.
#pragma once

#include <memory>
#include <optional>

#include "flow/part.h"

namespace tailwater {

template <int Dim>
class RestWatch final : public Part<Dim> {
 public:
  RestWatch() = default;
  RestWatch(double speed, double duration) : speed_(speed), duration_(duration) {}

  bool is_at_rest() const { return is_at_rest_; }

  std::string_view name() const override { return "rest_watch"; }
  Json save() const override;
  bool restore(const Json& saved) override;
  void finish_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) override;
  void add_to_summary(const Flow<Dim>& flow, Json& summary) const override;

 private:
  double speed_ = 0.0;     ///< m/s
  double duration_ = 0.0;  ///< s
  bool has_moved_ = false;
  std::optional<double> slow_since_;  ///< s
  bool is_at_rest_ = false;
};

/// Null if the case ends at a time alone.
template <int Dim>
std::unique_ptr<Part<Dim>> make_rest_watch(const CaseSpec& spec, const Setup<Dim>& setup,
                                           const Boundary<Dim>& boundary);

}  // namespace tailwater
