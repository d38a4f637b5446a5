// Still water, four by two particles (by two in 3D), without walls: the smallest flow there is.
#pragma once

#include "case/spec.h"
#include "flow/flow.h"
#include "published/make_flow.h"

namespace tailwater {

template <int Dim>
CaseSpec pond_case() {
  CaseSpec spec;
  spec.general.dimension = Dim;
  spec.particles.spacing = 0.1;
  spec.physics.gravity.assign(Dim, 0.0);
  spec.physics.gravity.back() = -9.81;
  spec.time.end = 1.0;
  FluidTable water;
  water.min.assign(Dim, 0.0);
  water.max.assign(Dim, 0.2);
  water.max[0] = 0.4;
  water.velocity.assign(Dim, 0.0);
  spec.fluid.push_back(water);
  return spec;
}

}  // namespace tailwater
