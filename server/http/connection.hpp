// One socket as a stream with limits: how long a head and a body may take, how large a head may be.
#pragma once

#include <httplib.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "server/http/chunk_check.hpp"
#include "server/http/connection_limits.hpp"

namespace roadfix::http {

class Connection : public httplib::Stream {
 public:
  /// kLetGo: slow while others waited.
  enum class Failure { kNone, kTimeout, kLetGo, kHeadTooLarge, kCutOff, kBadChunks };

  /// `others_wait`: for a thread.
  Connection(int socket, const ConnectionLimits& limits, std::function<bool()> others_wait);
  ~Connection() override;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Waits at most `time` for the first byte of a request.
  bool wait(std::chrono::milliseconds time);
  bool at_end() const { return at_end_; }
  /// Whether the peer has closed its side or the connection broke. Half closed looks no different from here.
  bool peer_has_left() const;

  void begin_head();
  void begin_body(bool chunked);
  Failure failure() const { return failure_; }
  /// Since begin_head().
  bool has_written() const { return has_written_; }

  /// Lets the peer read what was written although bytes of it were not read: were it closed at once, those that it
  /// still sends would break the connection first. Listens as long as a body may take, but not to silence, and only
  /// shortly while it is `in_a_hurry`.
  void linger(const std::function<bool()>& in_a_hurry);

  bool is_readable() const override;
  bool is_writable() const override;
  ssize_t read(char* data, std::size_t size) override;
  ssize_t write(const char* data, std::size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;
  /// Since when a peer is watched, and how many bytes had passed by then.
  struct Pace {
    Clock::time_point since = Clock::now();
    std::size_t bytes = 0;
  };

  /// From now on the peer has that long, and its pace is counted.
  void begin(std::chrono::milliseconds time);
  bool fill();
  /// Whether the peer was slow for longer than the grace; `bytes` have passed in all. Once it was fast enough it is
  /// watched anew, so that what went quickly makes up for no standstill later.
  bool is_slow(Pace& pace, std::size_t bytes) const;
  /// Waits at most `time`, or until the peer holds up others; `bytes` tells how many have passed.
  bool wait_for(short events, std::chrono::milliseconds time, Pace& pace,
                const std::function<std::size_t()>& bytes) const;
  /// Waits until more can be written. `to_peer` bytes were on their way to it since `pace` began.
  bool wait_to_write(Pace& pace, std::size_t to_peer) const;
  /// Bytes written of which the peer has not said that they came.
  std::size_t on_their_way() const;
  /// cpp-httplib refuses the trailers of a chunked body (RFC 9112 7.1.2), and nobody here asks for them.
  bool skip_trailers();

  const int socket_;
  const ConnectionLimits limits_;
  const std::function<bool()> others_wait_;
  std::array<char, 16384> buffer_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  bool at_end_ = false;
  bool in_head_ = true;
  std::size_t head_bytes_ = 0;        ///< with the trailers
  std::optional<ChunkCheck> chunks_;  ///< of a chunked body
  Pace pace_;                         ///< of the head or body that is being read
  std::size_t received_ = 0;          ///< of it
  Clock::time_point deadline_ = Clock::time_point::max();
  Failure failure_ = Failure::kNone;
  bool has_written_ = false;
};

}  // namespace roadfix::http
