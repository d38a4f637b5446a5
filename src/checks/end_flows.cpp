#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "case/formulation.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "motion/channel_end.h"

namespace tailwater {
namespace {

constexpr double rim_on_wall = 0.1;        // dx, between the top of an opening and a lid
constexpr double min_cosine = 1.0 - 1e-6;  // between gravity's part along an opening and an edge of it
constexpr double max_of_range = 0.5;       // of the largest value; change while a wave crosses the end
constexpr double max_moments = 1e5;        // maximum number of times at which a quantity is evaluated
constexpr double in_front = 3.0;           // dx; water so near to an opening stands before it
/// Froude number beyond which a value is mistyped: a jet of 20 m/s and 0.1 m depth.
constexpr double max_froude = 20.0;
constexpr const char* unit_hint =
    "a discharge is in m^3/s, in 2D per metre of width (1 l/s is 0.001), a velocity in m/s";

/// s; time in which a wave crosses the buffer zone. Without gravity there are no waves, and no flow is too fast.
template <int Dim>
double time_of_crossing(const CaseSpec& spec, const ChannelEnd<Dim>& end) {
  const double gravity = end.gravity > 0.0 ? end.gravity : gravity_of<Dim>(spec).norm();
  if (gravity == 0.0) return 0.0;
  return (traits_of(spec).support + 1.0) * spec.particles.spacing / std::sqrt(gravity * end.height);
}

/// Largest sum of the discharges [m^3/s] that the case prescribes at its inlets, up to a time.
template <int Dim>
double largest_inflow(std::span<const ChannelEnd<Dim>> ends, double last) {
  constexpr int count = 100;
  double largest = 0.0;
  for (int k = 0; k <= count; ++k) {
    double sum = 0.0;
    for (const ChannelEnd<Dim>& end : ends) {
      if (end.flow.discharge) sum += std::max(0.0, end.flow.discharge->at(last * k / count));
    }
    largest = std::max(largest, sum);
  }
  return largest;
}

/// m; height of a place, 0 without gravity
template <int Dim>
double height_of(const Vec<Dim>& x, const Vec<Dim>& gravity) {
  return gravity.isZero(0.0) ? 0.0 : -gravity.normalized().dot(x);
}

/// m; height of the lowest point of an opening
template <int Dim>
double lowest_of(const ChannelEnd<Dim>& end, const Vec<Dim>& gravity) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vec<Dim>& x : end.mouth.rim()) lowest = std::min(lowest, height_of(x, gravity));
  return lowest;
}

/// m; height to which an open end may let the water of the case sink, up to a time.
template <int Dim>
double lowest_level_by(const ChannelEnd<Dim>& end, const Vec<Dim>& gravity, double last) {
  constexpr int count = 100;
  const double bottom = lowest_of(end, gravity);
  if (!end.is_driven()) return bottom;
  double lowest = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= count; ++k) {
    const double time = last * k / count;
    if (end.holds_level()) lowest = std::min(lowest, std::max(bottom, end.flow.level->at(time)));
    if (end.flow.feeds() && end.discharge(time, end.height) < 0.0) return bottom;
  }
  return lowest;
}

/// Whether water of the start stands deeper than a spacing before an inlet, and no other opening is so low that it may
/// leave. Then the inflow does not become critical. Collective.
template <int Dim>
bool is_dammed(const CaseSpec& spec, const ChannelEnd<Dim>& inlet, std::span<const ChannelEnd<Dim>> ends,
               const FluidParticles<Dim>& fluid) {
  const double dx = spec.particles.spacing;
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  const double deep = lowest_of(inlet, gravity) + dx;
  const bool own = std::ranges::any_of(fluid.position, [&](const Vec<Dim>& x) {
    const double distance = -inlet.mouth.beyond(x);
    return distance >= 0.0 && distance < in_front * dx && inlet.mouth.spans(x) && height_of(x, gravity) > deep;
  });
  return fluid.ranks.any(own) && std::ranges::none_of(ends, [&](const ChannelEnd<Dim>& end) {
           return &end != &inlet && lowest_level_by(end, gravity, spec.time.end) < deep;
         });
}

/// m^3/s, in 2D per metre of width; of critical flow that reaches the top of an opening. No flow with a surface brings
/// more.
template <int Dim>
double critical_discharge(const ChannelEnd<Dim>& end) {
  const double below_top = (1.0 - 1e-6) * end.height;
  const double breadth = end.breadth_at(below_top);
  if (breadth == 0.0) return std::numeric_limits<double>::infinity();
  return std::sqrt(end.gravity * std::pow(end.area_below(end.height), 3) / breadth);
}

/// Checks the prescribed values of one open end over the run.
template <int Dim>
class EndFlowCheck {
 public:
  /// `inflow` [m^3/s] is the largest into the case; `is_dammed` as above.
  EndFlowCheck(const CaseSpec& spec, const Boundary<Dim>& boundary, const ChannelEnd<Dim>& end, double inflow,
               bool is_dammed)
      : inflow_(inflow),
        is_dammed_(is_dammed),
        end_(end),
        full_gravity_(gravity_of<Dim>(spec)),
        label_(end.opening.label()),
        dx_(spec.particles.spacing),
        last_(spec.time.end),
        crossing_(time_of_crossing(spec, end)),
        has_lid_(std::abs(boundary.nearest(top(), std::numeric_limits<double>::infinity()).signed_distance) <=
                 rim_on_wall * dx_) {}

  Findings findings() {
    look_at_gravity();
    look_at_values("discharge", "m^3/s", end_.flow.discharge);
    look_at_values("velocity", "m/s", end_.flow.velocity);
    look_at_values("level", "m", end_.flow.level);
    if (findings_.empty()) follow();
    if (findings_.empty()) look_at_thinness();
    if (findings_.empty()) look_at_rating();
    return std::move(findings_);
  }

 private:
  void error(MessageId id, Clause problem, Clause remedy) {
    findings_.push_back(Finding::error(id, std::move(problem), std::move(remedy)));
  }

  void warn(MessageId id, Clause problem, Clause remedy) {
    findings_.push_back(Finding::warning(id, std::move(problem), std::move(remedy)));
  }

  Vec<Dim> top() const {
    return end_.on_mouth(Vec<Dim>(end_.low + end_.height * end_.rise + 0.5 * end_.width * end_.aside));
  }

  void look_at_gravity() {
    if (end_.flow.level && full_gravity_.isZero(0.0)) {
      error("level-needs-gravity", {"{} needs gravity, which the case does not have", label_.with_key("level")},
            {"give a discharge or a velocity instead"});
    } else if (end_.gravity > 0.0 && end_.up.dot(end_.rise) < min_cosine) {
      error("opening-oblique-to-gravity", {"{}: gravity is oblique to its edges, so it has no bed", label_},
            {"turn the case so that one edge is upright"});
    }
  }

  /// The number of equal parts of the run at whose ends a quantity is evaluated.
  int samples() const {
    return crossing_ > 0.0 ? static_cast<int>(std::clamp(std::ceil(last_ / crossing_), 100.0, max_moments)) : 100;
  }

  void look_at_values(const char* key, const char* unit, const std::optional<TimeFunction>& quantity) {
    if (!quantity) return;
    if (const SmoothCurve* series = quantity->series()) {
      const double from = series->times().front();
      const double to = series->times().back();
      if (from > 0.0 || to < last_) {
        error("series-shorter-than-run",
              {"{} covers t = {:.6g} to {:.6g} s, but the run lasts from 0 to time.end = {:.6g} s",
               label_.with_key("file"), from, to, last_},
              {"add rows, or end the run earlier"});
        return;
      }
    }
    const int count = samples();
    double largest = 0.0;
    for (int k = 0; k <= count; ++k) {
      const double time = last_ * k / count;
      const double value = quantity->at(time);
      if (!std::isfinite(value)) {
        error("value-not-finite-in-time", {"{} has no finite value at t = {:.6g} s", label_.with_key(key), time},
              {"give an expression that has one during the whole run"});
        return;
      }
      largest = std::max(largest, std::abs(value));
    }
    const double scale = &quantity == &end_.flow.level ? end_.height : largest;
    for (int k = 0; k < count; ++k) {
      const double time = last_ * k / count;
      const double next = std::min(last_, time + std::min(crossing_, last_ / count));
      const double change = quantity->at(next) - quantity->at(time);
      if (std::abs(change) <= max_of_range * scale) continue;
      error("value-jumps",
            {"{} jumps by {:.4g} between t = {:.6g} and {:.6g} s, faster than a wave crosses the end of the channel",
             label_.with_key(key), Amount{change, unit}, time, next},
            {"let it change over {:.2g} s or more", 4.0 * crossing_});
      return;
    }
  }

  void follow() {
    const int count = 200;
    for (int k = 0; k <= count && findings_.empty(); ++k) look_at(last_ * k / count);
  }

  void look_at(double time) {
    if (end_.flow.level) look_at_level(time, end_.flow.level->at(time));
    if (!end_.flow.feeds() || !findings_.empty()) return;
    const double depth = end_.flow.level ? end_.depth_at_level(end_.flow.level->at(time)) : end_.height;
    const double q = end_.discharge_per_width(time, depth);
    if (end_.gravity == 0.0) return;
    if (has_lid_) {
      if (end_.flow.level && depth >= end_.height) {
        error("level-at-drowned-inlet",
              {"{} is given, but at t = {:.6g} s it is not below the top of the opening, {:.6g} m, so the opening is "
               "full, and its pressure follows from the water inside",
               label_.with_key("level"), time, end_.floor + end_.height},
              {"remove the level, or the discharge and the velocity"});
      }
      return;
    }
    if (end_.flow.level) {
      look_at_froude(time, q, depth);
    } else if (const double most = critical_discharge(end_), all = std::abs(end_.discharge(time, depth)); all > most) {
      error("inflow-exceeds-opening",
            {"{}: at t = {:.6g} s more water enters than the opening can pass: {:.4g}, but critical flow in the full "
             "opening, {:.4g} m high, is {:.4g}",
             label_, time, Amount{all, discharge_unit}, end_.height, Amount{most, discharge_unit}},
            {"make it higher, let less enter ({}), or give a supercritical flow its level too", unit_hint});
    }
  }

  /// A discharge may begin and end at 0: only one that never makes a row of particles is reported.
  void look_at_thinness() {
    if (end_.flow.level || !end_.flow.feeds() || end_.gravity == 0.0 || has_lid_ || is_dammed_) return;
    const double critical = end_.largest_depth(last_);
    if (critical == 0.0 || critical >= dx_) return;
    findings_.push_back(Finding::warning(
        "inflow-thinner-than-spacing",
        {"{}: the critical depth of the inflow is {:.3g} at most, less than the spacing of {:.3g} m: unless something "
         "dams the water, it enters one spacing deep and too slowly",
         label_, Amount{critical, "m"}, dx_},
        {"use a smaller spacing"}));
  }

  /// m; height of the lowest point of the opening
  double floor() const {
    if (end_.gravity > 0.0) return end_.floor;
    return -full_gravity_.normalized().dot(end_.mouth.corner);  // a level opening
  }

  void look_at_level(double time, double level) {
    if (level < floor()) {
      error("level-below-opening",
            {"{} = {:.6g} at t = {:.6g} s is below the lowest point of the opening, {:.6g} m: levels are heights above "
             "the origin, not depths",
             label_.with_key("level"), Amount{level, "m"}, time, floor()},
            {"give one above the bed there"});
    } else if (end_.gravity > 0.0 && level > end_.floor + end_.height && !has_lid_) {
      error("level-above-opening",
            {"{} = {:.6g} at t = {:.6g} s is above the top of the opening, {:.6g} m, where there is no wall",
             label_.with_key("level"), Amount{level, "m"}, time, end_.floor + end_.height},
            {"make the opening and the walls beside it higher, or lower the level"});
    }
  }

  /// A level may depend on the discharge q, which is not known beforehand: it is followed up to all that flows in.
  void look_at_rating() {
    if (!end_.holds_level() || end_.gravity == 0.0) return;
    constexpr int count = 20;
    double before = end_.flow.level->at(last_, 0.0);
    for (int k = 1; k <= count; ++k) {
      const double q = inflow_ * k / count;
      const double level = end_.flow.level->at(last_, q);
      if (!std::isfinite(level)) {
        error("rating-curve-not-finite",
              {"{} has no finite value at q = {:.4g}", label_.with_key("level"), Amount{q, discharge_unit}},
              {"give an expression that has one for all discharges up to {:.4g}", Amount{inflow_, discharge_unit}});
        return;
      }
      if (level < before) {
        warn(
            "rating-curve-falls",
            {"{} falls from {:.4g} to {:.4g} where q grows to {:.4g}: outflow would lower the level, and a lower level "
             "would increase the outflow",
             label_.with_key("level"), Amount{before, "m"}, level, Amount{q, discharge_unit}},
            {"give an expression that grows with q"});
        return;
      }
      if (level > end_.floor + end_.height && !has_lid_) {
        warn("rating-curve-above-opening",
             {"{} = {:.4g} at q = {:.4g} is above the top of the opening, {:.6g} m, where there is no wall; up to "
              "{:.4g} flow in",
              label_.with_key("level"), Amount{level, "m"}, Amount{q, discharge_unit}, end_.floor + end_.height,
              Amount{inflow_, discharge_unit}},
             {"make the opening and the walls beside it higher, or correct the expression"});
        return;
      }
      before = level;
    }
  }

  void look_at_froude(double time, double q, double depth) {
    const double speed = depth > 0.0 ? std::abs(q) / depth : 0.0;
    const double froude = depth > 0.0 ? speed / std::sqrt(end_.gravity * depth) : 0.0;
    if (froude > max_froude) {
      error("inflow-implausibly-fast",
            {"{}: at t = {:.6g} s water would enter at {:.4g}, which is implausible (Froude number {:.3g})", label_,
             time, Amount{speed, "m/s"}, froude},
            {"check the units: {}", unit_hint});
    } else if (q < 0.0 || froude < 1.0) {
      error("level-at-subcritical-inlet",
            {"{} is given, but the flow is subcritical at t = {:.6g} s (Froude number {:.3g}), and its level follows "
             "from the water inside",
             label_.with_key("level"), time, froude},
            {"remove the level, or the discharge and the velocity"});
    }
  }

  static constexpr const char* discharge_unit = Dim == 2 ? "m^2/s" : "m^3/s";

  double inflow_;  ///< m^3/s
  bool is_dammed_;
  const ChannelEnd<Dim>& end_;
  Vec<Dim> full_gravity_;  ///< m/s^2
  CaseLabel label_;
  double dx_, last_;
  double crossing_;  ///< s; of a wave, through the buffer zone
  bool has_lid_;
  Findings findings_;
};

}  // namespace

template <int Dim>
Findings check_end_flows(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  Findings findings;
  if (boundary.faces.empty()) return findings;  // check_open_ends reports this
  const std::vector<ChannelEnd<Dim>> ends = make_channel_ends<Dim>(spec);
  const double inflow = largest_inflow<Dim>(ends, spec.time.end);
  for (const ChannelEnd<Dim>& end : ends) {
    if (!end.is_driven()) continue;
    const bool dammed = end.flow.feeds() && is_dammed<Dim>(spec, end, ends, fluid);
    append(findings, EndFlowCheck<Dim>(spec, boundary, end, inflow, dammed).findings());
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_end_flows);

}  // namespace tailwater
