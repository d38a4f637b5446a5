// The plan by which owned entries of a field are sent to other ranks. Received entries are ghosts and stand behind the
// owned ones. A plan is made once and executed for any field of plain values. A rank may send to itself (periodic
// images). The plan has no state: exchanges may follow one another in any order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "base/assert.h"
#include "parallel/communicator.h"

namespace tailwater {

class ExchangePlan {
 public:
  ExchangePlan() = default;

  /// `sent[q]` are the owned entries that rank q gets, in this order. An entry may go to several ranks, and more than
  /// once to one. Ghosts are in the order of the ranks that sent them. Collective.
  ExchangePlan(const Communicator& ranks, std::size_t owned, const std::vector<std::vector<std::int32_t>>& sent);

  std::size_t owned() const { return owned_; }
  std::size_t ghosts() const { return ghosts_; }
  /// The owned entries that are sent, message by message. On one rank ghost k copies entry sent()[k].
  std::span<const std::int32_t> sent() const { return sent_; }

  /// Brings the ghosts' entries of the fields up to date, in one message per rank. Each field gets owned + ghosts
  /// entries.
  template <class... Value>
  void exchange(std::vector<Value>&... fields) const {
    (fields.resize(owned_ + ghosts_), ...);
    if (outgoing_.empty() && incoming_.empty()) return;
    constexpr std::size_t bytes = (sizeof(Value) + ...);
    std::vector<std::byte> packed(sent_.size() * bytes);
    std::vector<std::byte> received(ghosts_ * bytes);
    for (const Message& message : outgoing_) {
      std::byte* place = packed.data() + message.first * bytes;
      (pack(message, fields, place), ...);
    }
    transfer(packed.data(), received.data(), bytes);
    for (const Message& message : incoming_) {
      const std::byte* place = received.data() + message.first * bytes;
      (unpack(message, fields, place), ...);
    }
  }

  /// Sends packed[k] in place of the owned entry sent()[k]. `field` gets owned + ghosts entries.
  template <class Value>
  void deliver(std::span<const Value> packed, std::vector<Value>& field) const {
    TAILWATER_ASSERT(packed.size() == sent_.size(), "one value per entry sent");
    field.resize(owned_ + ghosts_);
    if (outgoing_.empty() && incoming_.empty()) return;
    transfer(reinterpret_cast<const std::byte*>(packed.data()), reinterpret_cast<std::byte*>(field.data() + owned_),
             sizeof(Value));
  }

 private:
  /// `count` entries from `first` on: those of sent_ for `rank`, or the ghosts from `rank`.
  struct Message {
    int rank;
    std::size_t first;
    std::size_t count;
  };

  template <class Value>
  void pack(const Message& message, const std::vector<Value>& field, std::byte*& place) const {
    for (std::size_t k = message.first; k < message.first + message.count; ++k) {
      std::memcpy(place, &field[sent_[k]], sizeof(Value));
      place += sizeof(Value);
    }
  }
  template <class Value>
  void unpack(const Message& message, std::vector<Value>& field, const std::byte*& place) const {
    if (message.count == 0) return;
    std::memcpy(static_cast<void*>(&field[owned_ + message.first]), place, message.count * sizeof(Value));
    place += message.count * sizeof(Value);
  }

  /// Moves entries of this number of bytes from `packed`, in the order of sent_, to `received`, in the order of the
  /// ghosts.
  void transfer(const std::byte* packed, std::byte* received, std::size_t bytes) const;

  Communicator ranks_;
  std::size_t owned_ = 0;
  std::size_t ghosts_ = 0;
  std::vector<std::int32_t> sent_;
  std::vector<Message> outgoing_;
  std::vector<Message> incoming_;
};

}  // namespace tailwater
