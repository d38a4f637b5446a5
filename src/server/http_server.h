// The library's server, with our own connections.
#pragma once

#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include "server/client_stream.h"

namespace tailwater {

class HttpServer : public httplib::Server {
 public:
  /// Raises the number of waiting connections, which is five in the library.
  void let_many_wait() const { ::listen(svr_sock_, backlog); }

 private:
  static constexpr int backlog = 1024;  // connections

  /// One request per connection, with our own streams, whose clients have a short time limit.
  bool process_and_close_socket(socket_t socket) override {
    ClientStream stream(socket);
    bool is_closed = false;
    const bool is_answered = process_request(stream, true, is_closed, nullptr);
    ::shutdown(socket, SHUT_RDWR);
    ::close(socket);
    return is_answered;
  }
};

}  // namespace tailwater
