// What has become of keys that case files once had.
#pragma once

#include <string_view>

namespace tailwater {

/// For a message: what to do in place of a key that is no more, as in "was removed: ..."; empty if there never was such
/// a key.
std::string_view fate_of(std::string_view table, std::string_view key);

}  // namespace tailwater
