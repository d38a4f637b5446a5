#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "app/check_json.h"
#include "app/commands.h"
#include "app/files_of_others.h"
#include "app/pictures.h"
#include "base/json.h"
#include "case/case_toml.h"
#include "case/reader.h"
#include "checks/broken_case.h"
#include "checks/preview.h"
#include "geometry/ducts.h"
#include "geometry/from_spec.h"
#include "geometry/opening.h"
#include "io/messages.h"
#include "io/write_file.h"
#include "linear/session.h"
#include "operators/graded_sums.h"
#include "probes/probe_set.h"
#include "published/make_flow.h"
#include "refinement/zone_words.h"
#include "results/progress.h"
#include "run/estimate.h"
#include "run/run_case.h"

namespace tailwater {
namespace {

struct CheckOptions {
  std::filesystem::path case_file;
  std::vector<std::string> overrides;
  std::filesystem::path preview;
  bool draws_nothing = false;
  bool as_json = false;
  bool takes_trial_steps = false;
};

/// The file of the preview. Under its default name it replaces any own file; under a name that the user chose it
/// replaces only another preview.
std::filesystem::path preview_file(const CheckOptions& options) {
  const bool is_asked_for = !options.preview.empty();
  const std::filesystem::path preview =
      is_asked_for ? options.preview : std::filesystem::path(options.case_file.stem().string() + ".preview.svg");
  for (const char* ending : {".svg", ".png"}) {
    const std::filesystem::path file =
        std::string_view(ending) == ".svg" ? preview : std::filesystem::path(preview).replace_extension(ending);
    if (!std::filesystem::exists(std::filesystem::symlink_status(file))) continue;
    require_own_regular_file(file);
    if (is_asked_for && !is_preview(file)) {
      throw InputError("--preview {}: '{}' exists and is not a preview; remedy: choose another name",
                       options.preview.string(), file.string());
    }
  }
  return preview;
}

/// The text of a case file; "-" is standard input.
std::string text_of_case(const std::filesystem::path& path) {
  if (path == "-") return read_case_from(std::cin);
  return read_case_file(path, largest_case_file);
}

/// Returns whether the findings contain an error.
bool print_as_json(const CheckOptions& options) {
  const std::string origin = options.case_file == "-" ? "case" : options.case_file.string();
  const std::filesystem::path folder = options.case_file.parent_path();  // empty for "-": the working folder
  const TrialSteps trial = options.takes_trial_steps ? TrialSteps::some : TrialSteps::none;
  const Json answer = check_as_json(text_of_case(options.case_file), origin, folder, options.overrides, trial);
  fmt::print("{}\n", answer.dump(-1, ' ', false, Json::error_handler_t::replace));
  return std::ranges::any_of(answer["findings"], [](const Json& finding) { return finding["severity"] == "error"; });
}

void warn_of_no_preview(const char* problem) {
  warn("preview-skipped", "no preview: {}; remedy: name another file (--preview FILE)", problem);
}

/// Writes the previews, with the places of errors marked, and prints their paths.
template <int Dim>
void write_previews(const CaseSpec& spec, const CheckOptions& options, const Boundary<Dim>& boundary,
                    const FluidParticles<Dim>& fluid, const WallParticles<Dim>& walls, std::span<const Duct<Dim>> ducts,
                    std::span<const Vec<Dim>> bad_places = {}) {
  const std::filesystem::path preview = preview_file(options);
  try {
    write_text_file(preview, preview_svg(spec, boundary, fluid, walls, ducts, bad_places));
  } catch (const IoError& problem) {
    if (!options.preview.empty()) throw;
    warn_of_no_preview(problem.what());
    return;
  }
  fmt::print("preview:   {}\n", preview.string());
  if constexpr (Dim == 3) {
    const std::filesystem::path image = std::filesystem::path(preview).replace_extension(".png");
    try {
      draw_start(image, spec.general.title, spec.particles.spacing, boundary, fluid.position, bad_places);
      fmt::print("           {}\n", image.string());
    } catch (const IoError& error) {
      warn("preview-3d-skipped", "no picture in perspective: {}", error.what());
    }
  }
}

/// Draws the valid parts of a case whose shapes are wrong, if the findings have places.
template <int Dim>
void show_bad_places(const CaseSpec& spec, const CheckOptions& options, const Findings& findings) {
  const std::vector<Vec<Dim>> places = places_of<Dim>(findings);
  if (places.empty()) return;
  try {
    const BrokenCase<Dim> drawing = draw_broken_case<Dim>(spec);
    write_previews<Dim>(spec, options, drawing.boundary, drawing.fluid, {}, find_ducts(spec, drawing.boundary), places);
  } catch (const InputError&) {
    // Nothing can be drawn, for the reason in the findings.
  } catch (const IoError& problem) {
    warn_of_no_preview(problem.what());
  }
}

/// Prints the sections of openings that the case does not draw as a rectangle.
void print_sections(const CaseSpec& spec) {
  for (const Opening<3>& end : make_open_ends<3>(spec)) {
    if (end.outline.corners().empty()) continue;
    const std::vector<Vec<3>> rim = end.rim();
    const auto lowest = std::ranges::min_element(rim, {}, [](const Vec<3>& x) { return x[2]; });
    fmt::print("section:   {}: {:.4g} m^2, {:.4g} m wide, lowest at {}\n", end.label(),
               std::abs(signed_area(end.outline.corners())), end.edges[0].norm(), place(*lowest).text());
  }
}

/// Cost of a particle and step over that without zones (docs/theory/refinement.md).
constexpr double cost_in_zones = 1.3;

/// Prints the effects of refinement zones on the case.
template <int Dim>
void print_refinement(const CaseSpec& spec, const Flow<Dim>& flow, const RunEstimate& estimate) {
  if (flow.setup.graded == nullptr) return;
  const SpacingField<Dim>& field = flow.setup.graded->field();
  double most = estimate.particles.fluid;
  for (std::size_t n = 0; n < spec.refinement.size(); ++n) {
    const auto& zone = field.zones()[n];
    const double full = particles_of_full_zone(field, n, spec, flow.box(), flow.walls.boundary);
    most += full;
    fmt::print("refinement: {}: spacing {:.4g} m {}, border {:.4g} m wide, about {:.0f} particles when full\n",
               spec.refinement[n].name, spec.particles.spacing * std::exp2(-zone.level),
               place_of_zone(spec.refinement[n]), zone.border, full);
  }
  const double finest = spec.particles.spacing * field.finest();
  const double of_one_spacing = estimate.water / power<Dim>(finest);
  const double cost = cost_in_zones / std::max(of_one_spacing, 1.0);
  const double at_start = cost * estimate.particles.fluid;
  const double largest = cost * std::min(most, of_one_spacing);
  fmt::print(
      "            the time step is that of {:.4g} m; with this spacing everywhere {:.0f} fluid particles\n"
      "            cost: about {:.2g} of such a run at the start{}\n"
      "            calm water beside a deep border keeps moving at 0.002 sqrt(g depth)\n",
      finest, of_one_spacing, at_start, largest > at_start ? fmt::format(", at most {:.2g}", largest) : "");
}

template <int Dim>
void check_in(const CaseSpec& spec, const CheckOptions& options) {
  try {
    require_sound_geometry(spec);
  } catch (const CaseError& error) {
    if (!options.draws_nothing) show_bad_places<Dim>(spec, options, error.findings());
    throw;
  }
  const LinearSession session;
  Flow<Dim> flow = make_flow<Dim>(spec);
  make_probes<Dim>(spec, flow.walls.boundary);
  require_reachable_end(spec, flow.setup.time_step_rule);
  const RunEstimate estimate = estimate_run(spec, flow);
  fmt::print("{}: valid, \"{}\"\n", options.case_file.string(), spec.general.title);
  fmt::print("particles: {:.0f} fluid, {:.0f} wall, spacing {:g} m\n", estimate.particles.fluid,
             estimate.particles.wall, spec.particles.spacing);
  if (estimate.largest_fluid > 1.1 * estimate.particles.fluid) {
    fmt::print("           with the inflow at most about {:.2g} fluid\n", estimate.largest_fluid);
  }
  print_refinement(spec, flow, estimate);
  fmt::print("memory:    about {:.0f} MB\n", estimate.memory / 1e6);
  fmt::print(
      "time:      about {:.0f} steps, {} on one core of this machine, from trial steps of {} (violent flow takes more "
      "and smaller steps)\n",
      estimate.steps, readable_duration(estimate.seconds),
      !estimate.is_from_tank ? "the case"
      : estimate.grows_much  ? "a tank of as much water, because most of it enters later: a first guess"
                             : "a tank of about 10000 particles, because the case is large: a first guess");
  if constexpr (Dim == 3) print_sections(spec);
  if (options.draws_nothing) return;
  const Boundary<Dim> drawn = make_boundary<Dim>(spec);
  // Cells are divided in zones only for particles with velocities.
  const auto velocities = spec.refinement.empty() ? StartVelocities::left_out : StartVelocities::found;
  const auto fluid = make_fluid_particles(spec, drawn, {}, 0, velocities);
  write_previews<Dim>(spec, options, drawn, fluid, flow.walls.particles, flow.walls.boundary.ducts);
}

/// Looks for problems with the file of the preview before the check begins. The check goes on without a preview that
/// was not asked for.
void look_at_preview(CheckOptions& options) {
  try {
    if (!options.draws_nothing) preview_file(options);
  } catch (const InputError& problem) {
    if (!options.preview.empty()) throw;
    warn_of_no_preview(problem.what());
    options.draws_nothing = true;
  }
}

void check_case(CheckOptions options) {
  look_at_preview(options);
  const CaseSpec spec = read_case(options.case_file, options.overrides);
  std::error_code error;  // without a preview there is nothing to protect
  if (std::filesystem::equivalent(options.case_file, options.preview, error)) {
    throw InputError("--preview {} is the case file itself; remedy: choose another name", options.preview.string());
  }
  if (options.preview.extension() == ".png") {
    throw InputError(
        "--preview {}: the preview is an SVG file, beside which a picture in perspective is written as a PNG file; "
        "remedy: a name that ends with .svg",
        options.preview.string());
  }
  try {
    with_places(spec, [&] {
      if (spec.general.dimension == 2) {
        check_in<2>(spec, options);
      } else {
        check_in<3>(with_sections_found(spec), options);
      }
    });
  } catch (const SolverError& failure) {
    throw SolverError("{}: a trial step fails: {}", options.case_file.string(), failure.what());
  }
}

}  // namespace

void add_check_command(CLI::App& app, ExitCode& code) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand("check", "Find errors, estimate size and run time, draw a preview");
  command->add_option("case", options->case_file, "Case file")->required()->type_name("");
  command
      ->add_option("--set", options->overrides, "Override a key, for example particles.spacing=0.01; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command
      ->add_option("--preview", options->preview,
                   "SVG file for the preview (default: CASE.preview.svg in the current folder). In 3D a perspective "
                   "view is written beside it as PNG. Geometry errors are marked.")
      ->type_name("FILE");
  command->add_flag("--no-preview", options->draws_nothing, "Draw no preview");
  command->footer(
      "Examples: tailwater check my.toml\n"
      "          tailwater check my.toml --set particles.spacing=0.01\n"
      "Each error is reported with file, line and remedy. The run time is estimated\n"
      "from a few trial steps on this machine.");
  CLI::Option* json = command->add_flag("--json", options->as_json,
                                        "Print findings, geometry and size as JSON, without trial steps. The case "
                                        "\"-\" is read from standard input.");
  command
      ->add_flag("--trial-steps", options->takes_trial_steps, "With --json: take trial steps and estimate the run time")
      ->needs(json);
  command->callback([options, &code] {
    if (options->as_json) {
      if (print_as_json(*options)) code = ExitCode::bad_input;
    } else {
      check_case(*options);
    }
  });
}

}  // namespace tailwater
