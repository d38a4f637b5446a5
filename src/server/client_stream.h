// The connection to one client. The time for the head of a request is limited in total. Otherwise a client that sends
// byte after byte could occupy a thread for any time, without ever showing the token.
#pragma once

#include <httplib.h>

#include <array>
#include <chrono>
#include <string>

namespace tailwater {

class ClientStream final : public httplib::Stream {
 public:
  explicit ClientStream(socket_t socket) : socket_(socket) {}

  bool is_readable() const override;
  bool is_writable() const override;
  ssize_t read(char* place, std::size_t size) override;
  ssize_t write(const char* bytes, std::size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;
  /// Time limit for the next bytes: the rest of the head's time, or for the body a limit of its own.
  std::chrono::milliseconds patience() const;
  /// Fills the empty buffer. Returns the result of recv, or -1 when the time is over.
  ssize_t receive();

  socket_t socket_;
  Clock::time_point start_ = Clock::now();
  bool has_head_ = false;
  std::string last_;  ///< up to four bytes, for detecting the end of the head
  std::array<char, 4096> buffer_{};
  std::size_t begin_ = 0, end_ = 0;  ///< range of the bytes that the buffer still holds
};

}  // namespace tailwater
