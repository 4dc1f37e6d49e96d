// What a person who asks a map should know of it beside the answer.
#pragma once

#include <cstddef>
#include <filesystem>

#include "core/locate/map_view.hpp"
#include "tiles/store/map_records.hpp"

namespace roadfix::cli {

/// On standard error, where the map lacks blocks of a source, or tiles of it do not yet follow from its sources.
void note_unfinished(const std::filesystem::path& file, const MapInfo& info);

/// view_of_file(), with that note.
MapView view_with_notes(const std::filesystem::path& file, std::size_t search_cache_bytes = 0);

}  // namespace roadfix::cli
