// The type of all JSON that is read and written: members keep the order in which they were written. Code that accesses
// members includes <nlohmann/json.hpp>.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace tailwater {

using Json = nlohmann::ordered_json;

}  // namespace tailwater
