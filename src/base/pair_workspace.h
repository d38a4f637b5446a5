// One number for each pair of neighbours, in memory that stages use in turn: first where they find the pair vectors,
// then for the weights of the pressure rows. Two arrays of this size that came and went would leave holes in memory
// that other arrays divide.
#pragma once

#include <span>

#include "base/room.h"

namespace tailwater {

class PairWorkspace {
 public:
  /// The memory for so many numbers, which are not set. Earlier ones are lost. Where it is too small, it gets room for
  /// `room` numbers.
  std::span<float> take(std::size_t count, std::size_t room) {
    if (numbers_.capacity() < count) make_room(numbers_, room);
    numbers_.resize(count);
    return numbers_;
  }

 private:
  UnwrittenArray<float> numbers_;
};

}  // namespace tailwater
