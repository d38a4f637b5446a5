// Gates and wave makers as walls: a case file has a table for each, and the rest of the program uses the box that it
// defines.
#pragma once

#include "case/spec.h"

namespace tailwater {

/// Appends the walls of the case's gates and wave makers to those of the file, and marks the walls of bodies.
void append_driven_walls(CaseSpec& spec);

/// Whether a wall has a table of its own in the case file.
inline bool is_own_table(const WallTable& wall) {
  return wall.drive.by == Drive::By::wall || wall.drive.by == Drive::By::body;
}

}  // namespace tailwater
