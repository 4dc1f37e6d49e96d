// scripts/ground_station as a ground station runs it: steps as lines of JSON, the real service, an autopilot's socket.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include "tests/e2e/tracks_fixture.hpp"
#include "tests/support/run_program.hpp"

namespace roadfix {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kNoPython = "python3 is not installed";

/// Where an autopilot would listen.
class Socket {
 public:
  Socket() : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (::bind(socket_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
      throw std::system_error(errno, std::generic_category(), "no UDP port is free");
    }
    port_ = ntohs(address.sin_port);
  }
  ~Socket() { ::close(socket_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  int port() const { return port_; }
  std::vector<std::string> received() const {
    std::vector<std::string> packets;
    std::array<char, 2048> bytes{};
    for (;;) {
      const ssize_t size = ::recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (size < 0) return packets;
      packets.emplace_back(bytes.data(), static_cast<std::size_t>(size));
    }
  }

 private:
  int socket_;
  int port_ = 0;
};

class GroundStation : public Tracks {
 protected:
  void SetUp() override {
    if (std::system("command -v python3 >/dev/null") != 0) GTEST_SKIP() << kNoPython;
  }

  /// The next steps of the flight as lines; the vehicle's own frame has another origin than the Earth's.
  std::string lines(int count) {
    std::string text;
    for (int i = 0; i < count; ++i) {
      const StepInput step = flight_.step();
      const std::string file = fmt::format("{}.png", step.sequence);
      std::ofstream(folder_ / file, std::ios::binary) << request_of(step).picture;
      const GridPose at = flight_.pose();
      text += json{{"time_us", step.time_us},
                   {"north_m", at.position.north_m - origin_.north_m},
                   {"east_m", at.position.east_m - origin_.east_m},
                   {"yaw_deg", at.heading.degrees()},
                   {"image", file}}
                  .dump() +
              "\n";
    }
    return text;
  }

  testing::ProgramResult fly(const testing::ServiceProcess& service, const std::string& steps,
                             const std::string& options = "") const {
    std::ofstream(folder_ / "steps.jsonl") << steps;
    const std::string out = (folder_ / "out").string();
    const std::string err = (folder_ / "err").string();
    const int status = std::system(
        fmt::format("python3 -B {} '{}' --server http://127.0.0.1:{} --map town --frame cell_m=2 --track lat={} lon={} "
                    "radius_m=200 particles=2000 seed=7 --state '{}' {} >'{}' 2>'{}'",
                    ROADFIX_GROUND_STATION, (folder_ / "steps.jsonl").string(), service.port(), town_.place.lat_deg,
                    town_.place.lon_deg, (folder_ / "state.json").string(), options, out, err)
            .c_str());
    return {WEXITSTATUS(status), testing::text_of(out), testing::text_of(err)};
  }

  static std::vector<json> answers(const testing::ProgramResult& result) {
    std::vector<json> list;
    std::istringstream text(result.out);
    for (std::string line; std::getline(text, line);) list.push_back(json::parse(line));
    return list;
  }

  double error_m(const json& answer) const {
    return distance_m(town_.zone.project({answer["pose"]["lat"], answer["pose"]["lon"]}), flight_.pose().position);
  }

  testing::Flight flight_{town_.roads, town_.pose, 20};
  const GridPoint origin_ = town_.pose.position;
};

TEST_F(GroundStation, FliesATrackAndTellsTheAutopilot) {
  const auto running = service();
  const Socket autopilot;
  const auto result =
      fly(*running, lines(8), fmt::format("--format nmea --send 127.0.0.1:{} --max-age 600", autopilot.port()));
  ASSERT_EQ(result.code, 0) << result.err;
  const auto all = answers(result);
  ASSERT_EQ(all.size(), 8U);
  ASSERT_EQ(all.back()["status"], "converged") << all.back();
  EXPECT_LT(error_m(all.back()), 12.0);
  EXPECT_EQ(all.back()["missed_steps"], 0);
  const auto packets = autopilot.received();
  ASSERT_EQ(packets.size(), 8U);
  for (const std::string& packet : packets) EXPECT_THAT(packet, StartsWith("$"));
}

TEST_F(GroundStation, GoesOnWithItsTrackWhenItIsStartedAgain) {
  const auto running = service();
  const auto before = answers(fly(*running, lines(5)));
  const auto after = answers(fly(*running, lines(3)));
  ASSERT_EQ(before.size(), 5U);
  ASSERT_EQ(after.size(), 3U);
  EXPECT_EQ(after.front()["track"], before.front()["track"]);
  EXPECT_EQ(after.back()["sequence"], 8);
  EXPECT_EQ(after.back()["resets"], before.back()["resets"]);
  ASSERT_EQ(after.back()["status"], "converged");
  EXPECT_LT(error_m(after.back()), 12.0);
}

TEST_F(GroundStation, BeginsAnewWhereItWasWhenTheTrackHasEnded) {
  const auto running = service();
  const auto before = answers(fly(*running, lines(8)));
  ASSERT_EQ(before.back()["status"], "converged");
  httplib::Client client = client_of(*running);
  const std::string id = before.back()["track"];
  client.Delete(("/v1/tracks/" + id).c_str());
  const auto after = answers(fly(*running, lines(1)));
  ASSERT_EQ(after.size(), 1U);
  EXPECT_NE(after.back()["track"], id);
  const json track = testing::json_of(client.Get(("/v1/tracks/" + after.back()["track"].get<std::string>()).c_str()));
  EXPECT_GT(track["request"]["radius_m"], 100.0);
  EXPECT_NE(track["request"]["radius_m"], 200.0) << "not where the flight began";
  EXPECT_NEAR(track["request"]["lat"], before.back()["pose"]["lat"], 1e-9);
  EXPECT_EQ(track["request"]["seed"], 7);
}

TEST_F(GroundStation, SaysWhichLineCannotBeTakenAndGoesOn) {
  const auto running = service();
  std::string steps = lines(1) + "no json\n\n{\"north_m\": 1}\n";
  steps += R"({"north_m": 0, "east_m": 0, "yaw_deg": 0, "image": "missing.png"})";
  steps += "\n";
  steps += R"({"north_m": 0, "east_m": 0, "yaw_deg": 0, "time_us": 5, "wings": 2})";
  steps += "\n" + lines(1);
  const auto result = fly(*running, steps);
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(answers(result).size(), 2U);
  EXPECT_EQ(answers(result).back()["missed_steps"], 0) << "what was refused has no number";
  for (const char* message : {"line 2: a step is a JSON object", "line 4: a step needs east_m",
                              "line 5 (missing.png): ", "line 6: 400 unknown-field"}) {
    EXPECT_THAT(result.err, HasSubstr(message));
  }
}

}  // namespace
}  // namespace roadfix
