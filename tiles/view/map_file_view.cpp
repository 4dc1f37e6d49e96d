#include "tiles/view/map_file_view.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

namespace roadfix {
namespace {

constexpr double kAroundM = 500.0;

std::function<double(GridPoint)> registration_around(std::shared_ptr<const MapReader> reader) {
  double least_m = std::numeric_limits<double>::infinity();
  double largest_m = reader->info().error_of_removed_m;
  for (const SourceStatus& source : reader->info().sources) {
    if (!source.complete) continue;
    least_m = std::min(least_m, source.registration_sigma_m());
    largest_m = std::max(largest_m, source.registration_sigma_m());
  }
  if (least_m >= largest_m) return [largest_m](GridPoint) { return largest_m; };
  return [largest_m, reader = std::move(reader)](GridPoint place) {
    return reader->registration_sigma_m(grown({place, place}, kAroundM)).value_or(largest_m);
  };
}

}  // namespace

MapView view_of(std::shared_ptr<const MapReader> reader, std::string name, std::size_t search_cache_bytes) {
  const MapInfo& info = reader->info();
  return {{std::move(name), info.version},
          info.settings.zone,
          info.settings.cell_m,
          info.extent,
          imagery_reader_of(info),
          registration_around(reader),
          [reader = std::move(reader)](const GridGeometry& geometry) { return reader->read(geometry); },
          search_cache_bytes > 0 ? std::make_shared<SearchCache>(search_cache_bytes) : nullptr,
          shows_imagery_and_roads(info),
          info.terrain ? info.terrain->terrain : nullptr};
}

MapView view_of_file(const std::filesystem::path& file, std::size_t search_cache_bytes) {
  return view_of(std::make_shared<const MapReader>(file), file.stem().string(), search_cache_bytes);
}

}  // namespace roadfix
