// Tracks: what begins one, their steps, and what a damaged store hands back.
// The first byte chooses: 't' JSON of a track, 's' JSON of a step, 'b' the bytes of a state.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>

#include "core/track/tracker_bytes.hpp"
#include "core/units/error.hpp"
#include "server/api/json_body.hpp"
#include "server/api/position_answer.hpp"
#include "server/api/track_request.hpp"

namespace {

namespace api = roadfix::api;

api::Fields fields_of(const std::string& body, std::vector<std::string> known) {
  known.insert(known.end(), api::position_fields().begin(), api::position_fields().end());
  api::Fields fields;
  fields.add(api::parse_json(body, 1000), known);
  return fields;
}

void read(char kind, const std::string& body) {
  if (kind == 't') api::parse_track(fields_of(body, api::track_members()), {});
  if (kind == 's') {
    const api::Fields fields = fields_of(body, api::step_fields());
    api::parse_position_format({}, fields);
    api::parse_step(fields);
  }
  if (kind == 'b') {
    const auto bytes = std::as_bytes(std::span(body));
    if (!std::ranges::equal(roadfix::to_bytes(roadfix::tracker_state_of(bytes)), bytes)) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  try {
    read(static_cast<char>(data[0]), std::string(data + 1, data + size));
  } catch (const roadfix::Error&) {
    return 0;
  }
  return 0;
}
