// The folder of a run as an observer of its steps: output, checkpoints, and the report of a step that fails.
#pragma once

#include <string>

#include "neighbours/decomposition.h"
#include "run/checkpoint.h"
#include "run/checkpoint_keeper.h"
#include "run/run_output.h"
#include "run/simulation.h"

namespace tailwater {

/// Functions are collective, and throw IoError on all ranks.
template <int Dim>
class FolderOutput final : public RunObserver<Dim> {
 public:
  /// Makes the folder and observes the simulation, or resumes from a checkpoint, whose state and cuts the simulation
  /// takes. Borrows all but the checkpoint. Throws the exceptions of RunOutput.
  FolderOutput(const CaseSpec& spec, const RunOptions& options, Simulation<Dim>& simulation,
               std::optional<Checkpoint<Dim>> checkpoint = {});

  const RunFolder& folder() const { return output_.folder(); }

  /// Call before the first step; then call finish or finish_failed at the end.
  void begin() { output_.begin(flow_); }
  void finish(ExitCode code) { output_.finish(flow_, code); }
  void finish_failed(ExitCode code, const std::string& message) { output_.finish_failed(flow_, code, message); }

  /// See CheckpointKeeper.
  bool checkpoint_is_due() const { return keeper_.is_due(); }
  bool write_checkpoint() { return keeper_.write(flow_, output_); }

  void started(const Flow<Dim>& flow) override { output_.record_probes(flow, measure(flow)); }
  void before_step(const Flow<Dim>& flow) override { output_.write_due_fields(flow); }
  void repartitioned(const Flow<Dim>& flow, const Repartition& repartition) override {
    output_.record_repartition(flow, repartition);
  }
  void can_go_on(const Flow<Dim>& flow, double reference_step) override {
    keeper_.remember(flow, output_, reference_step);
  }
  void stepped(const Flow<Dim>& flow, const StepReport& report) override { output_.record_step(flow, report); }

 private:
  void go_on_from(Simulation<Dim>& simulation, Checkpoint<Dim> checkpoint);

  const Flow<Dim>& flow_;
  RunOutput<Dim> output_;
  CheckpointKeeper<Dim> keeper_;
};

}  // namespace tailwater
