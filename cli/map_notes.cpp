#include "cli/map_notes.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>

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

}  // namespace roadfix::cli
