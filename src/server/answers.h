// Answers of the server, and what requests are made of.
#pragma once

#include <httplib.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/folder_reader.h"

namespace tailwater {

/// "/a/b/" as {"a", "b", ""}.
std::vector<std::string> segments_of(std::string_view path);

std::optional<std::uint32_t> whole_number(std::string_view text);

void answer_json(httplib::Response& response, const nlohmann::ordered_json& json, int status = 200);
/// {"error": message}
void answer_error(httplib::Response& response, int status, std::string_view message);
/// A file, or the part of it that was asked for; all of it where there is no such part.
void answer_file(const httplib::Request& request, httplib::Response& response, OpenFile opened, const char* type);

}  // namespace tailwater
