#include "parallel/exchange_plan.h"

namespace tailwater {

ExchangePlan::ExchangePlan(const Communicator& ranks, std::size_t owned,
                           const std::vector<std::vector<std::int32_t>>& sent)
    : ranks_(ranks), owned_(owned) {
  std::vector<std::int64_t> counts;
  for (const auto& entries : sent) counts.push_back(static_cast<std::int64_t>(entries.size()));
  const std::vector<std::int64_t> received = ranks.transpose(counts);
  for (int rank = 0; rank < ranks.size(); ++rank) {
    if (!sent[rank].empty()) {
      outgoing_.push_back({rank, sent_.size(), sent[rank].size()});
      sent_.insert(sent_.end(), sent[rank].begin(), sent[rank].end());
    }
    if (received[rank] > 0) {
      incoming_.push_back({rank, ghosts_, static_cast<std::size_t>(received[rank])});
      ghosts_ += static_cast<std::size_t>(received[rank]);
    }
  }
}

void ExchangePlan::transfer(const std::byte* packed, std::byte* received, std::size_t bytes) const {
  constexpr int tag = 2;
  const double start = ranks_.is_alone() ? 0.0 : MPI_Wtime();
  std::vector<MPI_Request> requests;
  const std::byte* own = nullptr;
  for (const Message& message : incoming_) {
    if (message.rank == ranks_.rank()) continue;
    MPI_Irecv(received + message.first * bytes, static_cast<int>(message.count * bytes), MPI_BYTE, message.rank, tag,
              ranks_.handle(), &requests.emplace_back());
  }
  for (const Message& message : outgoing_) {
    const std::byte* const content = packed + message.first * bytes;
    if (message.rank == ranks_.rank()) {
      own = content;
      continue;
    }
    MPI_Isend(content, static_cast<int>(message.count * bytes), MPI_BYTE, message.rank, tag, ranks_.handle(),
              &requests.emplace_back());
    ++ranks_.traffic()->messages;
    ranks_.traffic()->bytes += static_cast<std::int64_t>(message.count * bytes);
  }
  for (const Message& message : incoming_) {
    if (message.rank == ranks_.rank()) std::memcpy(received + message.first * bytes, own, message.count * bytes);
  }
  if (ranks_.is_alone()) return;
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  ++ranks_.traffic()->exchanges;
  ranks_.traffic()->exchange_seconds += MPI_Wtime() - start;
}

}  // namespace tailwater
