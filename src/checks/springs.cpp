#include <cmath>
#include <limits>
#include <numbers>

#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "motion/floating_body.h"

namespace tailwater {
namespace {

/// Steps of a spring that are shorter than those of the water by this factor are reported.
constexpr double worth_a_warning = 10.0;
/// The default formulations have it, which is near enough for a factor of ten.
constexpr double usual_courant = 0.25;

/// Warns of springs that need much shorter steps than the water, whose longest is `step` [s].
class SpringSteps {
 public:
  explicit SpringSteps(double step) : step_(step) {}

  void look_at(const CaseLabel& key, double stiffness, double frequency) {
    if (frequency == 0.0) return;
    const double step = longest_step_of_springs / frequency;
    const double ratio = step_ / step;
    if (ratio <= worth_a_warning) return;
    findings_.push_back(Finding::warning(
        "spring-slows-run",
        {"{} = {:.3g} moves its body with a period of {:.2g}, which needs time steps of at most {:.2g} s instead of "
         "{:.2g} s: the run takes about {:.2g} times as many steps",
         key, stiffness, Amount{2.0 * std::numbers::pi / frequency, "s"}, step, step_, ratio},
        {"give at most {:.2g}, or remove the motion from `free`", stiffness / (ratio * ratio)}));
  }

  Findings findings() && { return std::move(findings_); }

 private:
  double step_;
  Findings findings_;
};

}  // namespace

template <int Dim>
Findings check_springs(const CaseSpec& spec, const FluidParticles<Dim>& fluid) {
  const double speed = std::sqrt(2.0 * gravity_of<Dim>(spec).norm() * water_height(spec, fluid));
  if (spec.bodies.empty() || speed == 0.0) return {};
  SpringSteps steps(usual_courant * spec.particles.spacing / speed);
  const std::vector<FloatingBody<Dim>> bodies = make_bodies<Dim>(spec);
  for (const FloatingBody<Dim>& body : bodies) {
    const Twist<Dim> mass = body.scale();
    for (const int entry : body.free) {
      steps.look_at(CaseLabel("body", body.name).with_key("springs"), body.springs[entry],
                    std::sqrt(body.springs[entry] / mass[entry]));
    }
  }
  const std::vector<Mooring<Dim>> moorings = make_moorings<Dim>(spec);
  for (std::size_t m = 0; m < moorings.size(); ++m) {
    steps.look_at(CaseLabel("mooring", spec.moorings[m].name).with_key("stiffness"), moorings[m].stiffness,
                  frequency_of<Dim>(moorings[m], bodies));
  }
  return std::move(steps).findings();
}

TAILWATER_IN_2D_AND_3D(check_springs);

}  // namespace tailwater
