// Gates and wave makers as walls: a case file has a table for each, and the rest of the program sees the box that it
// is.
#pragma once

#include "case/spec.h"

namespace tailwater {

/// Appends the walls that the case's gates and wave makers are to those of the file, and marks those that are bodies.
void append_driven_walls(CaseSpec& spec);

/// Whether a wall has a table of its own in the case file.
inline bool is_own_table(const WallTable& wall) {
  return wall.drive.by == Drive::By::wall || wall.drive.by == Drive::By::body;
}

}  // namespace tailwater
