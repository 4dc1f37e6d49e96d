// What a client posts: fields and a picture, in a bare image, a JSON body or a form.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "server/api/fields.hpp"
#include "server/api/limits.hpp"
#include "server/http/message.hpp"

namespace roadfix::api {

/// The request's fields and the bytes of its picture, wherever they were: in the query and a bare image body, in a JSON
/// body (the picture as base64 in "image"), or in the parts of a form ("image", and "request" for JSON).
struct Content {
  Fields fields;
  std::span<const std::uint8_t> image{};  ///< within the body of the request, or `decoded`
  bool has_picture = false;               ///< one was sent, though its bytes may have been lost on their way
  std::shared_ptr<const std::vector<std::uint8_t>> decoded{};  ///< of a picture in base64, else nullptr
};

/// The body of the request has to stay as long as the picture in it is used.
/// `known` are the members a JSON body or form may have. Throws InvalidField ("unsupported-media-type"
/// of the header Content-Type, too) or LimitExceeded.
Content read_content(const http::Request& request, const std::vector<std::string>& known, const Limits& limits);

}  // namespace roadfix::api
