#include "server/answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "server/guard.h"

namespace tailwater {

using httplib::Request;
using httplib::Response;

std::vector<std::string> segments_of(std::string_view path) {
  std::vector<std::string> segments;
  while (!path.empty()) {
    path.remove_prefix(1);  // '/'
    segments.emplace_back(path.substr(0, path.find('/')));
    path.remove_prefix(segments.back().size());
  }
  return segments;
}

std::optional<std::uint32_t> whole_number(std::string_view text) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

void answer_text(Response& response, std::string text, const char* type, int status) {
  response.status = status;
  if (text.empty()) return response.set_content("", type);
  const std::size_t length = text.size();
  response.set_content_provider(length, type,
                                [text = std::move(text)](std::size_t offset, std::size_t count, auto& sink) {
                                  return sink.write(text.data() + offset, count);
                                });
}

void answer_json(Response& response, const Json& json, int status) {
  answer_text(response, json.dump(-1, ' ', false, Json::error_handler_t::replace), "application/json", status);
}

void answer_error(Response& response, int status, std::string_view message) {
  answer_json(response, {{"error", message}}, status);
}

void answer_file(const Request& request, Response& response, OpenFile opened, const char* type) {
  const ByteRange whole{0, opened.size() - 1};
  ByteRange range = whole;
  const RangeAnswer asked = range_of(request.get_header_value("Range"), opened.size(), range);
  response.set_header("Accept-Ranges", "bytes");
  // A file may have become shorter, as tables of a resumed run. It is then sent whole, because a browser would log a
  // refusal.
  if (asked == RangeAnswer::impossible) range = whole;
  response.status = 200;
  if (asked == RangeAnswer::part) {
    response.status = 206;
    response.set_header("Content-Range", fmt::format("bytes {}-{}/{}", range.first, range.last, opened.size()));
  }
  const auto length = static_cast<std::size_t>(range.last - range.first + 1);
  if (length == 0) return response.set_content("", type);
  const auto file = std::make_shared<OpenFile>(std::move(opened));
  response.set_content_provider(
      length, type, [file, first = range.first](std::size_t offset, std::size_t count, auto& sink) {
        constexpr std::size_t piece = std::size_t{1} << 18U;
        const std::string bytes =
            file->read(first + static_cast<std::int64_t>(offset), static_cast<std::int64_t>(std::min(count, piece)));
        // If the file has become shorter meanwhile, the connection ends, and the client detects that bytes are missing.
        return !bytes.empty() && sink.write(bytes.data(), bytes.size());
      });
}

}  // namespace tailwater
