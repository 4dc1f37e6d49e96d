// Answers that several handlers give.
#pragma once

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/api/fields.hpp"
#include "server/http/message.hpp"
#include "server/http/server.hpp"

namespace roadfix::server {

http::Response json_response(const nlohmann::json& body);

/// "http://host:port" as the client wrote it, for links in answers.
std::string base_url(const http::Request& request);

/// Tells one build of a program from another by size and time of its file; empty where that cannot be read.
std::string build_of(const std::filesystem::path& program);

/// A quoted entity tag for what this build makes from a version of a map and the request's own variation.
std::string entity_tag(const std::string& version, const std::string& variation);
/// Whether If-None-Match names the tag (RFC 9110 13.1.2).
bool is_known_to_client(const http::Request& request, const std::string& tag);

/// Since the request was read.
std::chrono::microseconds time_spent(const http::Request& request);

using api::joined;

}  // namespace roadfix::server
