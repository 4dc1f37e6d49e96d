#include "cli/map_notes.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>

#include "core/detect/detectors.hpp"
#include "tiles/store/map_reader.hpp"
#include "tiles/view/map_file_view.hpp"

namespace roadfix::cli {

void note_unfinished(const std::filesystem::path& file, const MapInfo& info) {
  const std::string missing = missing_of(info);
  if (!missing.empty()) {
    fmt::print(stderr, "note: {}: an ingest is running or was interrupted ({}). Repeat it if it does not run\n",
               file.string(), missing);
  }
  if (info.pending == 0) return;
  fmt::print(stderr,
             "note: {}: {} of its tiles still show what the map held before the last ingest or remove, which is "
             "running or was interrupted. Repeat it if it does not run\n",
             file.string(), info.pending);
}

MapView view_with_notes(const std::filesystem::path& file, std::size_t search_cache_bytes) {
  const auto reader = std::make_shared<const MapReader>(file);
  note_unfinished(file, reader->info());
  return view_of(reader, file.stem().string(), search_cache_bytes);
}

void note_missing_network(const DetectorChoice& choice) {
  if (const auto note = note_on_missing_network(choice)) fmt::print(stderr, "note: {}\n", *note);
}

void note_other_reader(const std::string& feature_map, const std::string& reader, const MapView& map,
                       const DetectorChoice& choice) {
  const bool of_roads = !map.imagery_reader;
  const std::string best = of_roads ? make_detector(choice, SourceContent::kRoads)->describe() : *map.imagery_reader;
  if (is_same_reader(reader, best)) return;
  fmt::print(stderr,
             "note: the roads of {} were found by {}, and {} suits {} best: fixes are fewer. Detect them again with "
             "{}\n",
             feature_map, reader, best, map.id.name,
             of_roads ? "--compare-with roads" : "--compare-with imagery, or with that network by --model");
}

std::shared_ptr<const RoadDetector> detector_for(const MapView& map, const DetectorChoice& choice) {
  note_missing_network(choice);
  auto detector = detector_for_map(choice, map.imagery_reader);
  if (map.imagery_and_roads && !is_one_for_both(choice)) {
    fmt::print(
        stderr,
        "note: {} holds imagery and road data, and frames are read by {}, which suits what has more tiles: fixes "
        "are fewer where only the other was ingested\n",
        map.id.name, detector->describe());
  }
  if (!is_reader_of(*detector, map.imagery_reader)) {
    fmt::print(stderr,
               "note: {} was read by {}, and frames are by {}: they find other roads, and fixes are fewer. Name the "
               "map's network with --model, or ingest its imagery anew\n",
               map.id.name, *map.imagery_reader, detector->describe());
  }
  return detector;
}

}  // namespace roadfix::cli
