#include "server/http/client.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include "core/units/error.hpp"
#include "core/units/text.hpp"

namespace roadfix::http {
namespace {

struct ServerAddress {
  std::string host;
  int port = 80;
};

std::optional<ServerAddress> parsed_base(std::string_view base) {
  constexpr std::string_view kScheme = "http://";
  if (!base.starts_with(kScheme)) return std::nullopt;
  base.remove_prefix(kScheme.size());
  if (base.ends_with('/')) base.remove_suffix(1);
  ServerAddress address;
  if (const std::size_t colon = base.rfind(':'); colon != std::string_view::npos && !base.ends_with(']')) {
    const auto port = as_number<int>(base.substr(colon + 1));
    if (!port || *port < 1 || *port > 65535) return std::nullopt;
    address.port = *port;
    base = base.substr(0, colon);
  }
  if (base.starts_with('[') && base.ends_with(']')) base = base.substr(1, base.size() - 2);  // IPv6
  if (base.empty() || base.find_first_of("/?#@ ") != std::string_view::npos) return std::nullopt;
  address.host = base;
  return address;
}

ServerAddress address_of(const std::string& base) {
  const auto address = parsed_base(base);
  if (address) return *address;
  throw InvalidInput("bad-url", fmt::format("'{}' is not the address of a service: give http://HOST:PORT", base));
}

std::optional<Answer> answer_of(const httplib::Result& result) {
  if (!result) return std::nullopt;
  Answer answer{result->status, result->body, std::nullopt};
  if (const auto seconds = as_number<int>(result->get_header_value("Retry-After"))) {
    answer.retry_after = std::chrono::seconds(*seconds);
  }
  return answer;
}

}  // namespace

class Client::Impl {
 public:
  Impl(const ServerAddress& address, std::chrono::seconds patience) : client(address.host, address.port) {
    client.set_keep_alive(true);
    client.set_tcp_nodelay(true);
    client.set_connection_timeout(patience);
    client.set_read_timeout(patience);
    client.set_write_timeout(patience);
  }

  httplib::Client client;
};

Client::Client(const std::string& base, std::chrono::seconds patience)
    : impl_(std::make_unique<Impl>(address_of(base), patience)) {}

Client::~Client() = default;

std::optional<Answer> Client::get(const std::string& target) { return answer_of(impl_->client.Get(target.c_str())); }

std::optional<Answer> Client::post(const std::string& target, const std::string& body,
                                   const std::string& content_type) {
  return answer_of(impl_->client.Post(target.c_str(), body, content_type.c_str()));
}

std::optional<Answer> Client::remove(const std::string& target) {
  return answer_of(impl_->client.Delete(target.c_str()));
}

}  // namespace roadfix::http
