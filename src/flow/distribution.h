// Which rank has which particles and rows of walls.
#pragma once

#include "neighbours/decomposition.h"
#include "walls/near_walls.h"
#include "walls/shared_rows.h"

namespace tailwater {

template <int Dim>
struct Distribution {
  Decomposition<Dim> decomposition;  ///< of space, by the work of its particles
  SharedRows<Dim> shared_rows;       ///< locates the rows of other ranks
  NearWalls<Dim> near_walls;         ///< the rows that have particles
};

}  // namespace tailwater
