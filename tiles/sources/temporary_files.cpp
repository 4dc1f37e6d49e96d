#include "tiles/sources/temporary_files.hpp"

#include <cpl_conv.h>

#include <algorithm>
#include <array>

namespace roadfix {

void keep_temporary_files_beside(const std::filesystem::path& map) {
  constexpr std::array kAsked{"CPL_TMPDIR", "TMPDIR", "TEMP"};  // in GDAL's order
  if (std::ranges::any_of(kAsked, [](const char* name) { return CPLGetConfigOption(name, nullptr) != nullptr; }))
    return;
  CPLSetConfigOption(kAsked.front(), map.has_parent_path() ? map.parent_path().c_str() : ".");
}

bool is_about_temporary_files(std::string_view reason) {
  return reason.find("osm_tmp") != std::string_view::npos ||
         reason.find("Cannot copy /vsimem") != std::string_view::npos;
}

}  // namespace roadfix
