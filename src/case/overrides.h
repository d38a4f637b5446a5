// Changes to a case file from the command line: --set key.path=value.
#pragma once

#include <string>
#include <vector>

#include <toml++/toml.h>

#include "case/problems.h"

namespace tailwater {

/// Puts the value of each override into the tree. An override is `scheme.courant=0.1`, `parameters.H=0.5`,
/// `fluid[0].max=[1, 2]` (tables count from 0), `probe.NAME.interval=0.01` or `fluid[0].max[1]=2`. The value is TOML; a
/// text that is not valid TOML becomes a string, so that words and expressions need no quotes. The source of the new
/// values names the override. Reports each override whose key cannot exist in the tree.
void apply_overrides(toml::table& root, const std::vector<std::string>& overrides, Problems& problems);

/// The name in messages of the override that a value came from; the source path of its values.
inline constexpr std::string_view override_prefix = "--set ";

}  // namespace tailwater
