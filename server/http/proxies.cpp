#include "server/http/proxies.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/units/error.hpp"
#include "core/units/text.hpp"
#include "server/http/url.hpp"

namespace roadfix::http {
namespace {

using AddressBytes = std::array<std::uint8_t, 16>;
constexpr int kV4Bits = 32;
constexpr int kV6Bits = 128;

struct ParsedAddress {
  AddressBytes address{};
  int bits = kV6Bits;  ///< of an address of its kind: 32 or 128
};

std::optional<ParsedAddress> parsed_address(std::string_view text) {
  const std::string terminated(text);
  ParsedAddress result;
  if (inet_pton(AF_INET6, terminated.c_str(), result.address.data()) == 1) return result;
  result.address[10] = result.address[11] = 0xff;
  result.bits = kV4Bits;
  if (inet_pton(AF_INET, terminated.c_str(), result.address.data() + 12) == 1) return result;
  return std::nullopt;
}

bool same_bits(const AddressBytes& a, const AddressBytes& b, int bits) {
  const auto whole = static_cast<std::size_t>(bits / 8);
  if (!std::equal(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(whole), b.begin())) return false;
  const int rest = bits % 8;
  return rest == 0 || (a[whole] ^ b[whole]) >> (8 - rest) == 0;
}

}  // namespace

Proxies::Proxies(const std::vector<std::string>& networks) {
  for (const std::string& text : networks) {
    const std::size_t slash = std::min(text.find('/'), text.size());
    const auto address = parsed_address(std::string_view(text).substr(0, slash));
    const int all_bits = address ? address->bits : 0;
    const int bits =
        slash < text.size() ? as_number<int>(std::string_view(text).substr(slash + 1)).value_or(-1) : all_bits;
    if (!address || bits < 0 || bits > all_bits) {
      throw InvalidInput(
          "bad-proxy",
          fmt::format("'{}' is not an address or network: give the proxy's, like 127.0.0.1 or 10.0.0.0/8", text));
    }
    networks_.push_back({address->address, bits + kV6Bits - all_bits});
  }
}

bool Proxies::contains(std::string_view address) const {
  const auto parts = parsed_address(address);
  return parts && std::ranges::any_of(networks_, [&](const Network& network) {
           return same_bits(parts->address, network.address, network.bits);
         });
}

std::string Proxies::client(const std::string& peer, std::string_view forwarded_for) const {
  std::string client = peer;
  while (contains(client) && !forwarded_for.empty()) {
    const std::size_t comma = forwarded_for.rfind(',');
    const std::string_view last = comma == std::string_view::npos ? forwarded_for : forwarded_for.substr(comma + 1);
    forwarded_for = comma == std::string_view::npos ? std::string_view() : forwarded_for.substr(0, comma);
    const std::string_view address = without_port(trimmed(last));
    if (!parsed_address(address)) break;
    client = address;
  }
  return client;
}

}  // namespace roadfix::http
