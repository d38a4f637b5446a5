// One number for each pair of neighbours, in memory that stages use in turn: first for the computation of the pair
// vectors, then for the weights of the pressure rows. Two temporary arrays of this size would fragment the memory.
#pragma once

#include <span>

#include "base/room.h"

namespace tailwater {

class PairWorkspace {
 public:
  /// Memory for `count` numbers, which are not initialised. Earlier numbers are lost. If the memory is too small, it is
  /// enlarged to `room` numbers.
  std::span<float> take(std::size_t count, std::size_t room) {
    if (numbers_.capacity() < count) make_room(numbers_, room);
    numbers_.resize(count);
    return numbers_;
  }

 private:
  UnwrittenArray<float> numbers_;
};

}  // namespace tailwater
