#include "refinement/zone_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tailwater {

namespace {

std::string place_as_drawn(const RefinementTable& zone) {
  switch (zone.shape) {
    case ZoneShape::box:
      return fmt::format("from ({:.6g}) to ({:.6g})", fmt::join(zone.min, ", "), fmt::join(zone.max, ", "));
    case ZoneShape::polygon:
      return fmt::format("in a polygon of {} corners", zone.points.size());
    case ZoneShape::walls:
      return fmt::format("within {:.6g} m of '{}'", zone.distance, fmt::join(zone.walls, "', '"));
    case ZoneShape::surface:
      break;
  }
  return fmt::format("above {:.6g} m below the initial surface", zone.distance);
}

}  // namespace

bool is_displaced(const RefinementTable& zone) {
  return std::ranges::any_of(zone.displacement, [](const Varying& component) { return component != Varying(0.0); });
}

std::string place_of_zone(const RefinementTable& zone) {
  return place_as_drawn(zone) + (is_displaced(zone) ? ", displaced over time" : "");
}

}  // namespace tailwater
