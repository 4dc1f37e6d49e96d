#include "server/api/content.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/units/bytes.hpp"
#include "server/api/base64.hpp"
#include "server/api/json_body.hpp"
#include "server/api/multipart.hpp"
#include "server/http/errors.hpp"

namespace roadfix::api {
namespace {

using http::InvalidField;
using nlohmann::json;

/// A pose is three numbers in an object: four values, and something for the rest of the request.
std::size_t json_values(const Limits& limits) { return static_cast<std::size_t>(limits.poses) * 4 + 1000; }

void add_picture(Content& content, std::span<const std::uint8_t> bytes) {
  if (content.has_picture) throw http::given_twice("image");
  content.image = bytes;
  content.has_picture = true;
}

void add_json(Content& content, std::string_view text, const std::vector<std::string>& known, const Limits& limits) {
  content.fields.add(parse_json(text, json_values(limits)), known);
  if (!content.fields.has("image")) return;
  content.decoded =
      std::make_shared<const std::vector<std::uint8_t>>(bytes_of_base64("image", content.fields.take_text("image")));
  add_picture(content, *content.decoded);
}

void add_part(Content& content, const Part& part, const std::vector<std::string>& known, const Limits& limits) {
  if (part.name == "request") {
    add_json(content, part.content, known, limits);
  } else if (part.name == "image") {
    add_picture(content, bytes_of(part.content));
  } else if (std::ranges::find(known, part.name) != known.end()) {
    content.fields.add_text(part.name, std::string(part.content));
  } else {
    throw InvalidField("unknown-field", part.name,
                       fmt::format("the form's part '{}' is none of 'image', 'request' and the fields of this request",
                                   part.name.substr(0, 40)));
  }
}

}  // namespace

Content read_content(const http::Request& request, const std::vector<std::string>& known, const Limits& limits) {
  Content content{.fields = Fields(request.query)};
  const std::string type = request.media_type();
  if (type == "image/png" || type == "image/jpeg") {
    add_picture(content, bytes_of(request.body));
  } else if (type == "application/json") {
    add_json(content, request.body, known, limits);
  } else if (type == "multipart/form-data") {
    for (const Part& part : parse_multipart(request.header("content-type"), request.body)) {
      add_part(content, part, known, limits);
    }
  } else {
    throw InvalidField(
        "unsupported-media-type", "Content-Type",
        fmt::format("Content-Type is '{}'; send image/png, image/jpeg, application/json or multipart/form-data",
                    type.substr(0, 60)));
  }
  return content;
}

}  // namespace roadfix::api
