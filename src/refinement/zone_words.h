// Zones of finer particles as the case file describes them, and in words for messages.
#pragma once

#include <string>

#include "case/spec.h"

namespace tailwater {

/// Whether a zone has a displacement of its own.
bool is_displaced(const RefinementTable& zone);

/// The place of a zone, such as "within 0.2 m of 'pier'".
std::string place_of_zone(const RefinementTable& zone);

}  // namespace tailwater
