#include "app/check_json.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "case/formulation.h"
#include "case/reader.h"
#include "checks/broken_case.h"
#include "checks/check.h"
#include "io/base64.h"
#include "linear/session.h"
#include "probes/probe_set.h"
#include "published/make_flow.h"
#include "refinement/zone_words.h"
#include "results/progress.h"
#include "run/estimate.h"
#include "sampling/particle_count.h"
#include "view/scene.h"

namespace tailwater {
namespace {

constexpr std::size_t max_drawn_particles = 20000;

/// `origin`: name of the case in messages.
Json json_of(const Finding& finding, const std::string& origin) {
  const auto& [file, line, column, end_column] = finding.position;
  const bool is_of_text = file.empty() || file == origin;  // else of an override
  Json json{{"severity", finding.severity == Severity::error ? "error" : "warning"},
            {"id", finding.id},
            {"line", line},
            {"column", column},
            {"message", is_of_text ? finding.message() : finding.line()},
            {"places", Json::array()}};
  if (end_column > 0) json["end_column"] = end_column;
  if (const CaseLabel& about = finding.about; !about.table.empty()) {
    json["table"] = about.table;
    if (about.index) json["index"] = *about.index;
    json["key"] = about.key.empty() ? about.table : about.table + "." + about.key;
  }
  for (const MarkedPlace& place : finding.places) {
    json["places"].push_back(std::vector(place.x.begin(), place.x.begin() + place.dimension));
  }
  if (finding.value) json.update({{"value", finding.value->number}, {"unit", finding.value->unit}});
  if (!finding.remedy.empty()) json["remedy"] = finding.remedy;
  return json;
}

void add_findings(Json& answer, const Findings& findings, const std::string& origin) {
  for (const Finding& finding : findings) answer["findings"].push_back(json_of(finding, origin));
}

/// Adds to each object of the drawing the lines of its table.
void add_lines(Json& drawing, const CaseSources& sources) {
  const auto add = [&](Json& thing, const std::string& table) {
    if (const auto lines = sources.lines(CaseLabel(table, thing["name"].get<std::string>()))) thing["lines"] = *lines;
  };
  for (Json& wall : drawing["walls"]) {
    const std::string kind = wall["kind"];
    add(wall, kind == "body" ? "wall" : kind);
  }
  const std::pair<const char*, const char*> lists[] = {
      {"bodies", "body"}, {"inlets", "inlet"}, {"outlets", "outlet"}, {"pockets", "pocket"},
      {"vents", "vent"},  {"probes", "probe"}, {"fluid", "fluid"}};
  for (const auto& [list, table] : lists) {
    for (Json& thing : drawing[list]) add(thing, table);
  }
}

/// The water at the start; a selection of it if there is much.
template <int Dim>
Json particles_json(const FluidParticles<Dim>& fluid) {
  const std::size_t count = fluid.position.size();
  const std::size_t stride = count / max_drawn_particles + 1;
  std::string positions;
  std::string blocks;
  for (std::size_t i = 0; i < count; i += stride) {
    for (const double coordinate : fluid.position[i]) {
      const auto stored = static_cast<float>(coordinate);
      positions.append(reinterpret_cast<const char*>(&stored), sizeof(stored));
    }
    blocks += static_cast<char>(fluid.block[i]);
  }
  return {{"count", count}, {"shown", blocks.size()}, {"positions", base64(positions)}, {"fluid", base64(blocks)}};
}

template <int Dim>
Json drawing_of(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  Json drawing = scene_json<Dim>(spec, boundary);
  drawing["fluid"] = Json::array();
  for (const FluidTable& block : spec.fluid) drawing["fluid"].push_back({{"name", block.name}});
  drawing["particles"] = particles_json(fluid);
  add_lines(drawing, spec.sources);
  return drawing;
}

/// Adds the time of the run, from trial steps.
template <int Dim>
void add_time(const CaseSpec& spec, Json& answer) {
  const LinearSession session;
  Flow<Dim> flow = make_flow<Dim>(spec);
  require_reachable_end(spec, flow.setup.time_step_rule);
  const RunEstimate estimate = estimate_run(spec, flow);
  answer["cost"].update(
      {{"steps", estimate.steps}, {"seconds", estimate.seconds}, {"is_first_guess", estimate.is_from_tank}});
  answer["summary"].push_back(fmt::format(
      "About {:.0f} steps, {} on one core of this machine{}", estimate.steps, readable_duration(estimate.seconds),
      estimate.is_from_tank ? ": a first guess, from another flow" : "; violent flow takes more and smaller steps"));
}

template <int Dim>
void check_sound(const CaseSpec& spec, const std::string& origin, TrialSteps trial, Json& answer) {
  const Boundary<Dim> boundary = make_boundary<Dim>(spec);
  const Findings memory = check_memory(spec, boundary, available_memory());
  add_findings(answer, spec.sources.located(memory), origin);
  if (has_error(memory)) {
    answer["drawing"] = drawing_of<Dim>(spec, boundary, {});
    return;
  }
  const FluidParticles<Dim> fluid = make_fluid_particles(spec, boundary);
  answer["drawing"] = drawing_of<Dim>(spec, boundary, fluid);
  const Findings geometry =
      spec.refinement.empty()
          ? check_geometry(spec, boundary, fluid)
          : check_geometry(spec, boundary, make_fluid_particles(spec, boundary, {}, 0, StartVelocities::left_out));
  add_findings(answer, spec.sources.located(geometry), origin);
  const ParticleCount count = expected_particle_count(spec, boundary);
  const double memory_bytes = memory_estimate<Dim>(count, neighbours_in_support<Dim>(traits_of(spec).support));
  answer["cost"] = {{"fluid", fluid.position.size()}, {"wall", count.wall}, {"memory_bytes", memory_bytes}};
  answer["summary"].push_back(fmt::format("{} fluid particles and about {:.0f} of walls, {:g} m apart; about {:.0f} MB",
                                          fluid.position.size(), count.wall, spec.particles.spacing,
                                          memory_bytes / 1e6));
  for (const RefinementTable& zone : spec.refinement) {
    answer["summary"].push_back(fmt::format("Zone '{}': particles {:.4g} m apart {}", zone.name,
                                            spec.particles.spacing * std::exp2(-zone.level), place_of_zone(zone)));
  }
  make_probes<Dim>(spec, boundary);                                        // only for its exceptions
  if (!spec.porous.empty() && !has_error(geometry)) make_flow<Dim>(spec);  // likewise: layers are checked when made
  if (trial == TrialSteps::some && !has_error(geometry)) add_time<Dim>(spec, answer);
}

/// The drawing of the valid parts of walls that cannot be made.
template <int Dim>
Json broken_drawing(const CaseSpec& spec) {
  try {
    const BrokenCase<Dim> broken = draw_broken_case<Dim>(spec);
    return drawing_of<Dim>(spec, broken.boundary, broken.fluid);
  } catch (const InputError&) {
    return {};
  }
}

template <int Dim>
void check_what_can_be(const CaseSpec& spec, const std::string& origin, TrialSteps trial, Json& answer) {
  try {
    check_sound<Dim>(spec, origin, trial, answer);
  } catch (const CaseError& error) {
    add_findings(answer, spec.sources.located(error.findings()), origin);
    if (answer["drawing"].is_null()) answer["drawing"] = broken_drawing<Dim>(spec);
  } catch (const SolverError& failure) {
    add_findings(answer, {Finding::error("trial-step-failed", {"a trial step fails: {}", failure.what()}, {})}, origin);
  }
}

}  // namespace

Json check_as_json(const std::string& text, const std::string& origin, const std::filesystem::path& folder,
                   const std::vector<std::string>& overrides, TrialSteps trial) {
  Json answer{{"findings", Json::array()}, {"drawing", nullptr}, {"summary", Json::array()}, {"cost", nullptr}};
  try {
    const CaseSpec spec = read_case_text(text, origin, overrides, folder);
    if (spec.general.dimension == 2) {
      check_what_can_be<2>(spec, origin, trial, answer);
    } else {
      check_what_can_be<3>(spec, origin, trial, answer);
    }
  } catch (const CaseError& error) {
    add_findings(answer, error.findings(), origin);
  } catch (const InputError& error) {
    add_findings(answer, {Finding::error("case-not-readable", {"{}", error.what()}, {})}, origin);
  }
  return answer;
}

}  // namespace tailwater
