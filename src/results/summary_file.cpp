#include "results/summary_file.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/input_file.h"
#include "base/json.h"
#include "io/write_file.h"

namespace tailwater {
namespace {

/// The result is no object if the file does not contain one.
Json parse_summary(const std::filesystem::path& path) {
  std::ifstream file = open_input_file(path);
  return Json::parse(file, nullptr, false);
}

}  // namespace

void write_last_file(const std::filesystem::path& path, const std::string& text) {
  try {
    write_text_file(path, text);
  } catch (const IoError&) {
    if (!overwrite_file(path, text)) throw;
  }
}

void mark_as_failed(const std::filesystem::path& summary, ExitCode code, const std::string& message) {
  Json json = parse_summary(summary);
  if (!json.is_object() || !json.contains("status") || json["status"] != "running") return;
  json["status"] = "failed";
  json["exit_code"] = static_cast<int>(code);
  json["message"] = message;
  try {
    write_last_file(summary, json.dump(2) + "\n");
  } catch (const IoError&) {
    // The user must see the first error.
  }
}

std::filesystem::path case_named_in(const std::filesystem::path& summary) {
  const Json json = parse_summary(summary);
  const bool names_one = json.is_object() && json.contains("case") && json["case"].is_string();
  return names_one ? json["case"].get<std::string>() : std::string();
}

int ranks_named_in(const std::filesystem::path& summary) {
  const Json json = parse_summary(summary);
  const Json::json_pointer count("/ranks/count");
  return json.contains(count) && json[count].is_number_integer() ? std::max(1, json[count].get<int>()) : 1;
}

}  // namespace tailwater
