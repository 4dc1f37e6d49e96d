// What `roadfix ingest` is asked for, and what follows from it for a source and a map.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/detector_options.hpp"
#include "cli/ingest/road_options.hpp"
#include "core/units/provenance.hpp"
#include "tiles/pipeline/describe_source.hpp"
#include "tiles/pipeline/ingest.hpp"
#include "tiles/pipeline/open_source.hpp"
#include "tiles/sources/source_files.hpp"

namespace roadfix::cli {

struct IngestArguments {
  std::vector<std::string> sources;
  std::string map;
  std::string name;
  std::optional<SourceContent> content;  ///< nullopt = as find_source() finds out
  std::optional<double> cell_m;
  std::string zone;
  std::string crs;
  std::string collar;
  RoadArguments roads;
  DetectorChoice detector;
  UserProvenance told;
  IngestOptions options;
  bool dry_run = false;
  bool json = false;
};

/// `arguments` must live as long as the command.
void add_ingest_options(CLI::App& command, IngestArguments& arguments);

/// The source named `source` on the command line. Throws NotFound and InvalidInput about files and options.
SourceRequest request_of(const IngestArguments& arguments, const std::string& source);

/// Throws InvalidInput "option-without-effect" for what is said of lines where all sources are pixels, and the other
/// way round: who gives --extent for imagery would get all of it. So for what is said of a detector where none is
/// imagery.
void refuse_without_effect(const IngestArguments& arguments, std::span<const SourceRequest> requests);

}  // namespace roadfix::cli
