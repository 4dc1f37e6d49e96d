#include "server/http/exchange.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <charconv>

#include "core/units/error.hpp"

namespace roadfix::http {
namespace {

constexpr std::size_t kMaxIdLength = 128;

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return text;
}

bool is_usable_id(const std::string& id) {
  return !id.empty() && id.size() <= kMaxIdLength && std::ranges::all_of(id, [](char c) { return c > ' ' && c < 127; });
}

std::string new_id() {
  static const auto kStart = static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
  static std::atomic<std::uint64_t> next{0};
  return fmt::format("{:x}-{:x}", kStart, next++);
}

}  // namespace

void take_over(httplib::Request& head, Exchange& exchange) {
  exchange.head_read = true;
  exchange.connection->begin_body();
  head.ranges.clear();
  exchange.content_type = head.get_header_value("Content-Type");
  head.headers.erase("Content-Type");
  const bool gzip = lower(head.get_header_value("Accept-Encoding")).find("gzip") != std::string::npos;
  head.headers.erase("Accept-Encoding");
  if (gzip) head.headers.emplace("Accept-Encoding", "gzip");
}

Request translated(const httplib::Request& head, const Exchange& exchange) {
  Request request;
  request.method = head.method;
  request.client = head.remote_addr;
  for (const auto& [name, value] : head.headers) {
    const auto [place, is_new] = request.headers.emplace(lower(name), value);
    if (!is_new) place->second += ", " + value;
  }
  if (!exchange.content_type.empty()) request.headers["content-type"] = exchange.content_type;
  const std::string& id = request.header("x-request-id");
  request.id = is_usable_id(id) ? id : new_id();
  return request;
}

bool announces_body(const Request& request) {
  const std::string& length = request.header("content-length");
  return !request.header("transfer-encoding").empty() || (!length.empty() && length != "0");
}

void check_body_headers(const Request& request, std::size_t max_bytes) {
  const std::string encoding = lower(request.header("content-encoding"));
  if (!encoding.empty() && encoding != "identity" && encoding != "gzip") {
    throw InvalidInput("unsupported-content-encoding",
                       fmt::format("a body packed with '{}' cannot be read; send it with gzip or as it is", encoding));
  }
  const std::string transfer = lower(request.header("transfer-encoding"));
  const std::string& length = request.header("content-length");
  if (!transfer.empty() && (transfer != "chunked" || !length.empty())) {
    throw InvalidInput("bad-content-length",
                       "a body comes either with Content-Length or with Transfer-Encoding: chunked");
  }
  if (!transfer.empty()) return;
  if (length.empty()) throw InvalidInput("length-required", "the body needs a Content-Length or chunked encoding");
  std::size_t bytes = 0;
  const auto [end, error] = std::from_chars(length.data(), length.data() + length.size(), bytes);
  if (error == std::errc::result_out_of_range)
    bytes = max_bytes + 1;
  else if (error != std::errc{} || end != length.data() + length.size()) {
    throw InvalidInput("bad-content-length", fmt::format("Content-Length '{}' is not a number of bytes", length));
  }
  if (bytes > max_bytes) {
    throw LimitExceeded("body-too-large", fmt::format("the body is larger than the limit of {} bytes", max_bytes));
  }
}

void read_body(Exchange& exchange, const httplib::ContentReader& reader, std::size_t max_bytes) {
  std::string& body = exchange.request.body;
  bool too_large = false;
  const bool whole = reader([&](const char* data, std::size_t size) {
    too_large = body.size() + size > max_bytes;
    if (!too_large) body.append(data, size);
    return !too_large;
  });
  if (whole) return;
  if (too_large) {
    throw LimitExceeded("body-too-large", fmt::format("the body is larger than the limit of {} bytes", max_bytes));
  }
  switch (exchange.connection->failure()) {
    case Connection::Failure::kTimeout:
      throw Interrupted("request-timeout", "the rest of the body did not come in time");
    case Connection::Failure::kCutOff:
      throw InvalidInput("body-cut-off",
                         fmt::format("the body ended after {} bytes, before its announced end", body.size()));
    default:
      throw InvalidInput("bad-body-encoding", "the body's chunks or its gzip stream are damaged");
  }
}

std::exception_ptr failure_of_head(const Exchange& exchange, std::size_t max_bytes) {
  switch (exchange.connection->failure()) {
    case Connection::Failure::kHeadTooLarge:
      return std::make_exception_ptr(
          LimitExceeded("head-too-large", fmt::format("request line and headers exceed {} bytes", max_bytes)));
    case Connection::Failure::kTimeout:
      return std::make_exception_ptr(Interrupted("request-timeout", "the head of the request did not come in time"));
    default:
      return std::make_exception_ptr(InvalidInput("bad-request", "the head of the request is not HTTP/1.1"));
  }
}

void fill(httplib::Response& out, Response response) {
  out.status = response.status;
  for (auto& [name, value] : response.headers) out.set_header(name, value);
  if (response.stream) {
    out.set_chunked_content_provider(
        response.content_type, [next = std::move(response.stream)](std::size_t, httplib::DataSink& sink) {
          std::optional<std::string> piece;
          try {
            piece = next();
          } catch (const std::exception& error) {  // it would end the process: cpp-httplib lets it through
            spdlog::warn("a stream was cut off: {}", error.what());
            return false;
          }
          if (!piece) {
            sink.done();
            return true;
          }
          return sink.is_writable() && (piece->empty() || sink.write(piece->data(), piece->size()));
        });
    return;
  }
  if (!response.content_type.empty()) out.set_header("Content-Type", response.content_type);
  out.body = std::move(response.body);
}

}  // namespace roadfix::http
