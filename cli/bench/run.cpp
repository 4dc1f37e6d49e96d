#include "cli/bench/run.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <span>

#include "cli/bench/feature_method.hpp"
#include "cli/bench/queries.hpp"
#include "cli/evaluation/write_picture.hpp"
#include "core/units/error.hpp"

namespace roadfix::bench {
namespace {

void stop_if_asked(const BenchOptions& options) {
  if (options.maps.stop.stop_requested()) throw Interrupted("work-stopped", "the bench was stopped; its maps are kept");
}

/// What keypoints are matched with, and what pictures show.
std::vector<Orthoimage> imagery_for(const Manifest& manifest, const ManifestMap& map, const UtmZone& zone,
                                    const BenchOptions& options) {
  const bool keypoints =
      std::ranges::any_of(manifest.methods, [](MethodName name) { return name != MethodName::kRoads; });
  if (!keypoints && options.pictures.empty()) return {};
  return read_imagery(map, zone);
}

std::unique_ptr<Method> make_method(MethodName name, const std::vector<Orthoimage>& imagery, const MapView& map,
                                    const BenchOptions& options) {
  if (name == MethodName::kRoads)
    return make_roads_method(map, options.detectors->for_map(map.imagery_reader),
                             {options.maps.cell_m, options.seed, options.fix});
  if (imagery.empty()) return nullptr;  // a map from vectors has no keypoints to compare with
  return make_feature_method(name == MethodName::kSift ? FeatureKind::kSift : FeatureKind::kOrb, imagery, map.zone);
}

/// Where pictures are drawn to, and what of the map they show.
struct Drawing {
  std::filesystem::path folder;  ///< empty = no pictures
  std::span<const Orthoimage> imagery;
};

/// Below the folder, also of frames that lie elsewhere than below their table.
std::filesystem::path picture_of(const std::string& query, const std::filesystem::path& folder) {
  std::filesystem::path file = folder;
  for (const auto& part : std::filesystem::path(query + ".jpg").relative_path().lexically_normal()) {
    file /= part == ".." ? "_" : part;
  }
  return file;
}

void draw_picture(const Method& method, const Query& query, const Answer& answer, const Drawing& drawing) {
  if (drawing.folder.empty()) return;
  const std::filesystem::path file = picture_of(query.id, drawing.folder);
  const cv::Mat picture = method.drawn(query, answer, drawing.imagery);
  if (picture.empty()) return;  // nothing to see, say of keypoints in a feature map
  std::error_code failed;       // which writing says
  std::filesystem::create_directories(file.parent_path(), failed);
  evaluation::write_picture(file, picture);
}

Answer answer_of(const Method& method, const Query& query) {
  if (query.unasked.empty()) return method.answer(query);
  Answer none;
  none.reason = query.unasked;
  return none;
}

std::vector<Outcome> ask(const Method& method, const std::vector<Query>& queries, const UtmZone& zone,
                         const std::string& task, const Drawing& drawing, const BenchOptions& options) {
  std::vector<Outcome> outcomes(queries.size());
  std::atomic<std::int64_t> done = 0;
  tbb::task_arena arena(options.jobs);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, queries.size(), [&](std::size_t i) {
      stop_if_asked(options);
      const Answer answer = answer_of(method, queries[i]);
      draw_picture(method, queries[i], answer, drawing);
      outcomes[i] = judged(queries[i].id, queries[i].truth, answer, zone);
      options.progress(task, ++done, static_cast<std::int64_t>(queries.size()));
    });
  });
  return outcomes;
}

/// None of a set that cannot be used: the others are worth asking all the same.
DrawnQueries queries_of(const QuerySet& set, const MapView& map, const MapView& from, const RoadDetector& detector,
                        const QueryDrawing& drawing) {
  try {
    return make_queries(set, map, from, detector, drawing);
  } catch (const Error& error) {
    if (!is_about_input(error)) throw;
    return {{}, {fmt::format("{}: {} [{}]", describe(set), error.what(), error.code())}};
  }
}

}  // namespace

std::vector<SetResult> run(const Manifest& manifest, const BenchOptions& options) {
  std::vector<SetResult> results;
  std::map<std::string, MapView> maps;
  for (const ManifestMap& manifest_map : manifest.maps) {
    maps.emplace(manifest_map.name, build_map(manifest_map, options.maps));
  }
  for (const ManifestMap& manifest_map : manifest.maps) {
    const MapView& map = maps.at(manifest_map.name);
    std::map<MethodName, std::unique_ptr<Method>> methods;
    const auto imagery = imagery_for(manifest, manifest_map, map.zone, options);
    for (const MethodName name : manifest.methods) methods[name] = make_method(name, imagery, map, options);
    for (std::size_t i = 0; i < manifest.queries.size(); ++i) {
      const QuerySet& set = manifest.queries[i];
      if (set.map != manifest_map.name) continue;
      if (std::ranges::all_of(methods, [](const auto& method) { return method.second == nullptr; })) {
        options.left_out(fmt::format("{}: keypoints are compared with the imagery of a map, and '{}' has none",
                                     describe(set), set.map));
        continue;
      }
      const auto detector = options.detectors->for_map(map.imagery_reader);
      const auto [queries, left_out] =
          queries_of(set, map, maps.at(set.from), *detector, {options.seed, i, options.limit});
      for (const std::string& why : left_out) options.left_out(why);
      if (queries.empty()) continue;
      for (const MethodName name : manifest.methods) {
        if (!methods[name]) continue;
        const std::string task = fmt::format("{} {}", to_string(name), describe(set));
        Drawing drawing{{}, imagery};
        if (!options.pictures.empty()) drawing.folder = options.pictures / fmt::format("{}-{}", i + 1, to_string(name));
        results.push_back({name, set.map, describe(set), ask(*methods[name], queries, map.zone, task, drawing, options),
                           std::min(set.footprint.width_m, set.footprint.height_m), set.elsewhere, common_quality(set),
                           i + 1});
      }
    }
  }
  return results;
}

}  // namespace roadfix::bench
