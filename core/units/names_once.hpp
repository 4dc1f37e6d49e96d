// For a parser of JSON: refuses a name that an object has twice. One of the two values is a mistake, and nothing tells
// which; the library would keep the last one.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace roadfix {

/// Given to nlohmann::json::parse; calls `refuse`, which throws, with the name.
template <typename Refuse>
class NamesOnce {
 public:
  explicit NamesOnce(Refuse refuse) : refuse_(std::move(refuse)) {}

  bool operator()(int /*depth*/, nlohmann::json::parse_event_t event, const nlohmann::json& parsed) {
    using Event = nlohmann::json::parse_event_t;
    if (event == Event::object_start) seen_.emplace_back();
    if (event == Event::object_end) seen_.pop_back();
    if (event == Event::key && !seen_.back().insert(parsed.get<std::string>()).second) {
      refuse_(parsed.get_ref<const std::string&>());
    }
    return true;
  }

 private:
  Refuse refuse_;
  std::vector<std::set<std::string>> seen_;  ///< of the objects that are open, outermost first
};

}  // namespace roadfix
