// The connection to one client. A client has little time for the head of its request, however it divides it: one that
// drips bytes would otherwise keep a thread for as long as it likes, without ever showing the token.
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
  /// How long the next bytes may take: the rest of the head's time, or for the body a time of their own.
  std::chrono::milliseconds patience() const;
  /// Fills the empty buffer. Returns what recv returns, or -1 when the time is over.
  ssize_t receive();

  socket_t socket_;
  Clock::time_point start_ = Clock::now();
  bool has_head_ = false;
  std::string last_;  ///< up to four bytes, of which the end of the head is made
  std::array<char, 4096> buffer_{};
  std::size_t begin_ = 0, end_ = 0;  ///< of the bytes that the buffer still holds
};

}  // namespace tailwater
