// --bbox: a region by its bounds.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "core/geodesy/geo_box.hpp"

namespace roadfix::cli {

/// `what` is the region to the command, for the help. What is no told_box() is wrong usage.
void add_bbox_option(CLI::App& command, const std::string& what, std::optional<GeoBox>& box);

}  // namespace roadfix::cli
