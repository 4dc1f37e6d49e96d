#include "tiles/view/map_file_view.hpp"

#include <algorithm>
#include <utility>

namespace roadfix {

MapView view_of(std::shared_ptr<const MapReader> reader, std::string name, std::size_t search_cache_bytes) {
  const MapInfo& info = reader->info();
  double registration_sigma_m = 0.0;
  for (const SourceStatus& source : info.sources) {
    if (source.complete) registration_sigma_m = std::max(registration_sigma_m, source.record.registration_sigma_m);
  }
  return {std::move(name),
          info.version,
          info.settings.zone,
          info.settings.cell_m,
          info.extent,
          registration_sigma_m,
          [reader = std::move(reader)](const GridGeometry& geometry) { return reader->read(geometry); },
          search_cache_bytes > 0 ? std::make_shared<SearchCache>(search_cache_bytes) : nullptr};
}

MapView view_of_file(const std::filesystem::path& file, std::size_t search_cache_bytes) {
  return view_of(std::make_shared<const MapReader>(file), file.stem().string(), search_cache_bytes);
}

}  // namespace roadfix
