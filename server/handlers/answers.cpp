#include "server/handlers/answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <system_error>

#include "core/units/json_text.hpp"

namespace roadfix::server {

http::Response json_response(const nlohmann::json& body) { return {200, "application/json", json_text(body)}; }

std::string base_url(const http::Request& request) {
  const std::string& host = request.header("host");
  const bool is_plain = !host.empty() && std::ranges::all_of(host, [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' || c == '-' ||
           c == ':' || c == '[' || c == ']' || c == '_';
  });
  if (!is_plain) return {};
  return (request.header("x-forwarded-proto") == "https" ? "https://" : "http://") + host;
}

std::string build_of(const std::filesystem::path& program) {
  std::error_code unseen;
  const auto bytes = std::filesystem::file_size(program, unseen);
  if (unseen) return {};
  const auto written = std::filesystem::last_write_time(program, unseen);
  return fmt::format("{} {}", bytes, written.time_since_epoch().count());
}

std::string entity_tag(const std::string& version, const std::string& variation) {
  static const std::string kBuild = build_of("/proc/self/exe");
  return fmt::format("\"{:016x}\"", std::hash<std::string>{}(kBuild + '\n' + version + '\n' + variation));
}

bool is_known_to_client(const http::Request& request, const std::string& tag) {
  const std::string& known = request.header("if-none-match");
  return known == "*" || known.find(tag) != std::string::npos;
}

std::chrono::microseconds time_spent(const http::Request& request) {
  return std::chrono::duration_cast<std::chrono::microseconds>(http::Clock::now() - request.received);
}

}  // namespace roadfix::server
