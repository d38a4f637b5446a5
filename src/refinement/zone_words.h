// Zones of finer particles in words, for messages.
#pragma once

#include <string>

#include "case/spec.h"

namespace tailwater {

/// The place of a zone, such as "within 0.2 m of 'pier'".
std::string place_of_zone(const RefinementTable& zone);

}  // namespace tailwater
