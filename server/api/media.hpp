// Which of several representations a client wants (RFC 9110 12.5.1).
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "server/api/fields.hpp"
#include "server/http/message.hpp"

namespace roadfix::api {

struct Media {
  std::string_view name;  ///< in format=
  std::string_view type;  ///< "image/png"
};

/// The best match for an Accept header, the first where it is empty or all match equally.
/// Throws InvalidInput ("not-acceptable").
const Media& negotiated(std::string_view accept, std::span<const Media> offered);

/// By the field "format", else by Accept. Throws InvalidField and what negotiated() throws.
const Media& media_asked_for(const http::Request& request, const Fields& fields, std::span<const Media> offered);

}  // namespace roadfix::api
