#include "server/guard.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <optional>
#include <system_error>

namespace tailwater {
namespace {

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == text.npos && text.size() <= 18;
}

std::optional<long long> number_in(std::string_view text) {
  if (!is_number(text)) return std::nullopt;
  long long number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

}  // namespace

std::string random_token() {
  std::array<std::uint8_t, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw std::system_error(errno, std::generic_category(), "no random numbers");
  }
  std::string token;
  for (const std::uint8_t byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

bool is_token(std::string_view word, std::string_view token) {
  unsigned difference = word.size() == token.size() ? 0U : 1U;
  for (std::size_t k = 0; k < token.size(); ++k) {
    const char other = k < word.size() ? word[k] : '\0';
    difference |= static_cast<unsigned char>(other) ^ static_cast<unsigned char>(token[k]);
  }
  return difference == 0;
}

bool is_own_host(std::string_view host) {
  for (const std::string_view name : {"127.0.0.1", "localhost", "[::1]"}) {
    if (!host.starts_with(name)) continue;
    const std::string_view rest = host.substr(name.size());
    if (rest.empty() || (rest.front() == ':' && is_number(rest.substr(1)))) return true;
  }
  return false;
}

bool is_own_origin(std::string_view origin, std::string_view host) {
  return origin.empty() || origin == fmt::format("http://{}", host);
}

RangeAnswer range_of(std::string_view header, long long size, ByteRange& range) {
  constexpr std::string_view unit = "bytes=";
  const std::size_t dash = header.find('-');
  if (!header.starts_with(unit) || dash == header.npos) return RangeAnswer::whole;
  const std::string_view first = header.substr(unit.size(), dash - unit.size());
  const std::string_view last = header.substr(dash + 1);
  const std::optional<long long> from = number_in(first);
  const std::optional<long long> to = number_in(last);
  if (first.empty() && to) {  // a number of bytes at the end
    if (*to == 0 || size == 0) return RangeAnswer::impossible;
    range = {std::max(0LL, size - *to), size - 1};
    return RangeAnswer::part;
  }
  if (!from || (!to && !last.empty()) || (to && *to < *from)) return RangeAnswer::whole;
  if (*from >= size) return RangeAnswer::impossible;
  range = {*from, to ? std::min(*to, size - 1) : size - 1};
  return RangeAnswer::part;
}

}  // namespace tailwater
