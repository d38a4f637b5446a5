// Structs that are saved in checkpoints as their members, by name.
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "base/json.h"

namespace tailwater {

/// The first of `names`, which are separated by ", "; removes it from them.
inline std::string take_name(std::string_view& names) {
  const std::string name(names.substr(0, names.find(',')));
  names.remove_prefix(std::min(names.size(), name.size() + 2));
  return name;
}

template <class... Members>
void save_members(Json& json, std::string_view names, const Members&... members) {
  ((json[take_name(names)] = members), ...);
}

/// Throws Json::exception if a member is missing or has another type.
template <class... Members>
void restore_members(const Json& json, std::string_view names, Members&... members) {
  (json.at(take_name(names)).get_to(members), ...);
}

}  // namespace tailwater

/// `to_json` and `from_json` of a struct: `inline` beside it, `friend` in it. A new member does not compile until it is
/// in the list.
#define TAILWATER_SAVED(kind, Struct, ...)                       \
  kind void to_json(Json& json, const Struct& all) {             \
    const auto& [__VA_ARGS__] = all;                             \
    tailwater::save_members(json, #__VA_ARGS__, __VA_ARGS__);    \
  }                                                              \
  kind void from_json(const Json& json, Struct& all) {           \
    auto& [__VA_ARGS__] = all;                                   \
    tailwater::restore_members(json, #__VA_ARGS__, __VA_ARGS__); \
  }
