// Messages of the ranks at the start of a run, once. Functions are collective.
#pragma once

#include <string>
#include <vector>

#include "parallel/communicator.h"

namespace tailwater {

/// The values of all ranks concatenated by rank, on all of them. For plain values.
template <class Value>
std::vector<Value> gather_on_all(const Communicator& ranks, const std::vector<Value>& values) {
  if (ranks.is_alone()) return values;
  const std::vector<Value> on_root = ranks.gather(values);
  const std::string bytes =
      ranks.broadcast(std::string(reinterpret_cast<const char*>(on_root.data()), on_root.size() * sizeof(Value)));
  std::vector<Value> all(bytes.size() / sizeof(Value));
  bytes.copy(reinterpret_cast<char*>(all.data()), bytes.size());
  return all;
}

/// Number of ranks on this rank's machine, which use the same memory.
int ranks_on_this_machine(const Communicator& ranks);

}  // namespace tailwater
