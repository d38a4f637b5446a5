#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.h"
#include "case/reader.h"
#include "linear/session.h"
#include "published/make_flow.h"
#include "run/estimate.h"
#include "run/explain.h"
#include "run/run_case.h"

namespace tailwater {
namespace {

template <int Dim>
void explain_in(const CaseSpec& spec) {
  require_sound_geometry(spec);
  const LinearSession session;
  Flow<Dim> flow = make_flow<Dim>(spec);
  require_reachable_end(spec, flow.setup.time_step_rule);
  for (const std::string& sentence : explain_case(spec, estimate_run(spec, flow))) fmt::print("{}\n", sentence);
}

}  // namespace

void add_explain_command(CLI::App& app, ExitCode&) {
  auto case_file = std::make_shared<std::filesystem::path>();
  auto overrides = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand("explain", "Print a summary of a case");
  command->add_option("case", *case_file, "Case file")->required()->type_name("");
  command->add_option("--set", *overrides, "Override a key, for example particles.spacing=0.01; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->footer(
      "Example: tailwater explain my.toml\n"
      "The summary lists water, walls, probes and scheme, with estimates of run time\n"
      "and memory.");
  command->callback([case_file, overrides] {
    const CaseSpec spec = read_case(*case_file, *overrides);
    with_places(spec, [&] { spec.general.dimension == 2 ? explain_in<2>(spec) : explain_in<3>(spec); });
  });
}

}  // namespace tailwater
