#include "cli/place_kinds.hpp"

#include <fmt/format.h>

#include <array>

#include "core/units/words.hpp"
#include "server/api/route_json.hpp"

namespace roadfix::cli {
namespace {

constexpr std::array<Word<PlaceKind>, 4> kMeanings{
    {{"a frame gives a fix", PlaceKind::kDistinct},
     {"its roads fit elsewhere, too, or are too few to be sure: no fix, but a track may go on", PlaceKind::kSparse},
     {"it shows hardly any road: no fix, and a track has odometry alone", PlaceKind::kBare},
     {"half or more of it is not on the map: odometry alone", PlaceKind::kUnknown}}};

}  // namespace

std::string kind_line(PlaceKind kind, double share, double whole, std::string_view unit) {
  return fmt::format("  {:<9} {:3.0f} %  {:6.1f} {}  {}\n", word_of(api::kPlaceKinds, kind), 100.0 * share,
                     share * whole, unit, word_of(kMeanings, kind));
}

}  // namespace roadfix::cli
