// Tiles and windows per second over real sockets on this machine, keep-alive, one client a thread. Warm = what is asked
// for was asked for before; cold = nothing is kept: every request reads, decodes and renders.
#include <benchmark/benchmark.h>
#include <httplib.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/application.hpp"
#include "tests/support/map_file.hpp"
#include "tests/support/street_map.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tiles/mercator/web_mercator.hpp"

namespace roadfix {
namespace {

constexpr int kSideCells = 2048;
constexpr int kZoom = 16;
const GridGeometry kGround{2.0, {300'000, -3'200'000}, kSideCells, kSideCells};

/// A town of 4 x 4 km and a service that keeps as much as the caches say.
class RunningService {
 public:
  explicit RunningService(bool keeps) {
    testing::write_map_file(folder_ / "town.gpkg", testing::street_map(1, kGround), 0.0);
    server::Configuration configuration;
    configuration.maps = folder_.path();
    configuration.detector.name = "tree";
    configuration.http.port = 0;
    if (!keeps) {
      configuration.map_cache_bytes.tiles = 0;
      configuration.picture_cache_bytes = 0;
    }
    spdlog::set_level(spdlog::level::warn);
    application_ = std::make_unique<server::Application>(configuration);
    port_ = application_->start();
  }
  int port() const { return port_; }

 private:
  testing::TemporaryFolder folder_;
  std::unique_ptr<server::Application> application_;
  int port_ = 0;
};

const RunningService& service(bool keeps) {
  static const RunningService warm(true);
  static const RunningService cold(false);
  return keeps ? warm : cold;
}

LatLon middle() {
  const GridBox box = kGround.box();
  return UtmZone::from_epsg(32634)->unproject(box.centre());
}

std::vector<std::string> tile_paths() {
  const mercator::MercatorPixel pixel = mercator::mercator_pixel(middle(), kZoom);
  std::vector<std::string> paths;
  for (int y = -2; y < 2; ++y) {
    for (int x = -2; x < 2; ++x) {
      paths.push_back("/v1/maps/town/tiles/" + std::to_string(kZoom) + "/" +
                      std::to_string(static_cast<int>(pixel.x / 256) + x) + "/" +
                      std::to_string(static_cast<int>(pixel.y / 256) + y) + ".png");
    }
  }
  return paths;
}

std::vector<std::string> window_paths() {
  std::vector<std::string> paths;
  for (int heading = 0; heading < 360; heading += 23) {
    paths.push_back("/v1/maps/town/window?lat=" + std::to_string(middle().lat_deg) +
                    "&lon=" + std::to_string(middle().lon_deg) +
                    "&width_m=400&height_m=400&heading_deg=" + std::to_string(heading));
  }
  return paths;
}

void ask(benchmark::State& state, const std::vector<std::string>& paths, bool keeps) {
  httplib::Client client("127.0.0.1", service(keeps).port());
  client.set_keep_alive(true);
  client.set_tcp_nodelay(true);
  auto next = static_cast<std::size_t>(state.thread_index()) * 5;
  std::int64_t bytes = 0;
  for (auto _ : state) {
    const auto answer = client.Get(paths[next++ % paths.size()]);
    if (!answer || answer->status != 200) {
      state.SkipWithError("no tile or window came back");
      break;
    }
    bytes += static_cast<std::int64_t>(answer->body.size());
  }
  state.SetItemsProcessed(state.iterations());
  state.SetBytesProcessed(bytes);
}

void tiles_warm(benchmark::State& state) { ask(state, tile_paths(), true); }
void tiles_cold(benchmark::State& state) { ask(state, tile_paths(), false); }
void windows_warm(benchmark::State& state) { ask(state, window_paths(), true); }
void windows_cold(benchmark::State& state) { ask(state, window_paths(), false); }

BENCHMARK(tiles_warm)->Threads(1)->Threads(16)->UseRealTime();
BENCHMARK(tiles_cold)->Threads(1)->Threads(16)->UseRealTime();
BENCHMARK(windows_warm)->Threads(1)->Threads(16)->UseRealTime();
BENCHMARK(windows_cold)->Threads(1)->Threads(16)->UseRealTime();

}  // namespace
}  // namespace roadfix
