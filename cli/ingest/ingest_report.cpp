#include "cli/ingest/ingest_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>

#include "core/units/file.hpp"
#include "core/units/json_text.hpp"
#include "server/api/source_json.hpp"

namespace roadfix::cli {
namespace {

/// More that the file of the map will take, as measured on maps of towns.
std::int64_t expected_bytes(std::int64_t blocks, const std::filesystem::path& map) {
  constexpr std::int64_t kBytesPerBlock = 50'000;  // evidence and fused tile with overviews
  constexpr std::int64_t kBytesOfTables = 150'000;
  return kBytesPerBlock * blocks + (std::filesystem::exists(map) ? 0 : kBytesOfTables);
}

}  // namespace

nlohmann::json summary_json(const SourceRecord& record, const SourceSummary& summary, std::int64_t blocks,
                            const MapSettings& settings) {
  const double side_km = kTileCells * settings.cell_m / 1e3;
  nlohmann::json json{{"source", record.name},
                      {"kind", to_string(record.content)},
                      {"files_crs", summary.crs},
                      {"map_crs", fmt::format("EPSG:{}", settings.zone.epsg())},
                      {"cell_m", settings.cell_m},
                      {"blocks", blocks},
                      {"blocks_km2", static_cast<double>(blocks) * side_km * side_km},
                      {"method", record.method}};
  if (summary.is_lines()) {
    json["features"] = summary.features;
    json["left_out"] = summary.left_out;
  } else {
    json["native_gsd_m"] = summary.native_gsd_m;
    json["chosen_gsd_m"] = summary.chosen_gsd_m;
  }
  if (!summary.notes.empty()) json["notes"] = summary.notes;
  return json;
}

void print_plan(nlohmann::json json, std::int64_t new_blocks, const std::filesystem::path& map, bool as_json) {
  constexpr double kBytesPerMb = 1e6;
  const std::int64_t expected = expected_bytes(new_blocks, map);
  const std::optional<std::int64_t> room = free_bytes_beside(map);
  json["expected_bytes"] = expected;
  if (room) json["free_bytes"] = *room;
  if (room && expected > *room) {
    fmt::print(stderr, "note: the map will take some {:.1f} MB, and its disk has {:.0f} MB free\n",
               static_cast<double>(expected) / kBytesPerMb, static_cast<double>(*room) / kBytesPerMb);
  }
  if (as_json) {
    fmt::print("{}\n", json_text(json));
    return;
  }
  for (const auto& [key, value] : json.items()) {
    const std::string text = value.is_string()         ? value.get<std::string>()
                             : key.ends_with("_bytes") ? fmt::format("{:.1f} MB", value.get<double>() / kBytesPerMb)
                                                       : json_text(value);
    fmt::print("{:14} {}\n", key, text);
  }
}

double cell_mp(const SourceSummary& summary, const MapSettings& settings) {
  const double side_px = settings.cell_m / summary.native_gsd_m;
  return side_px * side_px / 1e6;
}

void print_report(nlohmann::json json, const SourceSummary& summary, const MapSettings& settings,
                  const IngestReport& report, bool as_json) {
  const double fresh = static_cast<double>(report.blocks - report.blocks_before);
  json["blocks_done_before"] = report.blocks_before;
  json["observed_cells"] = report.observed_cells;
  json["reading_s"] = report.reading_s;
  json["fusing_s"] = report.fusing_s;
  for (const auto& [name, shifted] : report.shifts.shifted) json["shifts"][name] = api::to_json(shifted.shift);
  for (const std::string& note : report.shifts.notes) json["notes"].push_back(note);
  const double share = fresh / static_cast<double>(std::max<std::int64_t>(1, report.blocks));
  const bool lines = summary.is_lines();
  const double amount = lines ? share * static_cast<double>(summary.features)
                              : static_cast<double>(report.observed_cells) * cell_mp(summary, settings);
  const double rate = report.reading_s > 0.0 ? amount / report.reading_s : 0.0;
  json[lines ? "features_per_s" : "megapixels_per_s"] = rate;
  if (as_json) {
    fmt::print("{}\n", json_text(json));
    return;
  }
  fmt::print("{}: {} blocks ({} done before), {:.1f} s reading and detecting ({:.2f} {}/s), {:.1f} s fusing\n",
             json["source"].get<std::string>(), report.blocks, report.blocks_before, report.reading_s, rate,
             lines ? "features" : "MP", report.fusing_s);
}

void print_notes(const SourceFiles& files, const std::vector<std::string>& notes) {
  for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", note);
  if (files.left_out.empty()) return;
  const bool file = files.paths.size() == 1 && files.paths.front() == files.location;
  fmt::print(stderr, "note: {}; left out {} {}: {}\n",
             file ? files.location + " is taken for its pixels"
                  : fmt::format("a folder or archive is one source, {} one of {}", files.location,
                                files.kind == SourceKind::kRoadVectors ? "vectors" : "images"),
             files.left_out.size() == 1 ? "is" : "are", fmt::join(files.left_out, ", "),
             file ? "--layer NAME takes vectors instead" : "give them by their own paths");
}

}  // namespace roadfix::cli
