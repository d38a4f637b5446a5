// Readings of force probes of a flow.
#pragma once

#include <string>
#include <vector>

#include "air/enclosed_air.h"
#include "probes/wall_force.h"
#include "schemes/probe_context.h"

namespace tailwater {

inline ProbeTable force_probe(Coordinates about, std::vector<std::string> walls = {}) {
  ProbeTable probe;
  probe.name = "force";
  probe.type = ProbeType::force;
  probe.walls = std::move(walls);
  probe.moment_about = std::move(about);
  return probe;
}

/// Reads probe `which` of the case after the last step.
template <int Dim>
class Reader {
 public:
  Reader(const CaseSpec& spec, const Flow<Dim>& flow, std::size_t which = 0)
      : flow_(flow), reading_(force_reading<Dim>(spec.probes[which], spec, flow.walls.boundary)) {}

  Row row(double dt) const {
    ProbeContext<Dim> context = context_of(flow_);
    context.dt = dt;
    context.wall_forces = &flow_.walls.forces;
    context.patches = flow_.walls.patches.get();
    context.bodies = flow_.state.motion.bodies.each;
    context.air_pressure = air_of(flow_).pressure_field(flow_.walls.boundary);
    return reading_.take(context).at(0);
  }
  Vec<Dim> force(double dt = 0.0) const { return Vec<Dim>::Map(row(dt).data()); }
  double power(double dt) const { return row(dt).back(); }
  const Reading<Dim>& reading() const { return reading_; }

 private:
  const Flow<Dim>& flow_;
  Reading<Dim> reading_;
};

}  // namespace tailwater
