#include "server/http/exchange.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <ctime>
#include <optional>
#include <string_view>

#include "core/units/error.hpp"
#include "core/units/text.hpp"
#include "server/http/errors.hpp"
#include "server/http/gunzip.hpp"

namespace roadfix::http {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kMaxIdLength = 128;

bool is_usable_id(const std::string& id) {
  return !id.empty() && id.size() <= kMaxIdLength && std::ranges::all_of(id, [](char c) { return c > ' ' && c < 127; });
}

/// In small letters.
std::string without_blanks(const std::string& header) {
  std::string text = lower_case(header);
  std::erase_if(text, [](char c) { return c == ' ' || c == '\t'; });
  return text;
}

/// RFC 9110 8.4.1: in any case, and under its old name.
bool is_gzip(std::string_view coding) {
  const std::string name = lower_case(coding);
  return name == "gzip" || name == "x-gzip";
}

/// RFC 9110 12.5.3: named, or covered by "*", and not with a weight of 0.
bool accepts_gzip(const std::string& accept_encoding) {
  std::optional<bool> named;
  bool any = false;
  const std::string codings = without_blanks(accept_encoding);
  for (const std::string_view coding : split(codings, ',')) {
    const std::size_t weight = coding.find(";q=");
    const bool wanted =
        weight == std::string_view::npos || coding.find_first_of("123456789", weight) != std::string_view::npos;
    const std::string_view name = coding.substr(0, coding.find(';'));
    if (is_gzip(name)) named = wanted;
    if (name == "*") any = wanted;
  }
  return named.value_or(any);
}

/// RFC 9112 9.6: one of a list, in any case.
bool asks_to_close(const httplib::Request& head) {
  const auto [first, last] = head.headers.equal_range("Connection");
  return std::any_of(first, last, [](const auto& header) {
    return std::ranges::count(split(without_blanks(header.second), ','), "close") > 0;
  });
}

bool is_token(const std::string& name) {
  constexpr std::string_view kMarks = "!#$%&'*+-.^_`|~";
  return !name.empty() && std::ranges::all_of(name, [&](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           kMarks.find(c) != std::string_view::npos;
  });
}

LimitExceeded body_too_large(std::size_t max_bytes) {
  return {"body-too-large", fmt::format("the body is larger than the limit of {} bytes", max_bytes)};
}

std::string new_id() {
  static const auto kStart = static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
  static std::atomic<std::uint64_t> next{0};
  return fmt::format("{:x}-{:x}", kStart, next++);
}

}  // namespace

void take_over(httplib::Request& head, Exchange& exchange) {
  exchange.connection->begin_body(lower_case(head.get_header_value("Transfer-Encoding")) == "chunked");
  head.ranges.clear();
  exchange.content_type = head.get_header_value("Content-Type");
  head.headers.erase("Content-Type");
  const bool gzip = accepts_gzip(head.get_header_value("Accept-Encoding"));
  head.headers.erase("Accept-Encoding");
  if (gzip) head.headers.emplace("Accept-Encoding", "gzip");
  exchange.packed =
      is_gzip(head.get_header_value("Content-Encoding")) && head.get_header_value_count("Content-Encoding") == 1;
  if (exchange.packed) head.headers.erase("Content-Encoding");
  exchange.asked_to_close = asks_to_close(head);
  // The library does not notice all that ask for it, and says that it keeps some that it closes.
  if (exchange.asked_to_close || (head.version == "HTTP/1.0" && head.get_header_value("Connection") != "Keep-Alive")) {
    head.headers.erase("Connection");
    head.headers.emplace("Connection", "close");
  }
}

Request translated(const httplib::Request& head, const Exchange& exchange, const Proxies& proxies) {
  Request request;
  request.method = head.method;
  for (const auto& [name, value] : head.headers) {
    const auto [place, is_new] = request.headers.emplace(lower_case(name), value);
    if (!is_new) place->second += ", " + value;
  }
  if (!exchange.content_type.empty()) request.headers["content-type"] = exchange.content_type;
  request.client = proxies.client(head.remote_addr, request.header("x-forwarded-for"));
  const std::string& id = request.header("x-request-id");
  request.id = is_usable_id(id) ? id : new_id();
  return request;
}

void check_headers(const httplib::Request& head) {
  for (const auto& [name, value] : head.headers) {
    if (is_token(name)) continue;
    throw InvalidInput(
        "bad-header",
        fmt::format("'{}' is not a header name: use letters, digits and hyphens, directly followed by the colon",
                    name.substr(0, 40)));
  }
  const std::size_t hosts = head.get_header_value_count("Host");
  if (hosts > 1 || (hosts == 0 && head.version == "HTTP/1.1")) {
    throw InvalidInput("bad-header",
                       fmt::format("an HTTP/1.1 request must have one Host header; this one has {}", hosts));
  }
}

bool announces_body(const Request& request) {
  const auto length = request.headers.find("content-length");
  const bool told = length != request.headers.end();
  return !request.header("transfer-encoding").empty() || (told ? length->second != "0" : request.method == "POST");
}

void check_body_headers(const Request& request, std::size_t max_bytes) {
  const std::string encoding = lower_case(request.header("content-encoding"));  // not gzip: see take_over()
  if (!encoding.empty() && encoding != "identity") {
    throw InvalidField(
        "unsupported-content-encoding", "Content-Encoding",
        fmt::format("Content-Encoding '{}' is not supported; send the body with gzip or unencoded", encoding));
  }
  const std::string transfer = lower_case(request.header("transfer-encoding"));
  const std::string& length = request.header("content-length");
  if (!transfer.empty() && (transfer != "chunked" || !length.empty())) {
    throw InvalidInput("bad-content-length",
                       "send the body with either Content-Length or Transfer-Encoding: chunked, not both");
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
  if (bytes > max_bytes) throw body_too_large(max_bytes);
}

void read_body(Exchange& exchange, const httplib::ContentReader& reader, const BodyLimits& limits) {
  std::string& body = exchange.request.body;
  bool too_large = false;
  bool no_room = false;
  const auto take = [&](const char* data, std::size_t size) {
    too_large = body.size() + size > limits.bytes;
    no_room = !too_large && !exchange.body_memory.take(*limits.memory, size);
    if (too_large || no_room) return false;
    body.append(data, size);
    return true;
  };
  std::optional<Gunzip> gunzip;
  if (exchange.packed) gunzip.emplace();
  const bool whole = reader([&](const char* data, std::size_t size) {
    return gunzip ? gunzip->unpack({data, size}, take) : take(data, size);
  });
  if (whole && (!gunzip || gunzip->is_whole())) return;
  if (too_large) throw body_too_large(limits.bytes);
  if (no_room) throw Busy("the bodies of other requests take all memory that is for them; try again", 1s);
  switch (exchange.connection->failure()) {
    case Connection::Failure::kTimeout:
      throw Interrupted("request-timeout",
                        fmt::format("{} bytes of the body came within {} s, and then it was not whole: send less, or "
                                    "raise serve --body-time",
                                    body.size(), std::chrono::duration<double>(limits.time).count()));
    case Connection::Failure::kLetGo:
      throw Interrupted("request-timeout",
                        fmt::format("the body came slower than {} KiB/s while other clients waited: send it again, or "
                                    "send less",
                                    kLeastBytesPerS >> 10));
    case Connection::Failure::kCutOff:
      throw InvalidInput("body-cut-off",
                         fmt::format("the body ended after {} bytes, before its announced end", body.size()));
    default:
      throw InvalidInput("bad-body-encoding", "the body's chunks or its gzip stream are damaged or cut off");
  }
}

std::exception_ptr failure_of_head(const Exchange& exchange, std::size_t max_bytes) {
  switch (exchange.connection->failure()) {
    case Connection::Failure::kHeadTooLarge:
      return std::make_exception_ptr(
          LimitExceeded("head-too-large", fmt::format("request line and headers exceed {} bytes", max_bytes)));
    case Connection::Failure::kTimeout:
    case Connection::Failure::kLetGo:
      return std::make_exception_ptr(Interrupted("request-timeout", "the head of the request did not come in time"));
    default:
      return std::make_exception_ptr(InvalidInput(
          "bad-request",
          fmt::format("this is not an HTTP/1.1 request with a known method and headers of at most {} bytes each: does "
                      "the client use TLS or HTTP/2 on this port? The service speaks plain HTTP; for anything else put "
                      "a proxy in front",
                      CPPHTTPLIB_HEADER_MAX_LENGTH)));
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

void correct_head(httplib::Response& out) {
  if (out.status == 204) out.headers.erase("Content-Length");  // of a 304 it stays: clients of cpp-httplib wait for it
  out.headers.erase("Accept-Ranges");
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  out.set_header("Date", fmt::format("{:%a, %d %b %Y %H:%M:%S} GMT", fmt::gmtime(now)));  // RFC 9110 6.6.1
  if (out.get_header_value("Connection") == "close") out.headers.erase("Keep-Alive");
}

}  // namespace roadfix::http
