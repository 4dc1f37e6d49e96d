// Simulated vehicles over the real service, which is killed amid their flights and comes back.
#include <gmock/gmock.h>
#include <httplib.h>
#include <signal.h>

#include <atomic>
#include <thread>

#include "cli/fly/service_localizer.hpp"
#include "core/units/error.hpp"
#include "tests/e2e/service_fixture.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/map_view.hpp"

namespace roadfix::fly {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr int kVehicles = 4;
constexpr int kSteps = 12;

class Vehicles : public ::testing::Test {
 protected:
  Vehicles() {
    testing::write_map_file(folder_ / "town.gpkg", town_.roads, 2.0);
    flight_plan_.steps = kSteps;
    flight_plan_.missing_share = 0.2;
    campaign_.flights.source = [this](int, std::uint64_t seed, const std::function<void()>& seen) {
      const GridBox box{{600'500.0, 6'399'500.0}, {600'800.0, 6'399'800.0}};
      return fly(flight_plan_, box, *make_random_pilot(box, flight_plan_.handling), *sensor_, seed, seen);
    };
    campaign_.filters = {"default"};
    campaign_.flights.number = kVehicles;
    campaign_.jobs = kVehicles;
    plan_.map = "town";
    plan_.filter.particles = 500;
    plan_.patience = 1h;
    plan_.keeps_tracks = true;
  }

  /// With time for everything: a loaded machine may take minutes.
  std::unique_ptr<testing::ServiceProcess> service(const std::string& store, int port = 0) const {
    return std::make_unique<testing::ServiceProcess>(
        folder_.path(), std::vector<std::string>{"--request-time", "600", "--tracks", (folder_ / store).string()},
        port);
  }
  std::vector<fly::Run> flown(int port) {
    plan_.base = "http://127.0.0.1:" + std::to_string(port);
    campaign_.localizer = service_localizers(plan_);
    return run(campaign_, map_.zone).at(0).runs;
  }
  /// Answers of the steps by the flight's seed, without the name of the track.
  static std::map<std::uint64_t, std::vector<json>> histories(const testing::ServiceProcess& service) {
    httplib::Client client = testing::client_of(service);
    std::map<std::uint64_t, std::vector<json>> result;
    const json tracks = testing::json_of(client.Get("/v1/tracks")).at("tracks");
    for (const json& track : tracks) {
      const std::string path = "/v1/tracks/" + track.at("id").get<std::string>() + "/history";
      const json features = testing::json_of(client.Get(path.c_str())).at("features");
      for (const json& feature : features) {
        if (feature.at("properties").contains("sequence")) result[track.at("request").at("seed")].push_back(feature);
      }
    }
    return result;
  }

  const testing::Town town_;
  const testing::TemporaryFolder folder_;
  MapView map_ = testing::view_of(town_.roads);
  std::unique_ptr<Sensor> sensor_ = make_simulated_sensor(map_, {250.0, 250.0}, {0.1, 0.1, 0.0, 1.0, 0.0, 0.0});
  FlightPlan flight_plan_;
  Campaign campaign_;
  ServicePlan plan_;
};

void expect_equal(const std::vector<fly::Run>& a, const std::vector<fly::Run>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].records.size(), static_cast<std::size_t>(kSteps));
    ASSERT_EQ(b[i].records.size(), static_cast<std::size_t>(kSteps));
    for (std::size_t k = 0; k < a[i].records.size(); ++k) {
      const Record& x = a[i].records[k];
      const Record& y = b[i].records[k];
      EXPECT_EQ(x.best.position, y.best.position) << "vehicle " << i << ", step " << k;
      EXPECT_EQ(x.best.heading.radians(), y.best.heading.radians());
      EXPECT_EQ(x.nees, y.nees);
      EXPECT_EQ(x.estimate.measurement, y.estimate.measurement);
      EXPECT_EQ(x.estimate.converged(), y.estimate.converged());
      EXPECT_EQ(x.estimate.particles, y.estimate.particles);
    }
  }
}

TEST_F(Vehicles, AreFollowedAndLeaveNoTracksBehind) {
  const auto running = service("tracks.sqlite");
  campaign_.flights.number = 2;
  plan_.keeps_tracks = false;
  flight_plan_.missing_share = 0.0;
  std::size_t shown = 0;
  campaign_.watch = [&](const std::string&, const Record&, const Localizer& localizer) {
    shown += localizer.particles(50).size();
  };
  for (const fly::Run& flight : flown(running->port())) EXPECT_LT(flight.records.back().error_m, 25.0);
  EXPECT_GT(shown, 25U * kSteps) << "of the first vehicle";
  httplib::Client client = testing::client_of(*running);
  EXPECT_TRUE(testing::json_of(client.Get("/v1/tracks"))["tracks"].empty());
}

TEST_F(Vehicles, LeaveNoTracksBehindWhereTheyFailOrAreStopped) {
  const auto running = service("tracks.sqlite");
  httplib::Client client = testing::client_of(*running);
  const auto tracks = [&] { return testing::json_of(client.Get("/v1/tracks"))["tracks"].size(); };
  campaign_.flights.number = 2;  // the one that fails and one beside it
  plan_.keeps_tracks = false;
  std::size_t active = 0;
  const auto code_when = [&](const auto& first_step) {
    campaign_.watch = [&](const std::string&, const Record&, const Localizer&) {
      active = tracks();
      first_step();
    };
    return testing::code_of([&] { flown(running->port()); });
  };
  EXPECT_EQ(code_when([] { throw IoFailure("result-unwritable", "of the first vehicle"); }), "result-unwritable");
  EXPECT_GT(active, 0U);
  EXPECT_EQ(tracks(), 0U);
  std::stop_source stop;
  campaign_.stop = stop.get_token();
  plan_.stop = stop.get_token();
  EXPECT_EQ(code_when([&] { stop.request_stop(); }), "work-stopped");
  EXPECT_EQ(tracks(), 0U);
}

TEST_F(Vehicles, SayWhyTheyCannotBeFollowed) {
  auto running = service("tracks.sqlite");
  flight_plan_.steps = 1;
  const auto code = [&] { return testing::code_of([&] { flown(running->port()); }); };
  plan_.map = "nowhere";
  EXPECT_EQ(code(), "service-refused");
  plan_.patience = 0s;
  running->send_signal(SIGKILL);
  EXPECT_NE(running->wait(10min), -1);
  EXPECT_EQ(code(), "service-silent");
}

TEST_F(Vehicles, LoseNothingWhenTheServiceIsKilledAmidTheirFlightsAndComesBack) {
  std::vector<fly::Run> expected;
  {
    const auto undisturbed = service("undisturbed.sqlite");
    expected = flown(undisturbed->port());
  }
  auto running = service("tracks.sqlite");
  const int port = running->port();
  // Killed after a third of the answers and again after two thirds, while the other vehicles' steps are under way.
  std::atomic<int> answered = 0;
  campaign_.progress = [&](std::int64_t done, std::int64_t) {
    // Of each flight the steps are seen first and then answered.
    answered = static_cast<int>(done) - kVehicles * kSteps;
    answered.notify_all();
  };
  std::vector<fly::Run> flights;
  std::jthread flying([&] {
    flights = flown(port);
    answered = kVehicles * kSteps;
    answered.notify_all();
  });
  for (const int after : {kVehicles * kSteps / 3, 2 * kVehicles * kSteps / 3}) {
    for (int now = answered; now < after; now = answered) answered.wait(now);
    running->send_signal(SIGKILL);
    EXPECT_NE(running->wait(10min), -1);
    running.reset();
    running = service("tracks.sqlite", port);
  }
  flying.join();
  expect_equal(flights, expected);
  const auto kept = histories(*running);
  for (const fly::Run& flight : flights) {
    ASSERT_TRUE(kept.contains(flight.seed));
    const std::vector<json>& history = kept.at(flight.seed);
    ASSERT_EQ(history.size(), flight.records.size()) << "an answered step was lost, or one was taken twice";
    for (std::size_t k = 0; k < history.size(); ++k) {
      EXPECT_EQ(history[k]["properties"]["sequence"], flight.records[k].sequence);
      EXPECT_EQ(history[k]["properties"]["status"] == "converged", flight.records[k].estimate.converged());
    }
  }
}

}  // namespace
}  // namespace roadfix::fly
