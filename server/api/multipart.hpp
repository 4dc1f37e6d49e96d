// multipart/form-data (RFC 7578) of a body that was read whole.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace roadfix::api {

struct Part {
  std::string name;
  std::string_view content;  ///< inside the body
};

/// `content_type` is the header with the boundary. Throws InvalidField ("bad-multipart") with the byte, LimitExceeded
/// ("too-many-parts").
std::vector<Part> parse_multipart(std::string_view content_type, std::string_view body, std::size_t max_parts = 64);

}  // namespace roadfix::api
