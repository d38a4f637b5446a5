// What `tailwater check --json` tells: of a case while somebody writes it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace tailwater {

/// What is wrong with the text of a case, what it looks like, and how large it is: {findings, drawing, summary, cost}
/// (docs/reference/view.md). No trial steps are taken, so it is quick. `origin` is what messages call the text; files
/// that it names are relative to the working folder. Throws only what is not the fault of the case.
nlohmann::ordered_json check_as_json(const std::string& text, const std::string& origin,
                                     const std::vector<std::string>& overrides = {});

}  // namespace tailwater
