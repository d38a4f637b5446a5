#include "parallel/communicator.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "base/assert.h"

namespace tailwater {

Communicator Communicator::world() {
  Communicator ranks;
  ranks.handle_ = MPI_COMM_WORLD;
  MPI_Comm_rank(MPI_COMM_WORLD, &ranks.rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks.size_);
  if (!ranks.is_alone()) ranks.traffic_ = std::make_shared<Traffic>();
  return ranks;
}

void Communicator::reduce(void* values, std::size_t count, MPI_Datatype type, MPI_Op operation) const {
  if (is_alone()) return;
  const double start = MPI_Wtime();
  MPI_Allreduce(MPI_IN_PLACE, values, static_cast<int>(count), type, operation, handle_);
  traffic_->reduction_seconds += MPI_Wtime() - start;
}

void Communicator::all_gather_bytes(const void* value, void* all, std::size_t bytes) const {
  if (is_alone()) {
    std::memcpy(all, value, bytes);
    return;
  }
  const int count = static_cast<int>(bytes);
  MPI_Allgather(value, count, MPI_BYTE, all, count, MPI_BYTE, handle_);
}

void Communicator::all_gather_bytes(const void* own, void* all, std::size_t bytes_of_each,
                                    std::span<const int> counts) const {
  TAILWATER_ASSERT(counts.size() == static_cast<std::size_t>(size_), "one number per rank");
  std::vector<int> bytes;
  std::vector<int> begin{0};
  for (const int count : counts) {
    bytes.push_back(count * static_cast<int>(bytes_of_each));
    begin.push_back(begin.back() + bytes.back());
  }
  if (is_alone()) {
    std::copy_n(static_cast<const std::byte*>(own), bytes[0], static_cast<std::byte*>(all));
    return;
  }
  const double start = MPI_Wtime();
  MPI_Allgatherv(own, bytes[rank_], MPI_BYTE, all, bytes.data(), begin.data(), MPI_BYTE, handle_);
  traffic_->exchange_seconds += MPI_Wtime() - start;
}

std::int64_t Communicator::sum_before(std::int64_t value) const {
  std::int64_t sum = 0;
  if (!is_alone()) MPI_Exscan(&value, &sum, 1, MPI_INT64_T, MPI_SUM, handle_);
  return is_root() ? 0 : sum;
}

std::vector<std::int64_t> Communicator::transpose(std::span<const std::int64_t> counts) const {
  TAILWATER_ASSERT(counts.size() == static_cast<std::size_t>(size_), "one number per rank");
  std::vector<std::int64_t> received(counts.begin(), counts.end());
  if (!is_alone()) MPI_Alltoall(counts.data(), 1, MPI_INT64_T, received.data(), 1, MPI_INT64_T, handle_);
  return received;
}

std::vector<std::string> Communicator::gather(const std::string& text) const {
  if (is_alone()) return {text};
  const std::vector<std::int64_t> sizes = all_gather(static_cast<std::int64_t>(text.size()));
  constexpr int tag = 1;
  if (!is_root()) {
    MPI_Send(text.data(), static_cast<int>(text.size()), MPI_BYTE, 0, tag, handle_);
    return {};
  }
  std::vector<std::string> all{text};
  for (int rank = 1; rank < size_; ++rank) {
    std::string& part = all.emplace_back(static_cast<std::size_t>(sizes[rank]), '\0');
    MPI_Recv(part.data(), static_cast<int>(part.size()), MPI_BYTE, rank, tag, handle_, MPI_STATUS_IGNORE);
  }
  return all;
}

std::string Communicator::scatter(const std::vector<std::string>& texts) const {
  if (is_alone()) return texts.front();
  constexpr int tag = 2;
  if (!is_root()) {
    MPI_Status status;
    MPI_Probe(0, tag, handle_, &status);
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    std::string own(static_cast<std::size_t>(size), '\0');
    MPI_Recv(own.data(), size, MPI_BYTE, 0, tag, handle_, MPI_STATUS_IGNORE);
    return own;
  }
  TAILWATER_ASSERT(texts.size() == static_cast<std::size_t>(size_), "one text per rank");
  for (int rank = 1; rank < size_; ++rank) {
    MPI_Send(texts[rank].data(), static_cast<int>(texts[rank].size()), MPI_BYTE, rank, tag, handle_);
  }
  return texts.front();
}

std::string Communicator::broadcast(std::string text, int source) const {
  if (is_alone()) return text;
  auto size = static_cast<std::int64_t>(text.size());
  MPI_Bcast(&size, 1, MPI_INT64_T, source, handle_);
  text.resize(static_cast<std::size_t>(size));
  MPI_Bcast(text.data(), static_cast<int>(size), MPI_BYTE, source, handle_);
  return text;
}

void Communicator::meet() const {
  if (!is_alone()) MPI_Barrier(handle_);
}

}  // namespace tailwater
