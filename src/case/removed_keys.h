// What has become of keys that case files once had.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tailwater {

struct RemovedKey {
  std::string_view table;
  std::string_view key;
  std::string_view fate;            ///< what a message says of it, as in "was removed: ..."
  std::string_view successor = {};  ///< the key of [study] that has its value today; empty: none
};

/// Those that `tailwater migrate` changes: of tables of which a case has one.
std::span<const RemovedKey> removed_keys();

/// For a message: what to do in place of a key that is no more, and whether `tailwater migrate` does it; empty if there
/// never was such a key. `table` is a name without an index.
std::string fate_of(std::string_view table, std::string_view key);

}  // namespace tailwater
