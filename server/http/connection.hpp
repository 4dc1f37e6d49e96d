// One socket as a stream with limits: how long a head and a body may take, how large a head may be.
#pragma once

#include <httplib.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <string>

namespace roadfix::http {

struct ConnectionLimits {
  std::chrono::milliseconds idle{15'000};  ///< between two requests
  std::chrono::milliseconds head{10'000};  ///< from the first byte of a request to the end of its headers
  std::chrono::milliseconds body{60'000};  ///< for the whole body
  std::chrono::milliseconds write{30'000};
  std::size_t head_bytes = 64 << 10;
};

class Connection : public httplib::Stream {
 public:
  enum class Failure { kNone, kTimeout, kHeadTooLarge, kCutOff };

  Connection(int socket, const ConnectionLimits& limits);
  ~Connection() override;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Waits at most `time` for the first byte of a request.
  bool wait(std::chrono::milliseconds time);
  bool at_end() const { return at_end_; }

  void begin_head();
  void begin_body();
  Failure failure() const { return failure_; }

  /// Lets the peer read what was written although bytes of it were not read.
  void linger();

  bool is_readable() const override;
  bool is_writable() const override;
  ssize_t read(char* data, std::size_t size) override;
  ssize_t write(const char* data, std::size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;
  bool fill();

  const int socket_;
  const ConnectionLimits limits_;
  std::array<char, 16384> buffer_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  bool at_end_ = false;
  bool in_head_ = true;
  std::size_t head_bytes_ = 0;
  Clock::time_point deadline_ = Clock::time_point::max();
  Failure failure_ = Failure::kNone;
};

}  // namespace roadfix::http
