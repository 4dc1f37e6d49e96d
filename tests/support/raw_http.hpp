// A TCP client that sends what it is told, byte for byte: for requests that no HTTP library would make.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace roadfix::testing {

class RawConnection {
 public:
  /// To 127.0.0.1. Throws std::system_error.
  explicit RawConnection(int port);
  ~RawConnection();
  RawConnection(const RawConnection&) = delete;
  RawConnection& operator=(const RawConnection&) = delete;

  void send(std::string_view bytes);
  /// No more will be sent; answers can still be read.
  void finish();
  /// All that comes until the peer closes or the time is over.
  std::string read_all(std::chrono::milliseconds time = std::chrono::seconds(10));

 private:
  int socket_;
};

}  // namespace roadfix::testing
