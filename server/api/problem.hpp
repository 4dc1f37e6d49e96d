// The one place where an error becomes an HTTP status, and its body (problem details, RFC 9457).
#pragma once

#include <exception>
#include <string_view>

#include "core/units/error.hpp"
#include "server/http/message.hpp"

namespace roadfix::api {

/// By its code where the table names it, else by its class.
int status_of(const Error& error);

/// application/problem+json with status, title, code, detail, and field and byte where they are known. What is not an
/// Error is answered 500 without its text, which is for the log only.
http::Response problem(std::exception_ptr thrown);

}  // namespace roadfix::api
