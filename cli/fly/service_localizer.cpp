#include "cli/fly/service_localizer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>

#include "cli/fly/service_answer.hpp"
#include "core/detect/feature_map_codec.hpp"
#include "core/detect/image_codec.hpp"
#include "core/units/error.hpp"
#include "server/http/client.hpp"

namespace roadfix::fly {
namespace {

using http::Answer;
using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kAnswerTime{600};  // a first search of a large map takes its time
constexpr std::chrono::seconds kFarewellTime{2};  // nobody waits for that answer

/// Worth another try: the service is not there, has too much to do, or cannot write just now.
bool may_pass(const std::optional<Answer>& answer) {
  return !answer || answer->status == 502 || answer->status == 503 || answer->status == 504;
}

std::string reason_of(const std::optional<Answer>& answer) {
  if (!answer) return "no answer";
  const json problem = json::parse(answer->body, nullptr, false);
  if (!problem.is_object()) return std::to_string(answer->status);
  return fmt::format("{} {}: {}", answer->status, problem.value("code", "?"), problem.value("detail", "?"));
}

/// A connection that sends a request until it is answered, or patience is at its end.
class Connection {
 public:
  using Send = std::function<std::optional<Answer>(http::Client&)>;

  explicit Connection(const ServicePlan& plan)
      : client_(plan.base, kAnswerTime), base_(plan.base), patience_(plan.patience), stop_(plan.stop) {}

  json ask(const Send& send) {
    const Clock::time_point began = Clock::now();
    json content = answered(send, began);
    waited_ += Clock::now() - began;
    return content;
  }

  std::chrono::duration<double, std::milli> waited() const { return waited_; }

 private:
  json answered(const Send& send, Clock::time_point began) {
    constexpr std::chrono::milliseconds kFirstPause{20};
    constexpr std::chrono::milliseconds kLongestPause{2000};
    for (std::chrono::milliseconds pause = kFirstPause;; pause = std::min(2 * pause, kLongestPause)) {
      const std::optional<Answer> answer = send(client_);
      if (!may_pass(answer)) return content_of(*answer);
      if (stop_.stop_requested()) throw Interrupted("flight-stopped", "the flights were stopped");
      if (Clock::now() + pause > began + patience_) {
        throw IoFailure("service-silent", fmt::format("the service at {} did not take a request within {} s ({})",
                                                      base_, patience_.count(), reason_of(answer)));
      }
      rest(answer && answer->retry_after ? std::max<std::chrono::milliseconds>(pause, *answer->retry_after) : pause);
    }
  }

  static json content_of(const Answer& answer) {
    if (answer.status >= 400) throw InvalidInput("service-refused", "the service refused: " + reason_of(answer));
    return answer.body.empty() ? json() : json::parse(answer.body, nullptr, false);
  }

  void rest(std::chrono::milliseconds pause) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any stopped;
    stopped.wait_for(lock, stop_, pause, [] { return false; });
  }

  http::Client client_;
  const std::string base_;
  const std::chrono::seconds patience_;
  const std::stop_token stop_;
  std::chrono::duration<double, std::milli> waited_{0.0};
};

json track_request(const ServicePlan& plan, const std::string& filter, std::uint64_t seed) {
  if (filter != "default" && filter != "paper") {
    throw InvalidInput("filter-unknown",
                       fmt::format("a service has no filter '{}': take default or paper, or fly without it", filter));
  }
  json request{{"map", plan.map},
               {"filter", filter == "paper" ? "paper" : "adaptive"},
               {"particles", plan.particles},
               {"measure_every", plan.measure_every},
               {"seed", seed},
               {"odometry_share", plan.vehicle.odometry_share},
               {"wind_sigma_m_s", plan.vehicle.wind.sigma_m_s},
               {"wind_walk", plan.vehicle.wind.walk},
               {"scale_range", plan.vehicle.scale_range}};
  if (plan.vehicle.planar) {
    const auto degrees = [](double radians) { return Angle::radians(radians).degrees(); };
    request["speed_m_s"] = plan.vehicle.planar->speed_m_s.mean;
    request["speed_sigma_m_s"] = plan.vehicle.planar->speed_m_s.sigma;
    request["turn_rate_deg_s"] = degrees(plan.vehicle.planar->turn_rate_rad_s.mean);
    request["turn_rate_sigma_deg_s"] = degrees(plan.vehicle.planar->turn_rate_rad_s.sigma);
  }
  return request;
}

/// A picture and the values that describe it.
struct Picture {
  json fields = json::object();
  std::string png;
};

Picture picture_of(const FeatureMap& features) {
  const auto png = encode_feature_map(features);
  return {{{"cell_m", features.cell_m},
           {"nadir_col", features.nadir.col},
           {"nadir_row", features.nadir.row},
           {"nadir_sigma_m", features.nadir_sigma_m}},
          {png.begin(), png.end()}};
}

std::string with_commas(const std::vector<double>& numbers) { return fmt::format("{}", fmt::join(numbers, ",")); }

json camera_fields(const FrameCamera& camera) {
  json fields{{"agl_m", camera.agl_m}};
  if (camera.roll_sigma != kUntoldAttitudeSigma) fields["roll_deg"] = camera.roll.degrees();
  if (camera.pitch_sigma != kUntoldAttitudeSigma) fields["pitch_deg"] = camera.pitch.degrees();
  if (camera.horizontal_fov) fields["fov_deg"] = camera.horizontal_fov->degrees();
  if (camera.focal_px) fields["focal_px"] = *camera.focal_px;
  if (camera.principal_px) fields["principal_px"] = with_commas({camera.principal_px->x, camera.principal_px->y});
  if (camera.lens == LensModel::kFisheye) fields["lens"] = "fisheye";
  if (!camera.distortion.empty()) fields["distortion"] = with_commas(camera.distortion);
  return fields;
}

Picture picture_of(const CameraFrame& frame) {
  const auto png = encode_frame(frame.image);
  Picture picture{{{"kind", "frame"}, {"cell_m", frame.cell_m}, {"seed", frame.seed}}, {png.begin(), png.end()}};
  if (frame.camera) {
    picture.fields.update(camera_fields(*frame.camera));
  } else {
    picture.fields["gsd_m"] = frame.image.gsd_m;
  }
  return picture;
}

json told(const StepInput& step) {
  json fields{{"sequence", step.sequence}, {"time_us", step.time_us}};
  if (step.odometry) {
    fields["forward_m"] = step.odometry->forward_m;
    fields["right_m"] = step.odometry->right_m;
    fields["turn_deg"] = step.odometry->turn.degrees();
  }
  return fields;
}

std::string as_query(const json& fields) {
  std::string query;
  for (const auto& [name, value] : fields.items()) {
    query += (query.empty() ? "?" : "&") + name + "=" + (value.is_string() ? value.get<std::string>() : value.dump());
  }
  return query;
}

class ServiceLocalizer : public Localizer {
 public:
  ServiceLocalizer(const ServicePlan& plan, const std::string& filter, std::uint64_t seed)
      : connection_(plan), base_(plan.base), keeps_(plan.keeps_tracks) {
    const std::string request = track_request(plan, filter, seed).dump();
    // Should the answer be lost, the track that was begun expires without a step.
    const json track =
        connection_.ask([&](http::Client& client) { return client.post("/v1/tracks", request, "application/json"); });
    if (!track.is_object() || !track.contains("id")) {
      throw InvalidInput("service-answer-unreadable", plan.base + " begins no tracks: is it a Roadfix service?");
    }
    path_ = "/v1/tracks/" + track.at("id").get<std::string>();
  }

  /// The track of a flight that failed or was stopped would count among its client's until it expires.
  ~ServiceLocalizer() override {
    if (keeps_ || finished_) return;
    try {
      http::Client(base_, kFarewellTime).remove(path_);
    } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch): what ended the flight is the error to tell of
    }
  }

  TrackEstimate advance(const Report& step) override {
    json fields = told(step);
    if (!step.saw()) {
      const std::string body = fields.dump();
      return estimate_of(connection_.ask(
          [&](http::Client& client) { return client.post(path_ + "/steps", body, "application/json"); }));
    }
    const Picture picture = step.frame ? picture_of(step.frame()) : picture_of(*step.features);
    fields.update(picture.fields);
    const std::string target = path_ + "/steps" + as_query(fields);
    return estimate_of(
        connection_.ask([&](http::Client& client) { return client.post(target, picture.png, "image/png"); }));
  }

  std::vector<GeoPose> particles(std::size_t count) const override {
    const std::string target = fmt::format("{}?particles={}", path_, std::clamp<std::size_t>(count, 1, 10'000));
    const json track = connection_.ask([&](http::Client& client) { return client.get(target); });
    return track.contains("particles") ? particles_of(track.at("particles")) : std::vector<GeoPose>();
  }

  /// Of all that the vehicle waited for, the network and the other vehicles included.
  double clock_ms() const override { return connection_.waited().count(); }

  void finish() override {
    finished_ = true;
    if (keeps_) return;
    connection_.ask([&](http::Client& client) {
      std::optional<Answer> answer = client.remove(path_);
      constexpr int kGone = 410;
      if (answer && answer->status == kGone) answer->status = 204;  // ended already, by a request whose answer was lost
      return answer;
    });
  }

 private:
  mutable Connection connection_;
  const std::string base_;
  const bool keeps_;
  std::string path_;
  bool finished_ = false;
};

}  // namespace

LocalizerFactory service_localizers(const ServicePlan& plan) {
  return [plan](const std::string& filter, std::uint64_t seed) -> std::unique_ptr<Localizer> {
    return std::make_unique<ServiceLocalizer>(plan, filter, seed);
  };
}

}  // namespace roadfix::fly
