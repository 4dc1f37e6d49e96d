// A map file behind the port that localization reads through: what the service and the command line compose.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/locate/map_view.hpp"
#include "tiles/store/map_reader.hpp"

namespace roadfix {

/// `name` is what the map is called in answers. The view keeps the reader alive. Its registration error is the largest
/// of the sources in force within 500 m of the place. It keeps up to `search_cache_bytes` of what searches build.
MapView view_of(std::shared_ptr<const MapReader> reader, std::string name, std::size_t search_cache_bytes = 0);

/// Of the map in a file, which gives it its name. Throws as MapReader.
MapView view_of_file(const std::filesystem::path& file, std::size_t search_cache_bytes = 0);

}  // namespace roadfix
