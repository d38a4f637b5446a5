// Access control: a request needs the token, and must come from the page of this server, by an address of this machine.
#pragma once

#include <string>
#include <string_view>

namespace tailwater {

/// 128 random bits of the system as 32 letters and digits. Throws std::system_error.
std::string random_token();

/// Whether a word is the token; takes equally long for any word.
bool is_token(std::string_view word, std::string_view token);

/// Whether the Host header names this machine: 127.0.0.1, localhost or [::1], with any port, since `ssh -L` has its
/// own. A foreign name that resolves to this machine (DNS rebinding) does not.
bool is_own_host(std::string_view host);

/// Whether the Origin header, if there is one, is that of the page at this Host.
bool is_own_origin(std::string_view origin, std::string_view host);

/// A part of a file: bytes `first` to `last`, both included.
struct ByteRange {
  long long first = 0;
  long long last = -1;
};
enum class RangeAnswer { whole, part, impossible };
/// The range that a Range header requests of a file of `size` bytes. Only one range is served; any other header is
/// ignored.
RangeAnswer range_of(std::string_view header, long long size, ByteRange& range);

}  // namespace tailwater
