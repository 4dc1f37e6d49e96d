// Where GDAL puts what it does not keep in memory while it reads: the nodes of a large OpenStreetMap file.
#pragma once

#include <filesystem>
#include <string_view>

namespace roadfix {

/// In the folder of the map, which has room and may be written to, rather than in the current one; unless the
/// environment says where (CPL_TMPDIR, TMPDIR or TEMP).
void keep_temporary_files_beside(const std::filesystem::path& map);

/// Whether GDAL speaks of such a file.
bool is_about_temporary_files(std::string_view reason);

}  // namespace roadfix
