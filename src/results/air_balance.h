// What became of enclosed air, and what there is of it.
#pragma once

#include "base/json.h"
#include "flow/flow.h"
#include "probes/context.h"

namespace tailwater {

/// The block `pockets` of summary.json.
template <int Dim>
Json pockets_of(const Flow<Dim>& flow);

/// What a probe reads of all pockets.
template <int Dim>
PocketTotals pocket_totals(const Flow<Dim>& flow);

}  // namespace tailwater
