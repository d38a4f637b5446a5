#include "app/check_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "case/formulation.h"
#include "case/reader.h"
#include "checks/broken_case.h"
#include "checks/check.h"
#include "io/base64.h"
#include "probes/probe_set.h"
#include "run/estimate.h"
#include "sampling/particle_count.h"
#include "view/scene.h"

namespace tailwater {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_drawn_particles = 20000;

std::optional<int> take_place_number(std::string_view& text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end == text.data() + text.size() || *end != ':') return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()) + 1);
  return number;
}

/// A line "ORIGIN:12:1: message", or one that tells no place.
Json finding_of(std::string_view line, const std::string& origin, std::string_view severity) {
  int row = 0;
  int column = 0;
  std::string_view message = line;
  if (message.starts_with(origin + ":")) {
    message.remove_prefix(origin.size() + 1);
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
  return {{"severity", severity}, {"line", row}, {"column", column}, {"message", message}};
}

void add_findings(Json& findings, std::string_view message, const std::string& origin, std::string_view severity) {
  while (!message.empty()) {
    const std::string_view line = message.substr(0, message.find('\n'));
    message.remove_prefix(std::min(message.size(), line.size() + 1));
    if (!line.empty()) findings.push_back(finding_of(line, origin, severity));
  }
}

/// "wall" if a line is the heading of such a table, [wall] or [[wall]]; else nothing. Values in brackets that begin a
/// line are none.
std::string table_in(std::string_view line) {
  while (!line.empty() && std::isspace(static_cast<unsigned char>(line.front())) != 0) line.remove_prefix(1);
  const std::size_t brackets = line.starts_with("[[") ? 2 : line.starts_with("[") ? 1 : 0;
  if (brackets == 0) return "";
  const std::size_t end = line.find(']');
  if (end == line.npos) return "";
  const std::string_view name = line.substr(brackets, end - brackets);
  const bool is_name =
      !name.empty() && std::ranges::all_of(name, [](char c) { return c == '_' || (c >= 'a' && c <= 'z'); });
  return is_name ? std::string(name) : "";
}

/// First and last line of each table of a case's text, by the name of the table.
std::map<std::string, std::vector<std::pair<int, int>>> lines_of_tables(std::string_view text) {
  std::map<std::string, std::vector<std::pair<int, int>>> tables;
  std::pair<int, int>* open = nullptr;
  int number = 0;
  while (!text.empty()) {
    ++number;
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const std::string table = table_in(line);
    if (!table.empty()) open = &tables[table].emplace_back(number, number);
    const bool is_blank = line.find_first_not_of(" \t\r") == line.npos || line.starts_with('#');
    if (open != nullptr && !is_blank) open->second = number;
  }
  return tables;
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
      {"bodies", "body"}, {"inlets", "inlet"}, {"outlets", "outlet"}, {"probes", "probe"}, {"fluid", "fluid"}};
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

template <int Dim>
void check_sound(const CaseSpec& spec, const std::string& text, const std::string& origin, Json& answer) {
  const auto add = [&](const Finding& finding) {
    add_findings(answer["findings"], spec.sources.placed(finding.message), origin,
                 finding.severity == Severity::error ? "error" : "warning");
  };
  const Boundary<Dim> boundary = make_boundary<Dim>(spec);
  const Findings memory = check_memory(spec, boundary, available_memory());
  for (const Finding& finding : memory) add(finding);
  if (has_error(memory)) {
    answer["drawing"] = drawing_of<Dim>(spec, boundary, {}, text);
    return;
  }
  const FluidParticles<Dim> fluid = make_fluid_particles(spec, boundary);
  answer["drawing"] = drawing_of<Dim>(spec, boundary, fluid, text);
  for (const Finding& finding : check_geometry(spec, boundary, fluid)) add(finding);
  const ParticleCount count = expected_particle_count(spec, boundary);
  const double memory_bytes = memory_estimate<Dim>(count, neighbours_in_support<Dim>(traits_of(spec).support));
  answer["cost"] = {{"fluid", fluid.position.size()}, {"wall", count.wall}, {"memory_bytes", memory_bytes}};
  answer["summary"].push_back(fmt::format("{} fluid particles and about {:.0f} of walls, {:g} m apart; about {:.0f} MB",
                                          fluid.position.size(), count.wall, spec.particles.spacing,
                                          memory_bytes / 1e6));
  make_probes<Dim>(spec, boundary);  // for what it throws
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
void check_what_can_be(const CaseSpec& spec, const std::string& text, const std::string& origin, Json& answer) {
  try {
    check_sound<Dim>(spec, text, origin, answer);
  } catch (const InputError& error) {
    add_findings(answer["findings"], spec.sources.placed(error.what()), origin, "error");
    if (answer["drawing"].is_null()) answer["drawing"] = broken_drawing<Dim>(spec, text);
  }
}

}  // namespace

Json check_as_json(const std::string& text, const std::string& origin, const std::vector<std::string>& overrides) {
  Json answer{{"findings", Json::array()}, {"drawing", nullptr}, {"summary", Json::array()}, {"cost", nullptr}};
  try {
    const CaseSpec spec = read_case_text(text, origin, overrides);
    if (spec.general.dimension == 2) {
      check_what_can_be<2>(spec, text, origin, answer);
    } else {
      check_what_can_be<3>(spec, text, origin, answer);
    }
  } catch (const InputError& error) {
    add_findings(answer["findings"], error.what(), origin, "error");
  }
  return answer;
}

}  // namespace tailwater
