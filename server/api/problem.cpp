#include "server/api/problem.hpp"

#include <fmt/format.h>

#include <chrono>
#include <map>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>

#include "core/units/json_text.hpp"
#include "server/http/errors.hpp"

namespace roadfix::api {
namespace {

using nlohmann::json;

constexpr std::chrono::seconds kRetryAfter{5};

const std::map<std::string, int, std::less<>>& statuses() {
  static const std::map<std::string, int, std::less<>> kByCode{
      {"cross-site-request", 403},
      {"method-not-allowed", 405},
      {"not-acceptable", 406},
      {"request-timeout", 408},
      {"length-required", 411},
      {"map-replaced", 409},
      {"step-late", 409},
      {"step-differs", 409},
      {"time-backwards", 409},
      {"track-ended", 410},
      {"url-too-long", 414},
      {"unsupported-media-type", 415},
      {"unsupported-content-encoding", 415},
      {"host-not-served", 421},
      {"too-many-tracks", 429},
      {"head-too-large", 431},
      {"client-gone", 499},  // nginx's number for it
      // Requests that cannot be read as HTTP, or were not sent whole.
      {"bad-request", 400},
      {"bad-header", 400},
      {"bad-url", 400},
      {"bad-content-length", 400},
      {"bad-body-encoding", 400},
      {"body-cut-off", 400},
      // The service's own set-up, not the caller's fault.
      {"model-missing", 503},
      {"map-unreadable", 503},
      {"track-store-full", 503},
      {"track-store-read-only", 503},
      {"track-store-unavailable", 503},
      {"track-store-corrupt", 503},
  };
  return kByCode;
}

const char* title_of(int status) {
  static const std::map<int, const char*> kTitles{
      {400, "Bad request"},
      {403, "Forbidden"},
      {404, "Not found"},
      {405, "Method not allowed"},
      {406, "Not acceptable"},
      {408, "Request timeout"},
      {409, "Conflict"},
      {410, "Gone"},
      {411, "Length required"},
      {413, "Content too large"},
      {414, "URI too long"},
      {415, "Unsupported media type"},
      {421, "Misdirected request"},
      {422, "Unprocessable content"},
      {429, "Too many requests"},
      {431, "Request header fields too large"},
      {499, "Client closed request"},
      {503, "Service unavailable"},
  };
  const auto title = kTitles.find(status);
  return title != kTitles.end() ? title->second : "Internal error";
}

http::Response rendered(int status, json members) {
  members["type"] = fmt::format("urn:roadfix:problem:{}", members["code"].get<std::string>());
  members["title"] = title_of(status);
  members["status"] = status;
  http::Response response{status, "application/problem+json", json_text(members)};
  response.problem = members["code"];
  return response;
}

http::Response of_error(const Error& error) {
  json members{{"code", error.code()}, {"detail", error.what()}};
  std::vector<std::pair<std::string, std::string>> headers;
  if (const auto* field = dynamic_cast<const http::InvalidField*>(&error)) {
    members["field"] = field->field();
    if (field->byte()) members["byte"] = *field->byte();
  }
  if (const auto* method = dynamic_cast<const http::MethodNotAllowed*>(&error)) {
    headers.emplace_back("Allow", method->allowed());
  }
  const int status = status_of(error);
  if (const auto* busy = dynamic_cast<const http::Busy*>(&error)) {
    headers.emplace_back("Retry-After", std::to_string(busy->retry_after().count()));
  } else if (status == 503 || status == 429) {
    headers.emplace_back("Retry-After", std::to_string(kRetryAfter.count()));
  }
  http::Response response = rendered(status, std::move(members));
  response.headers = std::move(headers);
  return response;
}

/// Written out: nlohmann's json takes memory to be destroyed, and ends the process where there is none.
http::Response out_of_memory() {
  http::Response response{
      503, "application/problem+json",
      R"({"code":"server-busy","detail":"there is not enough memory for this request now","status":503,)"
      R"("title":"Service unavailable","type":"urn:roadfix:problem:server-busy"})"};
  response.headers.emplace_back("Retry-After", std::to_string(kRetryAfter.count()));
  response.problem = "server-busy";
  return response;
}

http::Response internal_error() {
  return rendered(
      500, {{"code", "internal-error"}, {"detail", "the service failed; its log says how, under the request id"}});
}

}  // namespace

int status_of(const Error& error) {
  const auto by_code = statuses().find(error.code());
  if (by_code != statuses().end()) return by_code->second;
  if (dynamic_cast<const http::InvalidField*>(&error) != nullptr) return 400;
  if (dynamic_cast<const InvalidInput*>(&error) != nullptr) return 422;
  if (dynamic_cast<const NotFound*>(&error) != nullptr) return 404;
  if (dynamic_cast<const LimitExceeded*>(&error) != nullptr) return 413;
  if (dynamic_cast<const Interrupted*>(&error) != nullptr) return 503;
  if (dynamic_cast<const InUse*>(&error) != nullptr) return 503;
  return 500;
}

http::Response problem(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const Error& error) {
    return of_error(error);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::resource_unavailable_try_again) {
      return of_error(http::Busy("the system gives the service no more threads for this request now", kRetryAfter));
    }
    return internal_error();
  } catch (const std::exception&) {
    return internal_error();
  }
}

}  // namespace roadfix::api
