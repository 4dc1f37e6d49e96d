#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>
#include <condition_variable>
#include <cstdio>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "cli/calibration_option.hpp"
#include "cli/command.hpp"
#include "cli/detector_options.hpp"
#include "cli/number_checks.hpp"
#include "cli/open_files.hpp"
#include "cli/terminal.hpp"
#include "cli/threads_option.hpp"
#include "server/application.hpp"

namespace roadfix::cli {
namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20;
constexpr double kMaxSeconds = 1e6;
constexpr double kMaxMiB = 1 << 20;  // a TiB
constexpr double kMaxThreads = 10'000;

struct ServeOptions {
  server::Configuration service;
  std::size_t body_mib = service.http.body_bytes / kMiB;
  std::size_t all_bodies_mib = service.http.all_bodies_bytes / kMiB;
  std::size_t map_cache_mib = service.map_cache_bytes / kMiB;
  std::size_t search_cache_mib = service.search_cache_bytes / kMiB;
  std::size_t picture_cache_mib = service.picture_cache_bytes / kMiB;
  double request_time_s = 30.0;
  double body_time_s = 60.0;
  std::optional<double> turn_time_s;  ///< else as long as the request time
  double idle_time_s = 15.0;
  double watch_s = 1.0;
  double track_idle_s = 3600.0;
  double step_wait_s = 0.1;
  std::size_t tracks_mib = static_cast<std::size_t>(service.track_limits.store_bytes) / kMiB;
  std::string log_level = "info";
  std::string calibration;
  std::vector<std::string> proxies;
};

server::Configuration configuration(const ServeOptions& options) {
  server::Configuration result = options.service;
  if (!options.calibration.empty()) result.calibration = read_calibration(options.calibration);
  result.http.proxies = http::Proxies(options.proxies);
  result.http.body_bytes = options.body_mib * kMiB;
  result.http.all_bodies_bytes = options.all_bodies_mib * kMiB;
  result.map_cache_bytes = options.map_cache_mib * kMiB;
  result.search_cache_bytes = options.search_cache_mib * kMiB;
  result.picture_cache_bytes = options.picture_cache_mib * kMiB;
  result.http.body_time = milliseconds(options.body_time_s);
  result.http.request_time = milliseconds(options.request_time_s);
  result.http.turn_time = options.turn_time_s ? milliseconds(*options.turn_time_s) : result.http.request_time;
  result.http.idle_time = milliseconds(options.idle_time_s);
  result.watch_interval = milliseconds(options.watch_s);
  result.track_limits.idle = milliseconds(options.track_idle_s);
  result.track_limits.order_wait = milliseconds(options.step_wait_s);
  result.track_limits.store_bytes = static_cast<std::int64_t>(options.tracks_mib * kMiB);
  // Each takes a thread for as long as it is open.
  result.track_limits.streams = std::min(options.service.track_limits.streams, options.service.http.threads / 2);
  result.track_limits.steps_waiting = std::max(1, options.service.http.threads / 4);
  return result;
}

/// "--request-time" is also ROADFIX_REQUEST_TIME.
void also_from_environment(CLI::App& command) {
  for (CLI::Option* option : command.get_options([](const CLI::Option* o) { return !o->get_lnames().empty(); })) {
    std::string name = "ROADFIX_" + option->get_lnames().front();
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return c == '-' ? '_' : static_cast<char>(std::toupper(c)); });
    if (option->get_lnames().front() != "help") option->envname(name);
  }
}

/// Options that neither the command line nor the environment gives. (CLI11 reads such files for whole programs only.)
void also_from_file(CLI::App& command, const std::string& path) {
  for (const CLI::ConfigItem& item : CLI::ConfigTOML().from_file(path)) {
    CLI::Option* option = item.parents.empty() ? command.get_option_no_throw("--" + item.name) : nullptr;
    if (option == nullptr) {
      throw CLI::ConfigError(fmt::format(
          "{}: '{}' is not an option of serve: use the names of the command line, like max-body, without a section",
          path, item.fullname()));
    }
    if (option->count() > 0) continue;
    option->add_result(item.inputs);
    option->run_callback();
  }
}

void add_limits(CLI::App& command, ServeOptions& o) {
  auto& limits = o.service.limits;
  const auto add = [&](const char* name, auto& value, const char* text, double max = kMaxNumber) {
    command.add_option(name, value, text)->capture_default_str()->check(positive(max))->group("Limits of one request");
  };
  add("--max-body", o.body_mib, "Body in MiB, after unpacking", kMaxMiB);
  add("--body-time", o.body_time_s, "Seconds that a body may take to arrive", kMaxSeconds);
  add("--max-pixels", limits.pixels, "Pixels of a picture");
  add("--max-cells", limits.cells, "Cells of a window or feature map");
  add("--max-poses", limits.poses, "Poses of a match");
  add("--max-search", limits.search_km2, "Area of a search in km2");
  add("--max-particles", limits.particles, "Particles of a track");
  add("--request-time", o.request_time_s, "Seconds that an answer may take; searches count from their turn",
      kMaxSeconds);
  command
      .add_option("--turn-time", o.turn_time_s,
                  "Seconds that a search or detection may wait for its turn; default: --request-time")
      ->check(positive(kMaxSeconds))
      ->group("Limits of one request");
}

void add_resources(CLI::App& command, ServeOptions& o) {
  auto& http = o.service.http;
  const auto add = [&](const char* name, auto& value, const char* text, double max = kMaxNumber) {
    return command.add_option(name, value, text)->capture_default_str()->check(positive(max))->group("Resources");
  };
  add("--threads", http.threads, "Connections served at the same time", kMaxThreads);
  add("--searches", http.heavy_running, "Searches and detections at the same time");
  add("--searches-waiting", http.heavy_waiting, "Searches and detections that may wait; further ones get 503");
  add("--search-threads", o.service.search_threads,
      "Threads of a search; searches that run at the same time share them", kMaxThreads);
  add("--body-memory", o.all_bodies_mib,
      "Bodies of all requests at once, MiB; further ones get 503. At least --max-body", kMaxMiB);
  add("--idle-time", o.idle_time_s, "Seconds after which an idle connection is closed", kMaxSeconds);
  add("--map-cache", o.map_cache_mib, "Decoded tiles in memory per map, MiB", kMaxMiB);
  add("--search-cache", o.search_cache_mib, "Search data kept for later searches, per map, MiB", kMaxMiB);
  add("--picture-cache", o.picture_cache_mib, "Rendered tiles in memory, MiB", kMaxMiB);
  add("--max-tracks", o.service.track_limits.tracks, "Tracks at the same time");
  add("--max-client-tracks", o.service.track_limits.tracks_per_client, "Tracks per client address");
  add("--max-streams", o.service.track_limits.streams, "Event streams at the same time, at most half of --threads");
  add("--tracks-size", o.tracks_mib, "Maximum size of the track file, MiB", kMaxMiB);
  add("--step-wait", o.step_wait_s, "Seconds that a step waits for steps it overtook", kMaxSeconds);
  add("--track-idle", o.track_idle_s, "Seconds without a step after which a track ends", kMaxSeconds);
  add("--watch", o.watch_s, "Seconds between scans of the map folder", kMaxSeconds);
}

/// Whatever they come from. Otherwise every body of the size that is allowed would be told to come again.
void require_room_for_one_body(const ServeOptions& options) {
  if (options.all_bodies_mib >= options.body_mib) return;
  throw CLI::ValidationError(
      "--body-memory", fmt::format("{} MiB hold no body of the {} MiB that --max-body allows: give {} or more, or a "
                                   "smaller --max-body",
                                   options.all_bodies_mib, options.body_mib, options.body_mib));
}

void run_serve(const ServeOptions& options) {
  const std::stop_token stop = stop_on_signals();
  allow_all_open_files();
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("roadfix", std::make_shared<spdlog::sinks::stderr_sink_mt>()));
  spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%eZ [%l] %v", spdlog::pattern_time_type::utc);  // as the access log's times
  spdlog::set_level(spdlog::level::from_str(options.log_level));
  server::Application application(configuration(options));
  const int port = application.start();
  const std::string& host = options.service.http.host;
  fmt::print("roadfix serves {} at http://{}:{}/\n", options.service.maps.string(),
             host.find(':') == std::string::npos ? host : "[" + host + "]", port);
  std::fflush(stdout);
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  stopped.wait(lock, stop, [] { return false; });
  spdlog::info("stopping: answering the requests in progress");
  application.stop();
}

}  // namespace

void add_serve_command(CLI::App& app) {
  auto* command = app.add_subcommand("serve", "Runs the HTTP service: maps, windows, tiles, matches, fixes and tracks");
  command->footer(
      "Every option can also come from the environment (--request-time: ROADFIX_REQUEST_TIME) or from the file of "
      "--config (request-time = 30).\nExample: roadfix serve --maps maps --port 8080");
  const auto options = std::make_shared<ServeOptions>();
  ServeOptions& o = *options;
  o.service.http.heavy_running = processors();
  o.service.search_threads = processors();
  command->add_option("--maps", o.service.maps,
                      "Folder of the maps (*.gpkg); added, changed and removed files are detected");
  command->add_option("--tracks", o.service.tracks,
                      "File that stores the tracks; default: tracks.sqlite in the folder of the maps");
  command->add_option("--host", o.service.http.host, "Address to listen on; 0.0.0.0 for all")->capture_default_str();
  command->add_option("--port", o.service.http.port, "Port; 0 for any free one")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535));
  command->add_option("--cors-origin", o.service.http.cors_origin,
                      "Origin whose web pages may call the API, or * for all");
  command
      ->add_option(
          "--proxy", o.proxies,
          "Address or network of a proxy (127.0.0.1, 10.0.0.0/8) whose X-Forwarded-For names the client; repeatable")
      ->delimiter(',');
  command->add_option("--access-log", o.service.http.access_log,
                      "Write a JSON line per request to this file, or to - for standard error");
  command->add_option("--log-level", o.log_level, "Level of the other messages, on standard error")
      ->capture_default_str()
      ->check(CLI::IsMember({"debug", "info", "warn", "error", "off"}));
  add_calibration_option(*command, o.calibration);
  add_limits(*command, o);
  add_resources(*command, o);
  add_detector_options(*command, o.service.detector);
  const auto config = std::make_shared<std::string>();
  command->add_option("--config", *config, "File with options, one \"name = value\" a line")->check(CLI::ExistingFile);
  also_from_environment(*command);
  command->callback([command, config, options] {
    if (!config->empty()) also_from_file(*command, *config);
    if (options->service.maps.empty()) throw CLI::RequiredError("--maps");
    require_room_for_one_body(*options);
    run_serve(*options);
  });
}

}  // namespace roadfix::cli
