#include "tiles/roads/overture_flags.hpp"

#include <cpl_error.h>
#include <cpl_json.h>

#include <algorithm>
#include <array>

namespace roadfix {
namespace {

bool hides(const std::string& flags) {
  constexpr std::array<const char*, 3> kHiding{"is_tunnel", "is_under_construction", "is_abandoned"};
  return std::ranges::any_of(kHiding, [&](const char* flag) { return flags.find(flag) != std::string::npos; });
}

}  // namespace

double hidden_share(const std::string& road_flags) {
  if (!hides(road_flags)) return 0.0;
  const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
  CPLJSONDocument document;
  if (!document.LoadMemory(road_flags) || document.GetRoot().GetType() != CPLJSONObject::Type::Array) return 1.0;
  double share = 0.0;
  for (const CPLJSONObject& flag : document.GetRoot().ToArray()) {
    if (!hides(flag.ToString())) continue;
    const CPLJSONArray between = flag.GetArray("between");
    share += between.IsValid() && between.Size() == 2 ? between[1].ToDouble() - between[0].ToDouble() : 1.0;
  }
  return std::min(share, 1.0);
}

}  // namespace roadfix
