// The fate of keys that case files once had.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tailwater {

struct RemovedKey {
  std::string_view table;
  std::string_view key;
  std::string_view fate;            ///< the end of a message, as in "was removed: ..."
  std::string_view successor = {};  ///< the key of [study] that has its value today; empty: none
};

/// The keys that `tailwater migrate` changes, in tables that occur once in a case.
std::span<const RemovedKey> removed_keys();

/// For a message: the remedy for a removed key, and whether `tailwater migrate` applies it; empty if there never was
/// such a key. `table` is a name without an index.
std::string fate_of(std::string_view table, std::string_view key);

}  // namespace tailwater
