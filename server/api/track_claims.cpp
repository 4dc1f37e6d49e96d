#include "server/api/track_claims.hpp"

#include <chrono>
#include <nlohmann/json.hpp>

#include "core/units/utc_text.hpp"

namespace roadfix::api {
void continue_with(std::vector<ClaimedStretch>& stretches, const nlohmann::json& answer) {
  if (answer.contains("pose")) {
    const nlohmann::json& pose = answer.at("pose");
    stretches.back().push_back({answer.at("sequence"),
                                answer.at("time_us"),
                                {pose.at("lat"), pose.at("lon")},
                                pose.at("heading_deg"),
                                answer.at("sigma_m")});
  } else if (!stretches.back().empty()) {
    stretches.emplace_back();
  }
}

std::string date_of(std::int64_t time_us) {
  if (time_us < kFirstDateUs) return {};
  return utc_text(std::chrono::system_clock::time_point(std::chrono::microseconds(time_us)));
}

}  // namespace roadfix::api
