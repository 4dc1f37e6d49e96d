// What a SOURCE argument of the command line means: which files, and of what kind.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/units/provenance.hpp"
#include "tiles/sources/cell_source.hpp"

namespace roadfix {

struct SourceFiles {
  std::string name;  ///< stem of the file or archive, or name of the folder
  std::string location;
  SourceKind kind = SourceKind::kImagery;
  bool is_map = false;             ///< a single map of roadfix
  std::vector<std::string> paths;  ///< of a folder or ZIP archive all images or vector files in it and below, sorted
  /// Of a folder or archive: vector files beside images, and files of formats that are not looked for, sorted. Of a
  /// file that holds pixels: its layers of vectors.
  std::vector<std::string> left_out = {};
};

/// `content` is what the user says it is. nullopt: vectors, maps, rasters of roads that roadfix wrote and copies of
/// either are roads, other rasters imagery.
/// Where a `layer` is named, a file that holds both pixels and vectors stands for its vectors.
/// Throws NotFound "file-not-found", InvalidInput ("source-unreadable", "source-empty", "source-not-imagery").
SourceFiles find_source(const std::string& argument, std::optional<SourceContent> content = {},
                        const std::string& layer = {});

}  // namespace roadfix
