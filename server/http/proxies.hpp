// The programs in front of the service whose word is taken on who asks.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace roadfix::http {

class Proxies {
 public:
  Proxies() = default;
  /// Addresses and networks: "127.0.0.1", "10.0.0.0/8", "fd00::/8". Throws InvalidInput ("bad-proxy").
  explicit Proxies(const std::vector<std::string>& networks);

  bool contains(std::string_view address) const;

  /// Who asks: the peer, or where that is one of the proxies the last address of X-Forwarded-For that is none. Whatever
  /// stands before that address, the client may have written itself.
  std::string client(const std::string& peer, std::string_view forwarded_for) const;

 private:
  /// IPv4 as ::ffff:a.b.c.d, as a socket for both kinds shows it.
  using Address = std::array<std::uint8_t, 16>;
  struct Network {
    Address address;
    int bits;
  };
  std::vector<Network> networks_;
};

}  // namespace roadfix::http
