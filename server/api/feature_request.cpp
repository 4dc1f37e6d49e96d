#include "server/api/feature_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/detect/feature_map_codec.hpp"
#include "core/detect/image_codec.hpp"
#include "core/units/error.hpp"
#include "core/units/words.hpp"
#include "server/api/altitude_request.hpp"
#include "server/api/base64.hpp"
#include "server/api/frame_scale.hpp"
#include "server/http/errors.hpp"

namespace roadfix::api {
namespace {

using http::InvalidField;

constexpr Range kFeatureCell{0.0, 1000.0, true};

constexpr std::array<Word<bool>, 2> kIsFrame{{{"feature_map", false}, {"frame", true}}};
constexpr std::array<Word<Border>, 2> kBorders{{{"seen", Border::kSeen}, {"black", Border::kBlackUnseen}}};

void require_picture(const Content& content) {
  if (content.image.empty()) {
    throw InvalidField("missing-parameter", "image",
                       "there is no picture: send it as the body, as the form's part 'image', or as base64 in 'image'");
  }
}

void require_no(const Fields& fields, std::initializer_list<const char*> names, std::string_view why) {
  for (const char* name : names) {
    if (fields.has(name)) throw InvalidField("bad-parameter", name, fmt::format("'{}' {}: leave it out", name, why));
  }
}

/// Cells as GET .../window gives them: base64, row by row, 0..254 and 255 = unobserved.
CellArray cells_of_json(const Fields& fields, const Limits& limits) {
  constexpr int kMaxSide = 1 << 24;
  const int cols = fields.integer("cols", 1, kMaxSide);
  const int rows = fields.integer("rows", 1, kMaxSide);
  if (std::int64_t{cols} * rows > limits.cells) {
    throw LimitExceeded(
        "too-many-cells",
        fmt::format("{} x {} cells; at most {} are allowed: send a smaller feature map", cols, rows, limits.cells));
  }
  const std::vector<std::uint8_t> bytes = bytes_of_base64("cells", fields.text("cells"));
  CellArray cells(cols, rows);
  if (bytes.size() != cells.cells().size()) {
    throw InvalidField(
        "bad-parameter", "cells",
        fmt::format("'cells' holds {} bytes, {} x {} cells need {}: check cols and rows; a cell is one byte",
                    bytes.size(), cols, rows, cells.cells().size()));
  }
  std::ranges::copy(bytes, cells.cells().begin());
  return cells;
}

FeatureMapPicture given_picture(const Content& content, const Limits& limits) {
  const Fields& fields = content.fields;
  if (fields.has("cells")) {
    if (content.image.empty()) return {cells_of_json(fields, limits), {}};
    throw InvalidField("duplicate-parameter", "cells", "give either a picture or 'cells', not both");
  }
  require_picture(content);
  require_no(fields, {"cols", "rows"}, "goes with 'cells'; a picture has a size of its own");
  return decode_feature_map(content.image, limits.cells);
}

FeatureMap given_map(const Content& content, const Limits& limits) {
  const Fields& fields = content.fields;
  constexpr Range kPosition{-1e6, 1e6};
  ToldScale told;
  const bool tells_itself = is_feature_map(content.image);
  if (!fields.has("cell_m") && !content.image.empty() && !tells_itself) {
    throw InvalidField("missing-parameter", "cell_m",
                       "'cell_m' is missing, the size of a feature map's cells. If this is a camera's picture, add "
                       "kind=frame, and gsd_m, or agl_m with one of fov_deg and focal_px, or exif=true");
  }
  if (fields.has("cell_m") || !tells_itself) told.cell_m = fields.number("cell_m", kFeatureCell);
  told.nadir_col = fields.optional_number("nadir_col", kPosition);
  told.nadir_row = fields.optional_number("nadir_row", kPosition);
  return feature_map_of(given_picture(content, limits), told);
}

Frame given_frame(const Content& content, const Limits& limits, const std::stop_token& stop) {
  require_picture(content);
  const Fields& fields = content.fields;
  const Border border = fields.choice("unobserved", kBorders);
  const cv::Mat pixels = decode_frame(content.image, limits.pixels, stop);
  return {pixels, parse_frame_scale(fields, content.image), border};
}

/// Detectors draw a coarse frame in finer pixels of their own before they look at it.
void require_few_pixels(const GroundImage& image, const RoadDetector& detector, const Limits& limits) {
  const double finer = std::max(1.0, image.gsd_m / detector.preferred_gsd_m());
  const double pixels = static_cast<double>(image.pixels.total()) * finer * finer;
  if (pixels <= static_cast<double>(limits.pixels)) return;
  throw LimitExceeded(
      "ground-too-large",
      fmt::format("the frame shows {:.1f} x {:.1f} km, {:.0f} pixels of the {:g} m that roads are looked for in; at "
                  "most {} are allowed: send a part of it",
                  image.pixels.cols * image.gsd_m / 1e3, image.pixels.rows * image.gsd_m / 1e3, pixels,
                  detector.preferred_gsd_m(), limits.pixels));
}

void require_frame(const Fields& fields) {
  require_no(fields, {"cells", "cols", "rows"}, "describes a feature map, and kind=frame says that this is a picture");
  require_no(fields, {"nadir_col", "nadir_row"},
             "describes a feature map; of a frame the point below the UAV follows from roll_deg and pitch_deg");
}

void require_feature_map(const Fields& fields) {
  for (const std::string& name : frame_fields()) {
    if (name == "cell_m" || !fields.has(name)) continue;
    throw InvalidField("bad-parameter", name,
                       fmt::format("'{}' describes a frame; add kind=frame, or leave it out for a feature map", name));
  }
}

}  // namespace

const std::vector<std::string>& frame_fields() {
  static const std::vector<std::string> kFields = joined({{"unobserved", "cell_m"}, frame_scale_fields()});
  return kFields;
}

const std::vector<std::string>& feature_fields() {
  static const std::vector<std::string> kFields =
      joined({{"kind", "nadir_col", "nadir_row", "nadir_sigma_m", "nadir_heading_sigma_deg"}, frame_fields()});
  return kFields;
}

const std::vector<std::string>& picture_members() {
  static const std::vector<std::string> kMembers{"image",        "cells",   "cols",    "rows",
                                                 "pose",         "map",     "epsg",    "footprint",
                                                 "geotransform", "made_by", "time_ms", "attribution"};
  return kMembers;
}

bool shows_ground(const Content& content) {
  const Fields& fields = content.fields;
  return content.has_picture || fields.has("cells") || fields.has("cols") || fields.has("rows");
}

bool is_frame(const Fields& fields) { return fields.choice("kind", kIsFrame); }

void require_nothing_seen(const Fields& fields) {
  for (const std::string& name : joined({feature_fields(), altitude_fields()})) {
    if (!fields.has(name)) continue;
    throw InvalidField("missing-parameter", "image",
                       fmt::format("'{}' describes a picture or a feature map, and there is none: send it, or leave "
                                   "'{}' out of a step that sees nothing",
                                   name, name));
  }
}

std::optional<double> told_nadir_sigma_m(const Fields& fields) {
  return fields.optional_number("nadir_sigma_m", {0.0, 1000.0});
}

std::optional<Angle> told_nadir_heading_sigma(const Fields& fields) {
  return fields.optional_angle("nadir_heading_sigma_deg", {0.0, 180.0});
}

Features features_of(const Content& content, const Detection& detection, const Limits& limits) {
  Features features;
  if (is_frame(content.fields)) {
    require_frame(content.fields);
    features = detected(content, detection, limits);
  } else {
    require_feature_map(content.fields);
    features.map = given_map(content, limits);
  }
  if (const auto told = told_nadir_sigma_m(content.fields)) features.map.nadir_sigma_m = *told;
  if (const auto told = told_nadir_heading_sigma(content.fields)) features.map.nadir_heading_sigma = *told;
  return features;
}

Features detected(const Content& content, const Detection& detection, const Limits& limits) {
  const Fields& fields = content.fields;
  Detection asked = detection;
  asked.cell_m = fields.optional_number("cell_m", {0.1, 100.0}).value_or(detection.cell_m);
  const SeenFrame frame =
      seen_frame(given_frame(content, limits, detection.stop), detection.detector, limits.pixels, detection.sketched);
  const GroundImage& ground = frame.view.image;
  require_few_pixels(ground, detection.detector, limits);
  const double cells = static_cast<double>(ground.pixels.total()) * std::pow(ground.gsd_m / asked.cell_m, 2.0);
  if (cells > static_cast<double>(limits.cells)) {
    throw LimitExceeded("too-many-cells", fmt::format("the frame would have {:.0f} cells of {} m; at most {} are "
                                                      "allowed: send a part of it, or ask for larger cells with cell_m",
                                                      cells, asked.cell_m, limits.cells));
  }
  return detected(frame, asked);
}

}  // namespace roadfix::api
