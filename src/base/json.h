// The type of all JSON that is read and written: its members keep the order in which they were written. Whoever looks
// into one includes <nlohmann/json.hpp>.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace tailwater {

using Json = nlohmann::ordered_json;

}  // namespace tailwater
