// Where the network's weights lie when nobody names a file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/units/provenance.hpp"

namespace roadfix {

// The roads of a picture are compared with those found in another picture, or with drawn ones. One network is trained
// for agreement and finds in two pictures of one ground what is in both, whatever it is; another to find what is drawn.

/// The environment's ROADFIX_MODEL, for both. Else the first that exists of: ../share/roadfix/models beside the running
/// program's folder; the installation's share folder; models of the source tree this was built from. In each of them
/// the network for what is compared comes before the other one.
/// InvalidInput "model-missing" when ROADFIX_MODEL names no file, or when the folders of the program or of the
/// installation cannot be looked into.
std::optional<std::filesystem::path> default_model(SourceContent compared);

/// The file name of the network for what is compared, where `model` is the other one of the two that are shipped.
std::optional<std::string> stood_in_for(const std::filesystem::path& model, SourceContent compared);

/// What to tell where default_model() finds one of the two shipped networks only, which is for both then.
std::optional<std::string> note_on_missing_network();

/// The first of `places` that is a file. InvalidInput "model-missing" at one that cannot be looked at: whoever
/// installed a network is not to get the answers of the tree instead.
std::optional<std::filesystem::path> first_model(const std::vector<std::filesystem::path>& places);

}  // namespace roadfix
