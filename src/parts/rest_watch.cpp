#include "parts/rest_watch.h"

#include <nlohmann/json.hpp>

#include "case/spec.h"
#include "flow/measure.h"

namespace tailwater {
namespace {

/// [time.end]; a wave that turns is slow for less.
constexpr double share_of_end = 0.01;

}  // namespace

template <int Dim>
Json RestWatch<Dim>::save() const {
  Json saved{{"has_moved", has_moved_}};
  if (slow_since_) saved["slow_since"] = *slow_since_;
  return saved;
}

template <int Dim>
bool RestWatch<Dim>::restore(const Json& saved) {
  has_moved_ = saved.at("has_moved").get<bool>();
  slow_since_.reset();
  if (saved.contains("slow_since")) slow_since_ = saved.at("slow_since").get<double>();
  return true;
}

template <int Dim>
void RestWatch<Dim>::finish_step(Flow<Dim>& flow, const StepStart<Dim>& /*start*/, double dt) {
  const double time = flow.state.time + dt;
  if (largest_speed(flow) > speed_) {
    has_moved_ = true;
    slow_since_.reset();
  } else if (has_moved_ && !slow_since_) {
    slow_since_ = time;
  }
  is_at_rest_ = slow_since_ && time - *slow_since_ >= duration_;
}

template <int Dim>
void RestWatch<Dim>::add_to_summary(const Flow<Dim>& /*flow*/, Json& summary) const {
  summary["ended_at_rest"] = is_at_rest_;
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_rest_watch(const CaseSpec& spec, const Setup<Dim>& /*setup*/,
                                           const Boundary<Dim>& /*boundary*/) {
  if (spec.time.end_at_rest == 0.0) return nullptr;
  return std::make_unique<RestWatch<Dim>>(spec.time.end_at_rest, share_of_end * spec.time.end);
}

template class RestWatch<2>;
template class RestWatch<3>;
TAILWATER_IN_2D_AND_3D(make_rest_watch);

}  // namespace tailwater
