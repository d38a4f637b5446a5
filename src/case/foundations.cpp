#include "case/foundations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "case/case_toml.h"
#include "case/expression.h"
#include "case/named_numbers.h"
#include "case/problems.h"

namespace tailwater {
namespace {

/// Numbers that use it are not numbers either, and are not reported a second time.
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Sets the values of the parameters, dx and g, each after the numbers that it uses.
class NamedNumbersReader {
 public:
  NamedNumbersReader(CaseSpec& spec, Context& context, const toml::table& root)
      : spec_(spec),
        context_(context),
        particles_(context, root["particles"].as_table(), CaseLabel("particles")),
        physics_(context, root["physics"].as_table(), CaseLabel("physics")) {
    find_parameters(root.get("parameters"));
    open_["dx"] = particles_.given("spacing");
    open_["g"] = physics_.given("gravity");
  }

  void read() {
    std::vector<std::string> names;
    for (const auto& [name, node] : open_) names.push_back(name);
    settle(names);
    // Done last, so that a message about an unknown name lists all known names.
    while (!of_unknown_.empty()) {
      const std::string name = of_unknown_.back();
      of_unknown_.pop_back();
      give_value(name);
    }
    while (!open_.empty()) {
      const std::string name = one_in_a_circle();
      report("parameter-circular", name, *open_.at(name),
             "depends on itself through other parameters; give one of them a number");
      close(name, unknown);
    }
    for (const auto& [name, value] : context_.numbers) {
      if (name != "dx" && name != "g") spec_.parameters.push_back({name, value});
    }
  }

 private:
  void find_parameters(const toml::node* node) {
    if (node == nullptr) return;
    const toml::table* table = node->as_table();
    if (table == nullptr) {
      report("parameters-not-table", "", *node, "not a table; write the parameters below a line [parameters]");
      return;
    }
    constexpr std::size_t most = 1000;  // their names are compared with each unknown one
    if (table->size() > most) {
      report("parameters-too-many", "", *node,
             fmt::format("has {} parameters, and a case has at most {}; remove some", table->size(), most));
      return;
    }
    for (const auto& [key, value] : *table) {
      const std::string name(key.str());
      const bool is_position = std::find(position_names.begin(), position_names.end(), name) != position_names.end();
      if (is_free_name(name) && !is_position && name != time_name[0] && name != "dx" && name != "g") {
        open_[name] = &value;
        continue;
      }
      report("parameter-name", name, value,
             "cannot be a parameter's name; use letters, digits and _, and another name than x, y, z, t, dx, g, pi or "
             "that of a function");
    }
  }

  /// Sets these numbers and those that depend on them, as far as the numbers that they use have values.
  void settle(std::vector<std::string> names) {
    while (!names.empty()) {
      const std::string name = names.back();
      names.pop_back();
      const auto open = open_.find(name);
      if (open == open_.end()) continue;  // in a circle, it depended on itself
      const std::optional<std::string> missing = missing_in(open->second);
      if (!missing) {
        give_value(name);
      } else if (open_.contains(*missing)) {
        waiting_for_[*missing].push_back(name);
      } else {
        of_unknown_.push_back(name);
      }
    }
  }

  /// A name without a value that the expressions of a key use.
  std::optional<std::string> missing_in(const toml::node* node) const {
    if (node == nullptr) return std::nullopt;
    if (const toml::array* list = node->as_array()) {
      for (const toml::node& element : *list) {
        if (const auto missing = missing_in(&element)) return missing;
      }
    }
    const auto* text = node->as_string();
    if (text == nullptr) return std::nullopt;
    try {
      evaluate(text->get(), context_.numbers);
    } catch (const ExpressionError& error) {
      return error.unknown_name();
    }
    return std::nullopt;
  }

  /// One of the names that depend on each other.
  std::string one_in_a_circle() const {
    std::string name = open_.begin()->first;
    for (std::set<std::string> seen; seen.insert(name).second;) name = *missing_in(open_.at(name));
    return name;
  }

  /// Sets the value of a name, or reports why there is none.
  void give_value(const std::string& name) {
    if (name == "dx") {
      particles_.read_ahead(spec_.particles, {"spacing"});
      close(name, particles_.is_wrong("spacing") ? unknown : spec_.particles.spacing);
    } else if (name == "g") {
      physics_.read_ahead(spec_.physics, {"gravity"});
      close(name, physics_.is_wrong("gravity") ? unknown : gravity_magnitude(spec_.physics));
    } else {
      close(name, value_of_parameter(name, *open_.at(name)));
    }
  }

  double value_of_parameter(const std::string& name, const toml::node& node) {
    try {
      if (const auto* text = node.as_string()) return evaluate(text->get(), context_.numbers);
      if (const auto number = number_in(node); node.is_number() && std::isfinite(*number)) return *number;
      report("parameter-not-finite", name, node,
             "not a finite number; give a number or an expression of other parameters");
    } catch (const ExpressionError& error) {
      report("expression-invalid", name, node, error.what());
    }
    return unknown;
  }

  /// Records a value and continues with the numbers that depend on it.
  void close(const std::string& name, double value) {
    context_.numbers[name] = value;
    open_.erase(name);
    settle(std::exchange(waiting_for_[name], {}));
  }

  void report(MessageId id, const std::string& name, const toml::node& node, const std::string& message) {
    const CaseLabel key = name == "dx"  ? CaseLabel("particles").with_key("spacing")
                          : name == "g" ? CaseLabel("physics").with_key("gravity")
                                        : CaseLabel("parameters").with_key(name);
    context_.problems.wrong(id, key, node, message);
    context_.keys_done.insert(key.text());
  }

  CaseSpec& spec_;
  Context& context_;
  TableReader particles_;
  TableReader physics_;
  std::map<std::string, const toml::node*> open_;  ///< without a value yet; null: absent from the file
  std::map<std::string, std::vector<std::string>> waiting_for_;
  std::vector<std::string> of_unknown_;  ///< names that use an unknown name
};

}  // namespace

void read_foundations(CaseSpec& spec, Context& context, const toml::table& root) {
  TableReader general(context, root["case"].as_table(), CaseLabel("case"));
  general.read_ahead(spec.general, {"format", "dimension"});
  if (spec.general.format > case_format) {
    // Other apparent errors may be valid in that format.
    general.wrong(
        "case-format-newer", "format", *general.given("format"),
        fmt::format("this version reads case files up to format {}; use a newer version of Tailwater", case_format));
    throw CaseError(context.problems.findings());
  }
  context.dimension = general.is_wrong("dimension") ? 0 : spec.general.dimension;
  if (context.dimension == 3) spec.physics.gravity = {0.0, 0.0, -9.81};
  NamedNumbersReader(spec, context, root).read();
}

}  // namespace tailwater
