#include "server/http/connection.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace roadfix::http {
namespace {

using namespace std::chrono_literals;
using std::chrono::milliseconds;

constexpr milliseconds kLinger = 500ms;  // however others wait
constexpr milliseconds kLingerSilence = 5s;
constexpr milliseconds kSlice = 100ms;

bool poll_for(int socket, short events, milliseconds time) {
  pollfd entry{socket, events, 0};
  const auto timeout = static_cast<int>(std::clamp<milliseconds>(time, 0ms, 1h).count());
  int ready = 0;
  do {
    ready = ::poll(&entry, 1, timeout);
  } while (ready < 0 && errno == EINTR);
  return ready > 0;
}

/// IPv4 peers of a socket for both kinds have addresses within IPv6 (::ffff:a.b.c.d): to everyone else they are IPv4.
void unmap(sockaddr_storage& address, socklen_t& size) {
  if (address.ss_family != AF_INET6) return;
  sockaddr_in6 mapped{};
  std::memcpy(&mapped, &address, sizeof mapped);
  if (!IN6_IS_ADDR_V4MAPPED(&mapped.sin6_addr)) return;
  sockaddr_in plain{};
  plain.sin_family = AF_INET;
  plain.sin_port = mapped.sin6_port;
  std::memcpy(&plain.sin_addr, mapped.sin6_addr.s6_addr + 12, sizeof plain.sin_addr);
  std::memcpy(&address, &plain, sizeof plain);
  size = sizeof plain;
}

void numeric_address(sockaddr_storage address, socklen_t size, std::string& ip, int& port) {
  unmap(address, size);
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> service{};
  if (getnameinfo(reinterpret_cast<const sockaddr*>(&address), size, host.data(), host.size(), service.data(),
                  service.size(), NI_NUMERICHOST | NI_NUMERICSERV) != 0) {
    return;
  }
  ip = host.data();
  port = std::atoi(service.data());
}

}  // namespace

Connection::Connection(int socket, const ConnectionLimits& limits, std::function<bool()> others_wait)
    : socket_(socket), limits_(limits), others_wait_(std::move(others_wait)) {}

Connection::~Connection() {
  ::shutdown(socket_, SHUT_RDWR);
  ::close(socket_);
}

bool Connection::wait(milliseconds time) {
  if (begin_ < end_) return true;
  if (!poll_for(socket_, POLLIN, time)) return false;
  begin(limits_.head);
  return fill();
}

void Connection::begin(milliseconds time) {
  pace_ = {};
  received_ = 0;
  deadline_ = pace_.since + time;
}

bool Connection::peer_has_left() const {
  char next = 0;
  const ssize_t n = ::recv(socket_, &next, 1, MSG_PEEK | MSG_DONTWAIT);
  return n == 0 || (n < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
}

void Connection::begin_head() {
  in_head_ = true;
  head_bytes_ = 0;
  failure_ = Failure::kNone;
  chunks_.reset();
  has_written_ = false;
  begin(limits_.head);
}

void Connection::begin_body(bool chunked) {
  in_head_ = false;
  if (chunked) chunks_.emplace();
  begin(limits_.body);
}

void Connection::linger(const std::function<bool()>& in_a_hurry) {
  ::shutdown(socket_, SHUT_WR);
  const auto begun = Clock::now();
  auto heard = begun;
  for (auto now = begun; now - heard < kLingerSilence; now = Clock::now()) {
    if (now - begun > (in_a_hurry() ? kLinger : limits_.body)) return;
    if (!poll_for(socket_, POLLIN, kSlice)) continue;
    if (::recv(socket_, buffer_.data(), buffer_.size(), 0) <= 0) return;
    heard = Clock::now();
  }
}

bool Connection::is_readable() const { return begin_ < end_ || poll_for(socket_, POLLIN, 0ms); }

bool Connection::is_writable() const {
  Pace pace;
  return wait_to_write(pace, on_their_way());
}

bool Connection::is_slow(Pace& pace, std::size_t bytes) const {
  const auto now = Clock::now();
  const std::chrono::duration<double> time = now - pace.since;
  if (time <= limits_.grace) return false;
  if (static_cast<double>(bytes - pace.bytes) < time.count() * static_cast<double>(kLeastBytesPerS)) return true;
  pace = {now, bytes};
  return false;
}

bool Connection::wait_for(short events, milliseconds time, Pace& pace,
                          const std::function<std::size_t()>& bytes) const {
  const auto until = Clock::now() + time;
  for (;;) {
    const bool slow = is_slow(pace, bytes());
    const auto now = Clock::now();
    if (now >= until || (slow && others_wait_())) return false;
    if (poll_for(socket_, events, std::min(kSlice, std::chrono::ceil<milliseconds>(until - now)))) return true;
  }
}

/// The system takes megabytes for a peer that reads none: only what has left it counts.
bool Connection::wait_to_write(Pace& pace, std::size_t to_peer) const {
  return wait_for(POLLOUT, limits_.write, pace, [&] { return to_peer - on_their_way(); });
}

std::size_t Connection::on_their_way() const {
  int bytes = 0;
  return ::ioctl(socket_, TIOCOUTQ, &bytes) == 0 ? static_cast<std::size_t>(bytes) : 0;
}

bool Connection::fill() {
  const auto left = std::chrono::ceil<milliseconds>(deadline_ - Clock::now());
  if (left <= 0ms || !wait_for(POLLIN, left, pace_, [this] { return received_; })) {
    failure_ = Clock::now() < deadline_ ? Failure::kLetGo : Failure::kTimeout;
    return false;
  }
  const ssize_t n = ::recv(socket_, buffer_.data(), buffer_.size(), 0);
  if (n <= 0) {
    at_end_ = true;
    failure_ = Failure::kCutOff;
    return false;
  }
  begin_ = 0;
  end_ = static_cast<std::size_t>(n);
  received_ += end_;
  return true;
}

bool Connection::skip_trailers() {
  while (chunks_ && chunks_->is_trailer(buffer_[begin_])) {
    if (!chunks_->follow({buffer_.data() + begin_, 1}) || ++head_bytes_ > limits_.head_bytes) {
      failure_ = Failure::kBadChunks;
      return false;
    }
    if (++begin_ == end_ && !fill()) return false;
  }
  return true;
}

ssize_t Connection::read(char* data, std::size_t size) {
  if ((begin_ == end_ && !fill()) || !skip_trailers()) return at_end_ ? 0 : -1;
  const std::size_t n = std::min(size, end_ - begin_);
  if (in_head_ && (head_bytes_ += n) > limits_.head_bytes) {
    failure_ = Failure::kHeadTooLarge;
    return -1;
  }
  if (chunks_ && !chunks_->follow({buffer_.data() + begin_, n})) {
    failure_ = Failure::kBadChunks;
    return -1;
  }
  std::memcpy(data, buffer_.data() + begin_, n);
  begin_ += n;
  return static_cast<ssize_t>(n);
}

ssize_t Connection::write(const char* data, std::size_t size) {
  Pace pace;
  const std::size_t before = on_their_way();
  std::size_t sent = 0;
  while (sent < size) {
    const ssize_t n = ::send(socket_, data + sent, size - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n > 0) {
      sent += static_cast<std::size_t>(n);
      has_written_ = true;
    } else if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
      if (!wait_to_write(pace, before + sent)) return -1;
    } else if (errno != EINTR) {
      return -1;
    }
  }
  return static_cast<ssize_t>(size);
}

void Connection::get_remote_ip_and_port(std::string& ip, int& port) const {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (::getpeername(socket_, reinterpret_cast<sockaddr*>(&address), &size) == 0)
    numeric_address(address, size, ip, port);
}

void Connection::get_local_ip_and_port(std::string& ip, int& port) const {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) == 0)
    numeric_address(address, size, ip, port);
}

}  // namespace roadfix::http
