#include "server/api/flight_request.hpp"

#include <fmt/format.h>

#include <utility>

#include "core/units/error.hpp"
#include "server/api/base64.hpp"
#include "server/http/errors.hpp"

namespace roadfix::api {
namespace {

using http::InvalidField;
using nlohmann::json;

std::vector<std::uint8_t> picture_of(const json& frame, const std::string& place) {
  const std::string field = place + ".image";
  const auto found = frame.find("image");
  if (found == frame.end() || !found->is_string() || found->get_ref<const std::string&>().empty()) {
    throw InvalidField("missing-parameter", field, fmt::format("'{}' must be a picture in base64", field));
  }
  return bytes_of_base64(field, found->get_ref<const std::string&>());
}

BodyOffset offset_of(const json& frame, const std::string& place) {
  return {number_within(frame, "forward_m", place, kMovement), number_within(frame, "right_m", place, kMovement),
          Angle::degrees(number_within(frame, "turn_deg", place, kDegrees))};
}

/// Complaints that the picture of an earlier frame causes say which one it is.
template <typename Read>
Features named(const std::string& place, Read read) {
  try {
    return read();
  } catch (const InvalidField&) {
    throw;  // of a field that all frames share
  } catch (const Error&) {
    return said_of(place + ".image", []() -> Features { throw; });
  }
}

const json& others_of(const Content& content, const Limits& limits) {
  const json* others = content.fields.member("also");
  if (others == nullptr || !others->is_array()) {
    throw InvalidField("bad-parameter", "also", "'also' must be a list of frames in a JSON body or the part 'request'");
  }
  if (others->size() >= static_cast<std::size_t>(limits.frames)) {
    throw LimitExceeded("too-many-frames", fmt::format("{} frames in one request; at most {} are allowed",
                                                       others->size() + 1, limits.frames));
  }
  return *others;
}

}  // namespace

const std::vector<std::string>& flight_members() {
  static const std::vector<std::string> kMembers = joined({{"also"}, picture_members()});
  return kMembers;
}

Features flight_features_of(const Content& content, const Detection& detection, const Limits& limits) {
  if (content.fields.has("also") && content.fields.has("cells")) {
    throw InvalidField("bad-parameter", "cells", "beside 'also' the first frame is a picture too: send it as 'image'");
  }
  Features first = features_of(content, detection, limits);
  if (!content.fields.has("also")) return first;
  static const std::vector<std::string> kPictures{"image", "also"};  // megabytes
  Content other{content.fields.without(kPictures), {}, true};
  std::vector<OtherFeatures> others;
  for (const json& frame : others_of(content, limits)) {
    const std::string place = fmt::format("also[{}]", others.size());
    if (!frame.is_object() || frame.size() != 4) {
      throw InvalidField("bad-parameter", place, "a frame is an object with image, forward_m, right_m and turn_deg");
    }
    const BodyOffset offset = offset_of(frame, place);
    const std::vector<std::uint8_t> picture = picture_of(frame, place);
    other.image = picture;
    others.push_back({named(place, [&] { return features_of(other, detection, limits); }), offset});
  }
  return together(std::move(first), std::move(others), static_cast<double>(limits.cells));
}

}  // namespace roadfix::api
