// The ranks of a run and their communication. One rank is the default and needs no MPI. Functions are collective: all
// ranks call them in the same order.
#pragma once

#include <mpi.h>

#include <array>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace tailwater {

/// The traffic of a rank with others since the start. Times include waiting for them.
struct Traffic {
  double exchange_seconds = 0.0;   ///< halo and migration
  double reduction_seconds = 0.0;  ///< sums, maxima
  std::int64_t exchanges = 0;
  std::int64_t messages = 0;  ///< sent in exchanges
  std::int64_t bytes = 0;     ///< sent in exchanges
};

class Communicator {
 public:
  /// One rank.
  Communicator() = default;

  /// All ranks of the program. MPI must run (linear/session.h) as long as copies of this value are used.
  static Communicator world();

  int rank() const { return rank_; }
  int size() const { return size_; }
  bool is_root() const { return rank_ == 0; }
  bool is_alone() const { return size_ == 1; }
  MPI_Comm handle() const { return handle_; }

  template <class Number>
  Number sum(Number value) const {
    reduce(&value, 1, mpi_type<Number>(), MPI_SUM);
    return value;
  }
  /// Sums each of the numbers in place, in one message. Counts are exact up to 2^53.
  template <class... Number>
  void sum_each(Number&... number) const {
    reduce_each(MPI_SUM, number...);
  }

  template <class Number>
  Number largest(Number value) const {
    reduce(&value, 1, mpi_type<Number>(), MPI_MAX);
    return value;
  }
  template <class Number>
  Number least(Number value) const {
    reduce(&value, 1, mpi_type<Number>(), MPI_MIN);
    return value;
  }
  template <class... Number>
  void largest_each(Number&... number) const {
    reduce_each(MPI_MAX, number...);
  }
  /// The largest value of each entry, in place. All ranks give equally many.
  void largest_of_each(std::span<int> values) const { reduce(values.data(), values.size(), MPI_INT, MPI_MAX); }
  /// The sum of each entry, in place. All ranks give equally many.
  void sum_of_each(std::span<double> values) const { reduce(values.data(), values.size(), MPI_DOUBLE, MPI_SUM); }
  /// The least value of each entry, in place. All ranks give equally many.
  void min_of_each(std::span<double> values) const { reduce(values.data(), values.size(), MPI_DOUBLE, MPI_MIN); }
  /// The bits that any rank has set, in place. All ranks give equally many words.
  void unite(std::span<std::uint64_t> words) const { reduce(words.data(), words.size(), MPI_UINT64_T, MPI_BOR); }
  bool any(bool value) const { return largest(static_cast<std::int64_t>(value)) != 0; }

  /// Sum over the ranks before this one.
  std::int64_t sum_before(std::int64_t value) const;

  /// The value of each rank, by rank, on all ranks. For plain values.
  template <class Value>
  std::vector<Value> all_gather(const Value& value) const {
    std::vector<Value> all(static_cast<std::size_t>(size_));
    all_gather_bytes(&value, all.data(), sizeof(Value));
    return all;
  }

  /// The values of all ranks one after the other, on all ranks. Rank q gives counts[q]. For plain values.
  template <class Value>
  std::vector<Value> all_gather(const std::vector<Value>& own, std::span<const int> counts) const {
    std::vector<Value> all(static_cast<std::size_t>(std::accumulate(counts.begin(), counts.end(), 0)));
    all_gather_bytes(own.data(), all.data(), sizeof(Value), counts);
    return all;
  }

  /// Sends counts[q] to rank q; returns the count that each rank sent to this one.
  std::vector<std::int64_t> transpose(std::span<const std::int64_t> counts) const;

  /// The text of each rank, by rank, on the root; empty on the others.
  std::vector<std::string> gather(const std::string& text) const;

  /// The values of all ranks concatenated by rank, on the root; empty on the others. For plain values.
  template <class Value>
  std::vector<Value> gather(const std::vector<Value>& values) const {
    if (is_alone()) return values;
    std::vector<Value> all;
    for (const std::string& bytes :
         gather(std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)))) {
      const auto* first = reinterpret_cast<const Value*>(bytes.data());
      all.insert(all.end(), first, first + bytes.size() / sizeof(Value));
    }
    return all;
  }

  /// The inverse of `gather`: the root's texts, one for each rank, each on its rank. Other ranks give none.
  std::string scatter(const std::vector<std::string>& texts) const;

  /// The inverse of `gather` for values: counts[q] of the root's values go to rank q.
  template <class Value>
  std::vector<Value> scatter(const std::vector<Value>& values, std::span<const std::int64_t> counts) const {
    std::vector<std::string> parts;
    const auto* first = reinterpret_cast<const char*>(values.data());
    for (std::size_t q = 0; is_root() && q < counts.size(); ++q) {
      const std::size_t bytes = static_cast<std::size_t>(counts[q]) * sizeof(Value);
      parts.emplace_back(first, bytes);
      first += bytes;
    }
    const std::string own = scatter(parts);
    std::vector<Value> result(own.size() / sizeof(Value));
    own.copy(reinterpret_cast<char*>(result.data()), own.size());
    return result;
  }

  /// The text of rank `source`, on all ranks.
  std::string broadcast(std::string text, int source = 0) const;

  /// Waits until all ranks are here.
  void meet() const;

  /// Counts since the start of the program; null on one rank.
  Traffic* traffic() const { return traffic_.get(); }

 private:
  template <class Number>
  static MPI_Datatype mpi_type() {
    if constexpr (std::is_same_v<Number, double>) {
      return MPI_DOUBLE;
    } else if constexpr (std::is_same_v<Number, int>) {
      return MPI_INT;
    } else {
      static_assert(std::is_integral_v<Number> && sizeof(Number) == 8);
      return std::is_signed_v<Number> ? MPI_INT64_T : MPI_UINT64_T;
    }
  }
  template <class... Number>
  void reduce_each(MPI_Op operation, Number&... number) const {
    std::array<double, sizeof...(Number)> values{static_cast<double>(number)...};
    reduce(values.data(), values.size(), MPI_DOUBLE, operation);
    const double* value = values.data();
    ((number = static_cast<Number>(*value++)), ...);
  }
  void reduce(void* values, std::size_t count, MPI_Datatype type, MPI_Op operation) const;
  void all_gather_bytes(const void* value, void* all, std::size_t bytes) const;
  void all_gather_bytes(const void* own, void* all, std::size_t bytes_of_each, std::span<const int> counts) const;

  MPI_Comm handle_ = MPI_COMM_SELF;
  int rank_ = 0;
  int size_ = 1;
  std::shared_ptr<Traffic> traffic_;
};

}  // namespace tailwater
