#include "case_help/schema_rules.h"

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

namespace tailwater {
namespace {

/// Rule: the key has one of these values, given or, where `is_default`, left out.
Json is(const char* key, std::initializer_list<const char*> values, bool is_default = false) {
  Json rule{{"properties", {{key, {{"enum", Json(std::vector<const char*>(values))}}}}}};
  if (!is_default) rule["required"] = Json::array({key});
  return rule;
}

/// Rule: the key is given. The effective case of a run has "", 0 or [] for absent keys.
Json is_given(const char* key) {
  return {{"required", Json::array({key})}, {"properties", {{key, {{"not", {{"enum", {"", 0, Json::array()}}}}}}}}};
}

Json any_is_given(std::initializer_list<const char*> keys) {
  Json any = Json::array();
  for (const char* key : keys) any.push_back(is_given(key));
  return {{"anyOf", std::move(any)}};
}

Json not_both(const char* one, const char* other) {
  return {{"not", {{"allOf", Json::array({is_given(one), is_given(other)})}}}};
}

Json if_then(Json condition, Json rule) { return {{"if", std::move(condition)}, {"then", std::move(rule)}}; }

Json rule_for(const char* key, Json rule) { return {{"properties", {{key, std::move(rule)}}}}; }

Json needs(const char* key) { return {{"required", Json::array({key})}}; }

Json one_of(std::initializer_list<const char*> values) { return {{"enum", Json(std::vector<const char*>(values))}}; }

Json none_of(std::initializer_list<const char*> values) { return {{"not", one_of(values)}}; }

Json at_least(int count) { return {{"minItems", count}}; }

/// Rule: no vector of zeros.
Json has_length() { return rule_for("direction", {{"not", {{"items", {{"const", 0}}}}}}); }

Json rules_of_walls() {
  const Json is_chain = is("shape", {"polyline"}, true);
  const Json is_body = is("shape", {"polygon", "box"});
  const Json is_mesh = is("shape", {"mesh"});
  return Json::array({
      if_then(is_chain, rule_for("fluid_side", one_of({"left", "right"}))),
      if_then(is_body, rule_for("fluid_side", one_of({"inside", "outside"}))),
      if_then(is_mesh, rule_for("fluid_side", none_of({"left", "right"}))),
      if_then(is_mesh, needs("fluid_side")),
      if_then(is("shape", {"polyline", "polygon"}, true), any_is_given({"points", "points_file"})),
      rule_for("points", at_least(2)),
      if_then(is("shape", {"polygon"}), rule_for("points", at_least(3))),
      not_both("points", "points_file"),
      not_both("roughness", "manning"),
  });
}

/// An opening has one section, drawn in one way.
Json rules_of_openings() {
  return Json::array({
      has_length(),
      any_is_given({"from", "polygon", "centre", "through"}),
      if_then(is_given("from"), is_given("to")),
      if_then(is_given("to"), is_given("from")),
      if_then(is_given("centre"), is_given("radius")),
      if_then(is_given("radius"), is_given("centre")),
      not_both("from", "polygon"),
      not_both("from", "centre"),
      not_both("from", "through"),
      not_both("polygon", "centre"),
      not_both("polygon", "through"),
      not_both("centre", "through"),
      rule_for("polygon", {{"not", {{"minItems", 1}, {"maxItems", 2}}}}),
  });
}

Json rules_of_inlets() {
  Json rules = rules_of_openings();
  const Json own = Json::array({
      any_is_given({"discharge", "velocity", "level", "file"}),
      not_both("discharge", "velocity"),
      if_then(is_given("profile"), any_is_given({"discharge", "velocity", "file"})),
      if_then(is_given("absorbing"), any_is_given({"level", "file"})),
      if_then(is_given("absorbing"), {{"not", any_is_given({"discharge", "velocity"})}}),
      if_then(is_given("reserve"), is_given("water_from")),
  });
  rules.insert(rules.end(), own.begin(), own.end());
  return rules;
}

Json rules_of_outlets() {
  Json rules = rules_of_openings();
  rules.push_back(if_then(is("beyond", {"air"}), {{"not", any_is_given({"level", "file"})}}));
  rules.push_back(if_then(is_given("absorbing"), any_is_given({"level", "file"})));
  return rules;
}

Json rules_of_wave_makers() {
  return Json::array({
      if_then(is("waves", {"none"}), is("absorption", {"active"})),
      if_then(is("type", {"flap"}), rule_for("waves", none_of({"solitary", "n-wave"}))),
      if_then(is("waves", {"jonswap", "focused"}), rule_for("ramp", {{"exclusiveMinimum", 0}})),
      if_then(is("waves", {"focused"}), rule_for("focus", {{"minItems", 2}, {"maxItems", 2}})),
  });
}

Json rules_of_damping() {
  return Json::array({
      rule_for("waves", none_of({"solitary", "n-wave"})),
      if_then(is("waves", {"jonswap", "focused"}), rule_for("ramp", {{"exclusiveMinimum", 0}})),
      if_then(is("waves", {"focused"}), rule_for("focus", {{"minItems", 2}, {"maxItems", 2}})),
  });
}

/// Numbers for the three or six degrees of freedom of a body.
Json rule_for_freedoms(const char* key) {
  const Json lengths = Json::array(
      {Json{{"maxItems", 0}}, Json{{"minItems", 3}, {"maxItems", 3}}, Json{{"minItems", 6}, {"maxItems", 6}}});
  return rule_for(key, {{"items", {{"minimum", 0}}}, {"anyOf", lengths}});
}

/// A body that is free to turn, as by default, needs its inertia.
Json rules_of_bodies() {
  const Json turn{{"pattern", "^rotation"}};
  const Json no_turn =
      Json::array({Json{{"type", "array"}, {"not", {{"contains", turn}}}}, Json{{"type", "string"}, {"not", turn}}});
  Json does_not_turn = rule_for("free", {{"anyOf", no_turn}});
  does_not_turn["required"] = Json::array({"free"});
  return Json::array({
      needs("walls"),
      rule_for("walls", at_least(1)),
      {{"anyOf", Json::array({does_not_turn, is_given("inertia")})}},
      rule_for_freedoms("springs"),
      rule_for_freedoms("damping"),
      rule_for_freedoms("quadratic_damping"),
      rule_for_freedoms("extra_mass"),
  });
}

Json rules_of_probes() {
  return Json::array({
      rule_for("name", {{"pattern", "^[A-Za-z0-9_][A-Za-z0-9_-]{0,99}$"}}),
      if_then(is_given("region_min"), needs("region_max")),
      if_then(is_given("region_max"), needs("region_min")),
      rule_for("times", {{"items", {{"minimum", 0}}}}),
      has_length(),
  });
}

/// Rule: two numbers, or none.
Json is_range() { return {{"maxItems", 2}, {"not", {{"minItems", 1}, {"maxItems", 1}}}}; }

}  // namespace

Json table_rules_of_schema(std::string_view table) {
  if (table == "domain") {
    return Json::array(
        {rule_for("periodic_x", is_range()), rule_for("periodic_y", is_range()), rule_for("periodic_z", is_range())});
  }
  if (table == "fluid") return Json::array({rule_for("points", at_least(3))});
  if (table == "refinement") {
    return Json::array(
        {rule_for("points", at_least(3)), if_then(is("shape", {"walls"}), rule_for("walls", at_least(1)))});
  }
  if (table == "porous") {
    return Json::array(
        {rule_for("points", at_least(3)),
         if_then(is("resistance", {"coefficients"}), {{"anyOf", Json::array({needs("linear"), needs("quadratic")})}})});
  }
  if (table == "wall") return rules_of_walls();
  if (table == "inlet") return rules_of_inlets();
  if (table == "outlet") return rules_of_outlets();
  if (table == "wave_maker") return rules_of_wave_makers();
  if (table == "damping") return rules_of_damping();
  if (table == "body") return rules_of_bodies();
  if (table == "mooring") {
    return Json::array({needs("body"), rule_for("body", {{"minLength", 1}, {"minItems", 1}, {"maxItems", 2}})});
  }
  if (table == "probe") return rules_of_probes();
  return Json::array();
}

Json file_rules_of_schema() {
  Json has_fluid = needs("fluid");
  has_fluid["properties"]["fluid"] = at_least(1);
  Json has_level_beyond = needs("outlet");
  has_level_beyond["properties"]["outlet"] = {{"contains", {{"anyOf", Json::array({needs("level"), needs("file")})}}}};
  const Json has_bodies{{"required", Json::array({"body"})}, {"properties", {{"body", at_least(1)}}}};
  const Json has_layers{{"required", Json::array({"porous"})}, {"properties", {{"porous", at_least(1)}}}};
  const Json has_liquids{{"required", Json::array({"liquid"})}, {"properties", {{"liquid", at_least(1)}}}};
  Json lets_bodies_float = rule_for("name", one_of({"farzin2014"}));
  lets_bodies_float["properties"]["formulation"] = one_of({"robust"});
  Json is_published = needs("scheme");
  is_published["properties"]["scheme"] = is("formulation", {"published"});
  Json is_two_step = needs("scheme");
  is_two_step["properties"]["scheme"] = is("name", {"farmani2020"});
  const Json has_studies{{"propertyNames", none_of({"divergence_free", "displacement"})}};
  return Json::array({
      {{"anyOf", Json::array({std::move(has_fluid), needs("inlet"), std::move(has_level_beyond)})}},
      if_then(has_bodies, rule_for("scheme", lets_bodies_float)),
      if_then(has_layers, rule_for("scheme", lets_bodies_float)),
      if_then(has_liquids, rule_for("scheme", lets_bodies_float)),
      if_then(has_layers, rule_for("air", rule_for("pockets", one_of({"none"})))),
      if_then(std::move(is_published), rule_for("study", {{"maxProperties", 0}})),
      if_then(std::move(is_two_step), rule_for("study", has_studies)),
  });
}

Json dimension_rules_of_schema(int dimension) {
  const auto each = [](const char* key, Json rule) -> Json { return {{"items", rule_for(key, std::move(rule))}}; };
  if (dimension == 2) {
    const Json in_plane = none_of({"-z", "+z"});
    Json wall = each("shape", none_of({"mesh"}));
    wall["items"]["properties"]["open"] = {{"items", in_plane}};
    wall["items"]["properties"]["axis"] = {{"items", {{"minimum", 0}, {"maximum", 0}}}};
    Json segment;
    for (const char* key : {"polygon", "centre", "through"}) segment["items"]["properties"][key] = {{"maxItems", 0}};
    return {{"fluid", each("shape", none_of({"mesh"}))},
            {"inlet", segment},
            {"outlet", segment},
            {"wall", std::move(wall)},
            {"gate", each("side", in_plane)},
            {"wave_maker", each("side", in_plane)},
            {"body", each("free", {{"items", one_of({"x", "y", "rotation"})}})},
            {"damping", each("towards", in_plane)},
            {"porous", each("shape", none_of({"mesh"}))},
            {"domain", rule_for("periodic_z", {{"maxItems", 0}})}};
  }
  Json wall{{"items", is("shape", {"box", "mesh", "plate"})}};
  wall["items"]["allOf"] = Json::array({if_then(is_given("rotation"), needs("axis"))});
  return {{"physics", rule_for("channel_width", {{"maximum", 0}})},
          {"fluid", each("shape", none_of({"polygon"}))},
          {"porous", each("shape", none_of({"polygon"}))},
          {"wall", std::move(wall)},
          {"body", each("free", {{"items", none_of({"rotation"})}})}};
}

}  // namespace tailwater
