// Attributes of road features as they come from the files of strangers: hstore and JSON text, widths, tables of rules.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/units/error.hpp"
#include "tiles/roads/osm_tags.hpp"
#include "tiles/roads/road_rules.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto tags = roadfix::parse_tags(text);
  static const roadfix::RoadRules rules;
  const auto lookup = [&tags](std::string_view key) {
    const auto found = tags.find(key);
    return found != tags.end() ? found->second : std::string();
  };
  for (const bool classified : {true, false}) {
    const auto width = rules.width_of(lookup, classified);
    if (width && !(*width > 0.0 && *width <= 100.0)) std::abort();
  }
  const auto width = roadfix::parse_width_m(text);
  if (width && !(*width >= 0.5 && *width <= 100.0)) std::abort();
  try {
    roadfix::RoadRules::parse(text);
  } catch (const roadfix::InvalidInput&) {
  }
  return 0;
}
