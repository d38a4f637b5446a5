#include "server/client_stream.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <string_view>

namespace tailwater {
namespace {

using std::chrono::milliseconds;

/// A browser sends the head at once, and a tunnel delays it only a little.
constexpr milliseconds time_for_head{2000};
constexpr milliseconds time_for_next_bytes{5000};

constexpr std::string_view end_of_head = "\r\n\r\n";

/// Whether the socket is ready within this time.
bool is_ready(int socket, short events, milliseconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (true) {
    const auto left = std::chrono::duration_cast<milliseconds>(end - std::chrono::steady_clock::now());
    pollfd ready{.fd = socket, .events = events, .revents = 0};
    const int count = poll(&ready, 1, static_cast<int>(std::max<milliseconds::rep>(0, left.count())));
    if (count < 0 && errno == EINTR) continue;
    return count > 0 && (ready.revents & events) != 0;
  }
}

bool is_alive(int socket) {
  if (!is_ready(socket, POLLIN, milliseconds(0))) return true;
  char byte = 0;
  return recv(socket, &byte, 1, MSG_PEEK) > 0;
}

}  // namespace

milliseconds ClientStream::patience() const {
  if (has_head_) return time_for_next_bytes;
  return std::max(milliseconds(0), time_for_head - std::chrono::duration_cast<milliseconds>(Clock::now() - start_));
}

bool ClientStream::is_readable() const { return begin_ < end_ || is_ready(socket_, POLLIN, patience()); }

bool ClientStream::is_writable() const { return is_ready(socket_, POLLOUT, time_for_next_bytes) && is_alive(socket_); }

ssize_t ClientStream::receive() {
  if (!is_ready(socket_, POLLIN, patience())) return -1;
  ssize_t count = -1;
  do {
    count = recv(socket_, buffer_.data(), buffer_.size(), 0);
  } while (count < 0 && errno == EINTR);
  begin_ = 0;
  end_ = count > 0 ? static_cast<std::size_t>(count) : 0;
  if (!has_head_) {
    last_.append(buffer_.data(), end_);
    has_head_ = last_.find(end_of_head) != std::string::npos;
    if (last_.size() > end_of_head.size()) last_.erase(0, last_.size() - end_of_head.size());
  }
  return count;
}

ssize_t ClientStream::read(char* place, std::size_t size) {
  if (begin_ == end_) {
    if (const ssize_t count = receive(); count <= 0) return count;
  }
  const std::size_t taken = std::min(size, end_ - begin_);
  std::copy_n(buffer_.data() + begin_, taken, place);
  begin_ += taken;
  return static_cast<ssize_t>(taken);
}

ssize_t ClientStream::write(const char* bytes, std::size_t size) {
  if (!is_writable()) return -1;
  ssize_t count = -1;
  do {
    count = send(socket_, bytes, size, MSG_NOSIGNAL);
  } while (count < 0 && errno == EINTR);
  return count;
}

// The server listens to its own machine only.
void ClientStream::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip = "127.0.0.1";
  port = 0;
}
void ClientStream::get_local_ip_and_port(std::string& ip, int& port) const { get_remote_ip_and_port(ip, port); }

}  // namespace tailwater
