#include "tiles/sources/prj_file.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>

#include "core/units/error.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {

std::optional<OGRSpatialReference> crs_beside(const std::string& path) {
  const GdalMessages messages;
  for (const char* extension : {"prj", "PRJ"}) {
    const std::string file = CPLResetExtension(path.c_str(), extension);
    VSIStatBufL stat;
    if (VSIStatL(file.c_str(), &stat) != 0) continue;
    CPLStringList lines(CSLLoad(file.c_str()));
    std::string text;
    for (int i = 0; i < lines.Count(); ++i) text += lines[i];
    OGRSpatialReference crs;
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (crs.importFromESRI(lines.List()) == OGRERR_NONE || crs.importFromWkt(text.c_str()) == OGRERR_NONE) return crs;
    throw InvalidInput("crs-unknown",
                       fmt::format("{}: holds no reference system in WKT ({}), as a .prj file does; name "
                                   "it with --crs of ingest, for example --crs EPSG:32637",
                                   file, messages.text()));
  }
  return std::nullopt;
}

}  // namespace roadfix
