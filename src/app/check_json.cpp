#include "app/check_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "app/case_text.h"
#include "base/text.h"
#include "case/formulation.h"
#include "case/reader.h"
#include "checks/broken_case.h"
#include "checks/check.h"
#include "io/base64.h"
#include "linear/session.h"
#include "probes/probe_set.h"
#include "published/make_flow.h"
#include "results/progress.h"
#include "run/estimate.h"
#include "sampling/particle_count.h"
#include "view/scene.h"

namespace tailwater {
namespace {

constexpr std::size_t most_drawn_particles = 20000;

std::optional<int> take_place_number(std::string_view& text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end == text.data() + text.size() || *end != ':') return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()) + 1);
  return number;
}

/// The text of a case, and what messages call it.
struct CaseText {
  std::string_view text;
  std::string origin;
};

/// A line "ORIGIN:12:1: message", or one that tells no place.
Json finding_of(std::string_view line, const CaseText& of, std::string_view severity) {
  int row = 0;
  int column = 0;
  std::string_view message = line;
  if (message.starts_with(of.origin + ":")) {
    message.remove_prefix(of.origin.size() + 1);
    std::string_view rest = message;
    const std::optional<int> first = take_place_number(rest);
    const std::optional<int> second = first ? take_place_number(rest) : std::nullopt;
    if (second) {
      row = *first;
      column = *second;
      message = rest;
    }
  }
  while (message.starts_with(' ')) message.remove_prefix(1);
  Json finding{{"severity", severity}, {"line", row}, {"column", column}, {"message", message}};
  if (row > 0) {
    finding["end_column"] = end_column(of.text, row, column);
    finding["key"] = key_at(of.text, row);
  }
  return finding;
}

void add_findings(Json& findings, std::string_view message, const CaseText& of, std::string_view severity) {
  for (const std::string_view line : lines_of(message)) {
    if (!line.empty()) findings.push_back(finding_of(line, of, severity));
  }
}

/// Adds to each thing of the drawing the lines of its table. Walls of gates and wave makers stand behind those of
/// walls.
void add_lines(Json& drawing, std::string_view text) {
  auto tables = lines_of_tables(text);
  const auto put = [&](Json& thing, const std::string& table, std::size_t index) {
    const std::vector<std::pair<int, int>>& lines = tables[table];
    if (index < lines.size()) thing["lines"] = {lines[index].first, lines[index].second};
  };
  std::map<std::string, std::size_t> count;
  for (Json& wall : drawing["walls"]) {
    std::string table = wall["kind"];
    if (table == "body") table = "wall";
    put(wall, table, count[table]++);
  }
  const std::pair<const char*, const char*> lists[] = {
      {"bodies", "body"}, {"inlets", "inlet"}, {"outlets", "outlet"}, {"pockets", "pocket"},
      {"vents", "vent"},  {"probes", "probe"}, {"fluid", "fluid"}};
  for (const auto& [list, table] : lists) {
    std::size_t index = 0;
    for (Json& thing : drawing[list]) put(thing, table, index++);
  }
}

/// The water at the start, not all of it where there is much.
template <int Dim>
Json particles_json(const FluidParticles<Dim>& fluid) {
  const std::size_t count = fluid.position.size();
  const std::size_t stride = count / most_drawn_particles + 1;
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
Json drawing_of(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid,
                std::string_view text) {
  Json drawing = scene_json<Dim>(spec, boundary);
  drawing["fluid"] = Json::array();
  for (const FluidTable& block : spec.fluid) drawing["fluid"].push_back({{"name", block.name}});
  drawing["particles"] = particles_json(fluid);
  add_lines(drawing, text);
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
void check_sound(const CaseSpec& spec, const CaseText& of, TrialSteps trial, Json& answer) {
  const auto add = [&](const Finding& finding) {
    add_findings(answer["findings"], spec.sources.placed(finding.message), of,
                 finding.severity == Severity::error ? "error" : "warning");
  };
  const Boundary<Dim> boundary = make_boundary<Dim>(spec);
  const Findings memory = check_memory(spec, boundary, available_memory());
  for (const Finding& finding : memory) add(finding);
  if (has_error(memory)) {
    answer["drawing"] = drawing_of<Dim>(spec, boundary, {}, of.text);
    return;
  }
  const FluidParticles<Dim> fluid = make_fluid_particles(spec, boundary);
  answer["drawing"] = drawing_of<Dim>(spec, boundary, fluid, of.text);
  const Findings geometry = check_geometry(spec, boundary, fluid);
  for (const Finding& finding : geometry) add(finding);
  const ParticleCount count = expected_particle_count(spec, boundary);
  const double memory_bytes = memory_estimate<Dim>(count, neighbours_in_support<Dim>(traits_of(spec).support));
  answer["cost"] = {{"fluid", fluid.position.size()}, {"wall", count.wall}, {"memory_bytes", memory_bytes}};
  answer["summary"].push_back(fmt::format("{} fluid particles and about {:.0f} of walls, {:g} m apart; about {:.0f} MB",
                                          fluid.position.size(), count.wall, spec.particles.spacing,
                                          memory_bytes / 1e6));
  make_probes<Dim>(spec, boundary);  // for what it throws
  if (trial == TrialSteps::some && !has_error(geometry)) add_time<Dim>(spec, answer);
}

/// What can be drawn of walls that cannot be made.
template <int Dim>
Json broken_drawing(const CaseSpec& spec, std::string_view text) {
  try {
    const BrokenCase<Dim> broken = draw_broken_case<Dim>(spec);
    return drawing_of<Dim>(spec, broken.boundary, broken.fluid, text);
  } catch (const InputError&) {
    return {};
  }
}

template <int Dim>
void check_what_can_be(const CaseSpec& spec, const CaseText& of, TrialSteps trial, Json& answer) {
  try {
    check_sound<Dim>(spec, of, trial, answer);
  } catch (const InputError& error) {
    add_findings(answer["findings"], spec.sources.placed(error.what()), of, "error");
    if (answer["drawing"].is_null()) answer["drawing"] = broken_drawing<Dim>(spec, of.text);
  } catch (const SolverError& failure) {
    add_findings(answer["findings"], fmt::format("a trial step fails: {}", failure.what()), of, "error");
  }
}

}  // namespace

Json check_as_json(const std::string& text, const std::string& origin, const std::filesystem::path& folder,
                   const std::vector<std::string>& overrides, TrialSteps trial) {
  Json answer{{"findings", Json::array()}, {"drawing", nullptr}, {"summary", Json::array()}, {"cost", nullptr}};
  const CaseText of{text, origin};
  try {
    const CaseSpec spec = read_case_text(text, origin, overrides, folder);
    if (spec.general.dimension == 2) {
      check_what_can_be<2>(spec, of, trial, answer);
    } else {
      check_what_can_be<3>(spec, of, trial, answer);
    }
  } catch (const InputError& error) {
    add_findings(answer["findings"], error.what(), of, "error");
  }
  return answer;
}

}  // namespace tailwater
