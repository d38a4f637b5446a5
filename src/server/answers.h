// Answers of the server, and the parts of requests.
#pragma once

#include <httplib.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "server/folder_reader.h"

namespace tailwater {

/// "/a/b/" as {"a", "b", ""}.
std::vector<std::string> segments_of(std::string_view path);

std::optional<std::uint32_t> whole_number(std::string_view text);

/// Answers with an uncompressed text. httplib would compress `set_content` with Brotli at its highest quality, which
/// takes more than a second for the page, although the reader is on this machine.
void answer_text(httplib::Response& response, std::string text, const char* type, int status = 200);
void answer_json(httplib::Response& response, const Json& json, int status = 200);
/// {"error": message}
void answer_error(httplib::Response& response, int status, std::string_view message);
/// Answers with a file, or with the requested part of it; with the whole file where there is no such part.
void answer_file(const httplib::Request& request, httplib::Response& response, OpenFile opened, const char* type);

}  // namespace tailwater
