// --bbox: a region by its bounds.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "core/geodesy/geo_box.hpp"

namespace roadfix::cli {

/// `what` is the region to the command, for the help. Empty boxes are wrong usage; where west lies more than half a
/// turn above east, the box crosses the antimeridian, as that of `ingest --extent`.
void add_bbox_option(CLI::App& command, const std::string& what, std::optional<GeoBox>& box);

}  // namespace roadfix::cli
