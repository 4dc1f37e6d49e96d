#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>
#include <chrono>
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
#include "cli/unit_options.hpp"
#include "core/units/parallel_for.hpp"
#include "server/application.hpp"

namespace roadfix::cli {
namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20;
constexpr double kMaxSeconds = 1e6;
constexpr double kMaxMiB = 1 << 20;  // a TiB
constexpr double kMaxThreads = 10'000;

struct ServeOptions {
  server::Configuration service;
  std::optional<std::chrono::milliseconds> turn_time;  ///< else as long as the request time
  std::string log_level = "info";
  std::string calibration;
  std::vector<std::string> proxies;
  std::vector<std::string> names;
};

server::Configuration configuration(const ServeOptions& options) {
  server::Configuration result = options.service;
  if (!options.calibration.empty()) result.calibration = read_calibration(options.calibration);
  result.http.proxies = http::Proxies(options.proxies);
  result.http.names = http::ServedNames(result.http.host, options.names);
  result.http.turn_time = options.turn_time.value_or(result.http.request_time);
  // Each takes a thread for as long as it is open.
  result.track_limits.streams = std::min(result.track_limits.streams, result.http.threads / 2);
  result.track_limits.steps_waiting = std::max(1, result.http.threads / 4);
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

/// Options that stand together in the help; all are above 0, and what they write into has their defaults.
class OptionGroup {
 public:
  OptionGroup(CLI::App& command, const char* name) : command_(command), name_(name) {}

  template <typename Number>
  void number(const char* name, Number& value, const char* text, double max = kMaxNumber) {
    command_.add_option(name, value, text)->capture_default_str()->check(positive(max))->group(name_);
  }
  void seconds(const char* name, std::chrono::milliseconds& time, const char* text) {
    add_seconds(name, time, text)->default_str(fmt::format("{}", std::chrono::duration<double>(time).count()));
  }
  void seconds(const char* name, std::optional<std::chrono::milliseconds>& time, const char* text) {
    add_seconds(name, time, text);
  }
  template <typename Bytes>
  void mib(const char* name, Bytes& bytes, const char* text) {
    const auto take = [&bytes](std::size_t mib) { bytes = static_cast<Bytes>(mib * kMiB); };
    command_.add_option_function<std::size_t>(name, take, text)
        ->default_str(fmt::format("{}", static_cast<std::size_t>(bytes) / kMiB))
        ->check(positive(kMaxMiB))
        ->group(name_);
  }

 private:
  CLI::Option* add_seconds(const char* name, auto& time, const char* text) {
    return add_seconds_option(command_, name, time, text)->check(positive(kMaxSeconds))->group(name_);
  }

  CLI::App& command_;
  const char* name_;
};

void add_limits(CLI::App& command, ServeOptions& o) {
  auto& http = o.service.http;
  auto& limits = o.service.limits;
  OptionGroup group(command, "Limits of one request");
  group.mib("--max-body", http.body_bytes, "Body in MiB, after unpacking");
  group.seconds("--body-time", http.connection.body, "Seconds that a body may take to arrive");
  group.number("--max-pixels", limits.pixels, "Pixels of a picture");
  group.number("--max-cells", limits.cells, "Cells of a window or feature map");
  group.number("--max-poses", limits.poses, "Poses of a match");
  group.number("--max-search", limits.search_km2, "Area of a search in km2");
  group.number("--max-particles", limits.particles, "Particles of a track");
  group.seconds("--request-time", http.request_time, "Seconds that an answer may take; searches count from their turn");
  group.seconds("--turn-time", o.turn_time,
                "Seconds that a search or detection may wait for its turn; default: --request-time");
}

void add_resources(CLI::App& command, ServeOptions& o) {
  auto& http = o.service.http;
  auto& tracks = o.service.track_limits;
  OptionGroup group(command, "Resources");
  group.number("--threads", http.threads, "Connections served at the same time", kMaxThreads);
  group.number("--searches", http.heavy_running,
               "Searches and detections at the same time, and as many steps of tracks");
  group.number("--searches-waiting", http.heavy_waiting, "Searches and detections that may wait; further ones get 503");
  group.number("--search-threads", o.service.search_threads,
               "Threads of a search; searches that run at the same time share them", kMaxThreads);
  group.mib("--body-memory", http.all_bodies_bytes,
            "Bodies of all requests at once, MiB; further ones get 503. At least --max-body");
  group.seconds("--idle-time", http.idle_time, "Seconds after which an idle connection is closed");
  group.mib("--map-cache", o.service.map_cache_bytes.tiles, "Decoded tiles in memory per map, MiB");
  group.mib("--search-cache", o.service.map_cache_bytes.searches, "Search data kept for later searches, per map, MiB");
  group.mib("--picture-cache", o.service.picture_cache_bytes, "Rendered tiles in memory, MiB");
  group.number("--max-tracks", tracks.tracks, "Tracks at the same time");
  group.number("--max-client-tracks", tracks.tracks_per_client, "Tracks per client address");
  group.number("--max-streams", tracks.streams, "Event streams at the same time, at most half of --threads");
  group.mib("--tracks-size", tracks.store_bytes, "Maximum size of the track file, MiB");
  group.seconds("--step-wait", tracks.order_wait, "Seconds that a step waits for steps it overtook");
  group.seconds("--track-idle", tracks.idle, "Seconds without a step after which a track ends");
  group.seconds("--watch", o.service.watch_interval, "Seconds between scans of the map folder");
}

/// Whatever they come from. Otherwise every body of the size that is allowed would be told to come again.
void require_room_for_one_body(const ServeOptions& options) {
  const http::ServerSettings& http = options.service.http;
  if (http.all_bodies_bytes >= http.body_bytes) return;
  throw CLI::ValidationError(
      "--body-memory", fmt::format("{0} MiB hold no body of the {1} MiB that --max-body allows: give {1} or more, or a "
                                   "smaller --max-body",
                                   http.all_bodies_bytes / kMiB, http.body_bytes / kMiB));
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
  command
      ->add_option("--server-name", o.names,
                   "Name or address by which requests may call the service, beside localhost and --host; repeatable. "
                   "Where others may call it (--host) and none is told, any will do")
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
