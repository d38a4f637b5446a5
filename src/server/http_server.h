// The server of the library, with connections of our own.
#pragma once

#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include "server/client_stream.h"

namespace tailwater {

class HttpServer : public httplib::Server {
 public:
  /// The library lets five connections wait.
  void let_many_wait() const { ::listen(svr_sock_, backlog); }

 private:
  static constexpr int backlog = 1024;  // connections

  /// One request for each connection, with streams of our own, whose clients have little time.
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
