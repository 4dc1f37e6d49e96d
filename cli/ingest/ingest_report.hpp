// What `roadfix ingest` prints of a source: notes, the plan of a dry run, the report.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tiles/pipeline/ingest.hpp"
#include "tiles/sources/cell_source.hpp"
#include "tiles/sources/source_files.hpp"
#include "tiles/store/map_records.hpp"

namespace roadfix::cli {

nlohmann::json summary_json(const SourceRecord& record, const SourceSummary& summary, std::int64_t blocks,
                            const MapSettings& settings);

/// What a dry run prints, with the room that so many new blocks will take and the disk has; nothing is read but headers
/// (all features, of vectors), nothing is written.
void print_plan(nlohmann::json json, std::int64_t new_blocks, const std::filesystem::path& map, bool as_json);

/// Of a cell, in megapixels of the source, which is none of lines.
double cell_mp(const SourceSummary& summary, const MapSettings& settings);

/// Rates count lines, or the source's own pixels, of its observed ground.
void print_report(nlohmann::json json, const SourceSummary& summary, const MapSettings& settings,
                  const IngestReport& report, bool as_json);

/// What is noted of a source, and which files beside it are left out; on stderr, so that --json stays clean.
void print_notes(const SourceFiles& files, const std::vector<std::string>& notes);

}  // namespace roadfix::cli
