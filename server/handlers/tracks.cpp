#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "core/track/tracker.hpp"
#include "core/units/bytes.hpp"
#include "core/units/error.hpp"
#include "core/units/fnv.hpp"
#include "core/units/json_text.hpp"
#include "core/units/text.hpp"
#include "server/api/altitude_request.hpp"
#include "server/api/feature_request.hpp"
#include "server/api/fix_request.hpp"
#include "server/api/json_body.hpp"
#include "server/api/json_parts.hpp"
#include "server/api/media.hpp"
#include "server/api/position_answer.hpp"
#include "server/api/time_limit.hpp"
#include "server/api/track_history.hpp"
#include "server/api/track_json.hpp"
#include "server/api/track_request.hpp"
#include "server/handlers/answers.hpp"
#include "server/handlers/handlers.hpp"
#include "server/http/admission.hpp"
#include "server/http/errors.hpp"

namespace roadfix::server {
namespace {

using nlohmann::json;

constexpr int kMaxHistory = 10'000;
constexpr int kMaxParticlesShown = 10'000;

constexpr std::array<api::Media, 3> kHistoryFormats{{{"geojson", "application/geo+json"},
                                                     {"gpx", "application/gpx+xml"},
                                                     {"kml", "application/vnd.google-earth.kml+xml"}}};

std::string id_of(const http::Request& request) { return request.path_parameters.at("id"); }

std::vector<std::string> step_query() {
  return joined({api::step_fields(), api::feature_fields(), api::altitude_fields(), api::position_fields()});
}

/// Of a camera's picture as it was sent.
std::optional<SentPicture> picture_of(const api::Content& content, const api::Features& features) {
  if (!features.sketch) return std::nullopt;
  Fnv1a64 hash;
  hash.add(characters_of(content.image));
  return SentPicture{hash.value(), *features.sketch};
}

/// Of all that the step says, to tell a repeated step from another one. How it is packed says nothing: a form that is
/// sent again may have another boundary.
std::int64_t digest_of(const api::Content& content) {
  Fnv1a64 hash;
  hash.add(content.fields.summary(joined({api::position_fields(), {"image"}})));
  hash.add(characters_of(content.image));
  return static_cast<std::int64_t>(hash.value());
}

json status_json(const Service& service, const StoredTrack& track) {
  const double silent_s = std::chrono::duration<double>(service.tracks.times().silent(track)).count();
  const auto left =
      std::max(service.tracks.limits().idle - service.tracks.times().idle(track.id), std::chrono::milliseconds(0));
  return {{"id", track.id},
          {"map", api::to_json(track.map)},
          {"request", api::stored_json(track.request)},
          {"created_us", track.created_us},
          {"touched_us", track.touched_us},
          {"silent_s", silent_s},
          {"expires_in_s", std::chrono::duration<double>(left).count()},
          {"stale", silent_s >= kStaleAfterS}};
}

/// What is null counts as not given, and is not told back as if it were.
json without_nulls(const json& asked) {
  if (!asked.is_object()) return asked;
  json given = json::object();
  for (const auto& [name, value] : asked.items()) {
    if (!value.is_null()) given[name] = value;
  }
  return given;
}

/// Longer ones would take a multiple of their megabytes, and begin without a turn.
json read_track(const http::Request& request) {
  constexpr std::size_t kLongest = std::size_t{64} << 10;
  if (request.body.size() > kLongest) {
    throw LimitExceeded("json-too-long", fmt::format("the JSON has {} bytes; a track is begun with at most {}",
                                                     request.body.size(), kLongest));
  }
  return without_nulls(api::parse_json(request.body, 1000));
}

http::Response post_track(const Service& service, const http::Request& request) {
  if (request.media_type() != "application/json") {
    throw http::InvalidField("unsupported-media-type", "Content-Type",
                             "a track is begun with a JSON object (Content-Type: application/json)");
  }
  const StoredTrack track = service.tracks.create(request.client, read_track(request).dump(-1, ' ', true));
  http::Response response = json_response(status_json(service, track));
  response.status = 201;
  response.headers.emplace_back("Location", "/v1/tracks/" + track.id);
  return response;
}

/// A step as it was posted: all but its feature map, which takes a turn to detect.
struct PostedStep {
  StoredTrack track;
  api::Content content;
  api::PositionFormat format;
  SentStep sent;
};

http::Response formatted(const Service& service, const PostedStep& step, StepAnswer answer) {
  if (step.format.is_json()) return {200, "application/json", std::move(answer.text)};
  api::PositionFormat numbered = step.format;
  numbered.sender.sequence = static_cast<std::uint8_t>(step.sent.input.sequence & 0xff);
  // A step that is sent again is as old as when it came first.
  const auto age = service.tracks.times().age_of_step(step.track.id, step.sent.input.sequence);
  return api::position_response(answer.answer, numbered, {step.sent.input.time_us, age});
}

http::Response step_response(const Service& service, const PostedStep& step, StepAnswer answer) {
  const bool repeated = answer.repeated;
  const std::string status = answer.answer.at("status");
  if (!repeated) service.metrics.count(kAnswers, fmt::format("kind=\"step\",status=\"{}\"", status));
  http::Response response = formatted(service, step, std::move(answer));
  response.answer = status;
  if (repeated) response.headers.emplace_back("Roadfix-Repeated", "true");
  return response;
}

PostedStep read_step(const Service& service, const http::Request& request) {
  StoredTrack track = service.tracks.find(id_of(request));
  api::Content content = api::read_content(request, joined({step_query(), api::picture_members()}), service.limits);
  const api::PositionFormat format = api::parse_position_format(request, content.fields);
  if (!api::shows_ground(content)) api::require_nothing_seen(content.fields);
  SentStep sent{api::parse_step(content.fields), digest_of(content), request.received};
  return {std::move(track), std::move(content), format, std::move(sent)};
}

http::Response take_step(const Service& service, const http::Request& request, PostedStep& step) {
  const StoredTrack& track = step.track;
  if (auto answer = service.steps.answered(track.id, step.sent)) {  // while it waited for its turn
    return step_response(service, step, *std::move(answer));
  }
  const api::TimeLimit limit(request.deadline);
  if (api::shows_ground(step.content)) {
    auto& altitude = step.sent.input.altitude;
    altitude = api::take_altitude(
        step.content, [&](double above_sea_m) { return service.tracks.live(track.id)->agl_m(above_sea_m); });
    const auto map = service.maps.find(track.map.name);
    const auto detector = service.detectors.for_map(map->view.imagery_reader);
    api::Features features = api::features_of(
        step.content, {.detector = *detector, .cell_m = map->view.cell_m, .stop = limit.token(), .sketched = true},
        service.limits);
    if (!altitude) altitude = api::altitude_in_file(features);
    step.sent.input.picture = picture_of(step.content, features);
    step.sent.input.features = std::move(features.map);
    step.sent.detector = std::move(features.detector);
  }
  StepLimits limits;
  const SearchThreads::Share share(service.search_threads);
  limits.threads = share.threads();
  constexpr double kSearchShare = 0.9;
  limits.deadline = api::search_end(request.deadline, limit.token(), kSearchShare);
  return step_response(service, step, service.steps.take(track.id, step.sent, limits));
}

/// Reads the step and gives those that it overtook the time to be taken first, while its picture is held once. One that
/// was taken before is answered without a turn.
http::Prepared post_step(const Service& service, http::Request& request) {
  PostedStep step = read_step(service, request);
  const bool in_body = step.content.has_picture && !step.content.decoded;
  if (!in_body) std::string().swap(request.body);
  service.steps.await_predecessor(step.track.id, step.sent.input.sequence);
  if (auto answer = service.steps.answered(step.track.id, step.sent)) {
    return step_response(service, step, *std::move(answer));
  }
  return [&service, &request, step = std::move(step)]() mutable { return take_step(service, request, step); };
}

http::Response list_tracks(const Service& service, const http::Request& request) {
  json list = json::array();
  for (const StoredTrack& track : service.tracks.of_client(request.client)) list.push_back(status_json(service, track));
  return json_response({{"tracks", std::move(list)}});
}

http::Response get_track(const Service& service, const http::Request& request) {
  const api::Fields fields(request.query);
  const StoredTrack track = service.tracks.find(id_of(request));
  json answer = status_json(service, track);
  const auto last = service.tracks.last_step(track.id);
  if (last) {
    answer["last"] = api::stored_json(last->answer);
    if (const auto age = service.tracks.times().age_of_step(track.id, last->sequence)) {
      answer["last_age_s"] = std::chrono::duration<double>(*age).count();
    }
  }
  if (const auto count = fields.optional_integer("particles", 1, kMaxParticlesShown)) {
    answer["particles"] =
        api::particles_json(service.tracks.live(track.id)->particles(static_cast<std::size_t>(*count)));
  }
  return json_response(answer);
}

http::Response history(const api::FlownTrack& track, const std::vector<std::string>& answers, const api::Media& media) {
  if (media.name == "geojson") return {200, std::string(media.type), json_text(api::history_json(track, answers))};
  http::Response response{200, std::string(media.type), {}};
  response.body = media.name == "gpx" ? api::history_gpx(track, answers) : api::history_kml(track, answers);
  response.headers.emplace_back("Content-Disposition",
                                fmt::format("attachment; filename=\"{}.{}\"", track.id, media.name));
  return response;
}

http::Response get_history(const Service& service, const http::Request& request, http::Admission& turns) {
  const api::Fields fields(request.query);
  const api::Media& media = api::media_asked_for(request, fields, kHistoryFormats);
  const std::int64_t after = fields.optional_large_integer("after", -1).value_or(-1);
  const int limit = fields.optional_integer("limit", 1, kMaxHistory).value_or(kMaxHistory);
  const http::Admission::Ticket turn = turns.enter(request.client, request.deadline, request.abandoned);
  const StoredTrack track = service.tracks.recorded(id_of(request));
  std::vector<std::string> answers;
  for (StoredStep& step : service.tracks.steps_after(track.id, after, limit)) {
    answers.push_back(std::move(step.answer));
  }
  http::Response response = history({track.id, track.map}, answers, media);
  response.headers.emplace_back("Vary", "Accept");
  return response;
}

/// Where the client's stream was cut, by the header that browsers send; -1 = from the beginning.
std::int64_t last_event(const http::Request& request) {
  return as_number<std::int64_t>(request.header("last-event-id")).value_or(-1);
}

http::Response get_events(const Service& service, const http::Request& request) {
  const auto stream = service.tracks.stream(id_of(request), last_event(request));
  // nginx would collect events until its buffer is full.
  http::Response response{200, "text/event-stream", {}, {{"Cache-Control", "no-store"}, {"X-Accel-Buffering", "no"}}};
  bool over = false;
  response.stream = [stream, over]() mutable -> std::optional<std::string> {
    if (over) return std::nullopt;
    const auto news = stream->next();
    if (!news) return std::nullopt;  // without an end: the client may come again
    std::string text;
    for (const StoredStep& step : news->steps) {
      text += fmt::format("id: {}\nevent: step\ndata: {}\n\n", step.sequence, step.answer);
    }
    over = news->ended.has_value();
    if (over) text += fmt::format("event: end\ndata: {{\"reason\":\"{}\"}}\n\n", to_string(*news->ended));
    return text.empty() ? ":\n\n" : text;  // a comment keeps the connection alive
  };
  return response;
}

http::Response delete_track(const Service& service, const http::Request& request) {
  service.tracks.finish(id_of(request));
  return {204, {}, {}};
}

}  // namespace

void add_track_routes(Routes& routes) {
  routes.add("POST", "/v1/tracks", {}, post_track);
  routes.add("GET", "/v1/tracks", {}, list_tracks);
  routes.add("GET", "/v1/tracks/{id}", {"particles"}, get_track);
  routes.add("DELETE", "/v1/tracks/{id}", {}, delete_track);
  routes.add_prepared("POST", "/v1/tracks/{id}/steps", step_query(), post_step);
  // A long one takes tens of megabytes.
  routes.add(
      "GET", "/v1/tracks/{id}/history", {"after", "limit", "format"},
      [turns = turns_of(routes.service())](const Service& service, const http::Request& request) {
        return get_history(service, request, *turns);
      },
      http::Load::kLong);
  routes.add("GET", "/v1/tracks/{id}/events", {}, get_events, http::Load::kLong);
}

}  // namespace roadfix::server
