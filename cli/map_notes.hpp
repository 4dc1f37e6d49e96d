// What a person who asks a map should know of it beside the answer.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "core/detect/make_detector.hpp"
#include "core/locate/map_view.hpp"
#include "tiles/store/map_records.hpp"

namespace roadfix::cli {

/// On standard error, where the map lacks blocks of a source, or tiles of it do not yet follow from its sources.
void note_unfinished(const std::filesystem::path& file, const MapInfo& info);

/// view_of_file(), with that note.
MapView view_with_notes(const std::filesystem::path& file, std::size_t search_cache_bytes = 0);

/// On standard error, where a network is missing that the choice would take.
void note_missing_network(const DetectorChoice& choice);

/// On standard error, where the roads of a feature map (FeatureMapScale::reader) were found by another detector than
/// reads frames over the map.
void note_other_reader(const std::string& feature_map, const std::string& reader, const MapView& map,
                       const DetectorChoice& choice);

/// For frames over the map; with that note, and another where another detector read the map.
std::shared_ptr<const RoadDetector> detector_for(const MapView& map, const DetectorChoice& choice);

}  // namespace roadfix::cli
