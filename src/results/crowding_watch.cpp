#include "results/crowding_watch.h"

#include <nlohmann/json.hpp>

#include "flow/measure.h"
#include "geometry/from_spec.h"
#include "io/messages.h"

namespace tailwater {
namespace {

/// Averaging time, in steps: the fastest water moves by a few spacings.
constexpr double steps_of_mean = 25.0;
/// Mean of the largest density error above which particles have piled up: the place holds twice its water. Where jets
/// land the mean reaches 0.6 without a pile (docs/theory/open_ends.md).
constexpr double crowded = 1.0;

}  // namespace

template <int Dim>
void CrowdingWatch::check(const Flow<Dim>& flow, double largest_error) {
  mean_ += (largest_error - mean_) / steps_of_mean;
  if (has_warned_ || mean_ <= crowded) return;
  has_warned_ = true;
  const DensestWater<Dim> densest = densest_water(flow);
  warn(Finding::warning("water-piles-up",
                        {"at t = {:.4g} s particles pile up at {}{}, where the density is {:.2g} times that of the "
                         "water; pressures near the place and the discharge past it are not reliable",
                         flow.state.time, place(densest.position), densest.is_prescribed ? ", beyond an opening" : "",
                         1.0 + densest.error},
                        {"use a smaller particles.spacing, or move an opening beside the place to a section "
                         "that the water passes evenly"}));
}

Json CrowdingWatch::saved() const { return {mean_, has_warned_}; }

void CrowdingWatch::restore(const Json& saved) {
  saved.at(0).get_to(mean_);
  saved.at(1).get_to(has_warned_);
}

template void CrowdingWatch::check(const Flow<2>&, double);
template void CrowdingWatch::check(const Flow<3>&, double);

}  // namespace tailwater
