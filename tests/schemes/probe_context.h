// A flow as its probes see it.
#pragma once

#include "neighbours/neighbourhood.h"
#include "probes/context.h"
#include "schemes/cases.h"

namespace tailwater {

/// The data of a flow that all probes read. Other members keep their defaults.
template <int Dim>
ProbeContext<Dim> context_of(const Flow<Dim>& flow) {
  return {.particles = flow.state.particles,
          .grid = flow.neighbourhood->grid(),
          .kernel = flow.setup.scale.kernel,
          .boundary = flow.walls.boundary,
          .density = flow.setup.liquid.density,
          .gravity = flow.setup.gravity,
          .spacing = flow.setup.scale.spacing,
          .time = flow.state.time,
          .totals = {},
          .ranks = flow.setup.ranks,
          .domain = flow.setup.domain};
}

}  // namespace tailwater
