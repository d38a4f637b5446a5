#pragma once

#include <optional>

#include "io/temporary_folder.h"
#include "parallel/communicator.h"

namespace tailwater {

/// A temporary folder of the root that all ranks know.
class SharedFolder {
 public:
  SharedFolder() {
    if (ranks_.is_root()) own_.emplace();
    path_ = ranks_.broadcast(own_ ? own_->path().string() : "");
  }
  ~SharedFolder() { ranks_.meet(); }

  const Communicator& ranks() const { return ranks_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  Communicator ranks_ = Communicator::world();
  std::optional<TemporaryFolder> own_;
  std::filesystem::path path_;
};

}  // namespace tailwater
