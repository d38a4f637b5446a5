#include "run/checkpoint_keeper.h"

#include <filesystem>
#include <system_error>
#include <vector>

#include "base/free_memory.h"
#include "case/writer.h"
#include "flow/distribution.h"
#include "io/write_file.h"
#include "parallel/together.h"

namespace tailwater {
namespace {

namespace fs = std::filesystem;

/// The older one is used when the newer is damaged.
constexpr std::size_t kept_files = 2;

/// Removes half-written files of a killed run.
void remove_parts(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() == temporary_ending) remove_file(entry->path());
  }
}

}  // namespace

template <int Dim>
CheckpointKeeper<Dim>::CheckpointKeeper(const CaseSpec& spec, const RunFolder& folder, const Communicator& ranks)
    : folder_(folder), ranks_(ranks), case_text_(effective_case(spec)), interval_(spec.output.checkpoint_interval) {}

template <int Dim>
void CheckpointKeeper<Dim>::go_on_from(std::int64_t step) {
  do_on_root(ranks_, [&] {
    for (const fs::path& path : checkpoints_in(folder_.path())) {
      if (path.filename() > folder_.checkpoint(step).filename()) remove_file(path);
    }
    remove_parts(folder_.checkpoints());
  });
}

template <int Dim>
void CheckpointKeeper<Dim>::remember(const Flow<Dim>& flow, const RunOutput<Dim>& output, double reference_step) {
  if (!last_) last_.emplace();
  flow.save(last_->flow);
  last_->output = output.saved();
  last_->probe_memory = output.probe_memory();
  last_->reference_step = reference_step;
  last_->rank_log = output.rank_log().saved();
}

template <int Dim>
bool CheckpointKeeper<Dim>::is_due() const {
  return ranks_.is_root() && interval_.count() > 0.0 && Clock::now() - written_at_ >= interval_;
}

template <int Dim>
bool CheckpointKeeper<Dim>::write(const Flow<Dim>& flow, const RunOutput<Dim>& output) {
  if (!last_) return false;
  written_at_ = Clock::now();
  if (written_step_ == last_->flow.state.step) return true;
  output.add_costs(last_->output);
  last_->cuts = flow.distribution->decomposition.cuts().bytes();
  do_on_root(ranks_, [&] {
    std::error_code error;
    fs::create_directory(folder_.checkpoints(), error);
    if (error) throw_io_error("make the folder", folder_.checkpoints(), error.value());
  });
  give_back_free_memory();
  write_checkpoint(folder_.checkpoint(last_->flow.state.step), *last_, case_text_, ranks_);
  written_step_ = last_->flow.state.step;
  written_at_ = Clock::now();
  do_on_root(ranks_, [&] {
    const std::vector<fs::path> files = checkpoints_in(folder_.path());
    for (std::size_t k = kept_files; k < files.size(); ++k) remove_file(files[k]);
  });
  return true;
}

template class CheckpointKeeper<2>;
template class CheckpointKeeper<3>;

}  // namespace tailwater
