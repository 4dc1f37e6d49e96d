// Where the network's weights lie when nobody names a file.
#pragma once

#include <filesystem>
#include <optional>

namespace roadfix {

/// The first that exists of: environment ROADFIX_MODEL; ../share/roadfix/models/roadnet.onnx beside the running
/// program's folder; the installation's share folder; models/roadnet.onnx of the source tree this was built from.
/// InvalidInput "model-missing" when ROADFIX_MODEL names no file.
std::optional<std::filesystem::path> default_model();

}  // namespace roadfix
