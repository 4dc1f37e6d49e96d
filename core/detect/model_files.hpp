// Where the network's weights lie when nobody names a file.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace roadfix {

/// The first that exists of: environment ROADFIX_MODEL; ../share/roadfix/models/roadnet.onnx beside the running
/// program's folder; the installation's share folder; models/roadnet.onnx of the source tree this was built from.
/// InvalidInput "model-missing" when ROADFIX_MODEL names no file, or when the folders of the program or of the
/// installation cannot be looked into.
std::optional<std::filesystem::path> default_model();

/// The first of `places` that is a file. InvalidInput "model-missing" at one that cannot be looked at: whoever
/// installed a network is not to get the answers of the tree instead.
std::optional<std::filesystem::path> first_model(const std::vector<std::filesystem::path>& places);

}  // namespace roadfix
