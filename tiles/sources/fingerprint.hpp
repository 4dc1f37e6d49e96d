// A short text that changes when a source's files or settings do; it tells a resumed ingest from another one.
#pragma once

#include <string>
#include <vector>

namespace roadfix {

/// Size and content of every file up to 8 MiB, of a larger one also the time of change and only the first and last MiB;
/// side files included where they lie beside it under the same stem; and the settings. Of an .aux.xml only what it
/// tells of the image, since QGIS writes statistics there. Throws IoFailure for an unreadable file.
std::string fingerprint(const std::vector<std::string>& paths, const std::string& settings);

}  // namespace roadfix
