// The files of the operator's console (this folder and Leaflet), embedded when the build is configured.
#pragma once

#include <span>
#include <string_view>

namespace roadfix::console {

struct File {
  std::string_view name;  ///< below /console/; index.html is served at /
  std::string_view content_type;
  std::string_view content;
};

std::span<const File> files();

}  // namespace roadfix::console
