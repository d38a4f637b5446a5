#include "run/folder_output.h"

#include <fmt/format.h>

#include <utility>

#include "io/messages.h"

namespace tailwater {

template <int Dim>
FolderOutput<Dim>::FolderOutput(const CaseSpec& spec, const RunOptions& options, Simulation<Dim>& simulation,
                                std::optional<Checkpoint<Dim>> checkpoint)
    : flow_(simulation.flow()),
      output_(spec, options, flow_, checkpoint ? &checkpoint->output : nullptr),
      keeper_(spec, output_.folder(), flow_.setup.ranks) {
  if (checkpoint) go_on_from(simulation, std::move(*checkpoint));
  simulation.observe(*this, output_.folder());
}

template <int Dim>
void FolderOutput<Dim>::go_on_from(Simulation<Dim>& simulation, Checkpoint<Dim> checkpoint) {
  const std::int64_t step = checkpoint.flow.state.step;
  if (!simulation.go_on_from(std::move(checkpoint.flow), checkpoint.reference_step,
                             checkpoint.is_repartitioned ? std::optional(std::move(checkpoint.cuts)) : std::nullopt)) {
    throw IoError(
        "the checkpoint does not fit the walls, bodies, open ends and probes of its case; remedy: remove the newest "
        "file in '{}', to continue from the previous one",
        output_.folder().checkpoints().string());
  }
  keeper_.go_on_from(step);
  output_.rank_log().restore(checkpoint.rank_log);
  output_.restore_probe_memory(checkpoint.probe_memory);
  tell("going on from step {}, t = {:.4f} s", flow_.state.step, flow_.state.time);
}

template class FolderOutput<2>;
template class FolderOutput<3>;

}  // namespace tailwater
