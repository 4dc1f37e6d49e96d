// Several frames or feature maps of one flight in a request: the picture, and "also" others with where they were taken.
#pragma once

#include "server/api/feature_request.hpp"

namespace roadfix::api {

/// picture_members() and "also".
const std::vector<std::string>& flight_members();

/// As features_of, laid together with each of "also" (JSON objects with image in base64, forward_m, right_m and
/// turn_deg, seen from the UAV at the request's picture; all else is as for that picture). Throws InvalidField with the
/// place ("also[2].turn_deg") and LimitExceeded ("too-many-frames", "frames-too-far-apart").
Features flight_features_of(const Content& content, const Detection& detection, const Limits& limits);

}  // namespace roadfix::api
