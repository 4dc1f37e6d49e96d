// What a client posts to be matched or detected: a feature map or a frame, with the values that describe it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/api/content.hpp"
#include "server/api/features.hpp"
#include "server/api/limits.hpp"

namespace roadfix::api {

/// Names that may be in the query of a request with a feature map or frame.
const std::vector<std::string>& feature_fields();
/// Those of a frame alone.
const std::vector<std::string>& frame_fields();
/// Members of a JSON body beside these: the picture, or the cells of a window or detection as the service gives them.
const std::vector<std::string>& picture_members();
/// Whether the ground was seen, rather than nothing. A picture of no bytes was, and is refused when it is read.
bool shows_ground(const Content& content);

/// Whether the ground is shown by a camera's picture.
bool is_frame(const Fields& fields);

/// Throws InvalidField ("missing-parameter") for a field that describes what was seen, where nothing was sent: a
/// picture that was forgotten is not to pass for a flight without one.
void require_nothing_seen(const Fields& fields);

/// How well the nadir is known as the client says, 1 sigma per axis: it knows more than a camera's description tells.
std::optional<double> told_nadir_sigma_m(const Fields& fields);
/// Likewise how far what is seen may be turned about it.
std::optional<Angle> told_nadir_heading_sigma(const Fields& fields);

/// The feature map, detected if it is a frame. The cell size of the detection is for frames that name none.
Features features_of(const Content& content, const Detection& detection, const Limits& limits);
/// The same of what is a frame for sure, whatever the fields say of a feature map.
Features detected(const Content& content, const Detection& detection, const Limits& limits);

}  // namespace roadfix::api
