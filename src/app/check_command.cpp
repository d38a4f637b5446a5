#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "app/commands.h"
#include "case/reader.h"
#include "flow/flow.h"
#include "geometry/preview.h"
#include "io/write_file.h"
#include "linear/session.h"
#include "probes/probe_set.h"
#include "run/estimate.h"
#include "run/progress.h"
#include "run/run_case.h"

namespace tailwater {
namespace {

struct CheckOptions {
  std::filesystem::path case_file;
  std::vector<std::string> overrides;
  std::filesystem::path preview;
};

template <int Dim>
void check_in(const CaseSpec& spec, const CheckOptions& options) {
  Flow<Dim> flow(spec);
  make_probes<Dim>(spec, flow.walls.boundary);
  require_reachable_end(spec, flow.setup.time_step_rule);
  fmt::print("{}: valid, \"{}\"\n", options.case_file.string(), spec.general.title);
  const std::string picture =
      preview_svg(spec, flow.walls.boundary, make_fluid_particles(spec, flow.walls.boundary), flow.walls.particles);
  const std::filesystem::path preview = options.preview.empty()
                                            ? std::filesystem::path(options.case_file.stem().string() + ".preview.svg")
                                            : options.preview;
  write_text_file(preview, picture);
  const RunEstimate estimate = estimate_run(spec, flow);
  fmt::print("particles: {:.0f} fluid, {:.0f} wall, spacing {:g} m\n", estimate.particles.fluid,
             estimate.particles.wall, spec.particles.spacing);
  fmt::print("memory:    about {:.0f} MB\n", estimate.memory / 1e6);
  fmt::print(
      "time:      about {:.0f} steps, {} on this machine, from trial steps of {} (violent flow takes more and "
      "smaller steps)\n",
      estimate.steps, readable_duration(estimate.seconds),
      estimate.is_from_tank ? "a tank of about 10000 particles, because the case is large: a first guess" : "the case");
  fmt::print("preview:   {}\n", preview.string());
}

void check_case(const CheckOptions& options) {
  const CaseSpec spec = read_case(options.case_file, options.overrides);
  std::error_code error;  // no preview yet: nothing to protect
  if (std::filesystem::equivalent(options.case_file, options.preview, error)) {
    throw InputError(
        fmt::format("--preview {} is the case file itself; remedy: another name", options.preview.string()));
  }
  try {
    with_places(spec, [&] {
      require_sound_geometry(spec);
      const LinearSession session;
      if (spec.general.dimension == 2) {
        check_in<2>(spec, options);
      } else {
        check_in<3>(spec, options);
      }
    });
  } catch (const SolverError& failure) {
    throw SolverError(fmt::format("{}: a trial step fails: {}", options.case_file.string(), failure.what()));
  }
}

}  // namespace

void add_check_command(CLI::App& app, ExitCode&) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command =
      app.add_subcommand("check", "Validate a case, count its particles, estimate memory and time, draw a preview");
  command->add_option("case", options->case_file, "The case file")->required()->type_name("");
  command->add_option("--set", options->overrides, "Override a key, as in --set particles.spacing=0.01")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_option("--preview", options->preview, "Picture to write (default: CASE.preview.svg in this folder)")
      ->type_name("FILE");
  command->footer("Examples: tailwater check my.toml\n          tailwater check my.toml --set particles.spacing=0.01");
  command->callback([options] { check_case(*options); });
}

}  // namespace tailwater
