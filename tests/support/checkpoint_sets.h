// The datasets of a checkpoint, for tests that make wrong checkpoints.
#pragma once

#include <array>
#include <cstddef>

namespace tailwater {

enum class Type { real, whole64, whole32, byte, text };

struct Dataset {
  const char* name;
  Type type;
  std::size_t columns;
};

/// The datasets of a run in 2D.
inline constexpr std::array<Dataset, 17> datasets{{{"position", Type::real, 2},
                                                   {"velocity", Type::real, 2},
                                                   {"pressure", Type::real, 1},
                                                   {"volume", Type::real, 1},
                                                   {"kind", Type::byte, 1},
                                                   {"id", Type::whole64, 1},
                                                   {"wall_velocity", Type::real, 2},
                                                   {"probe_memory", Type::real, 1},
                                                   {"owned", Type::whole64, 1},
                                                   {"rank_log", Type::real, 1},
                                                   {"cuts", Type::text, 1},
                                                   {"cuts_size", Type::whole64, 1},
                                                   {"case", Type::text, 1},
                                                   {"run", Type::text, 1},
                                                   {"layer_viscosity", Type::real, 1},
                                                   {"wall_distance", Type::real, 1},
                                                   {"second_pressure", Type::real, 1}}};

}  // namespace tailwater
