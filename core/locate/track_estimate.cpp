#include "core/locate/track_estimate.hpp"

namespace roadfix {

const char* to_string(Measurement measurement) {
  switch (measurement) {
    case Measurement::kNone:
      return "none";
    case Measurement::kSearched:
      return "searched";
    case Measurement::kAccepted:
      return "accepted";
    case Measurement::kRejected:
      return "rejected";
    case Measurement::kUseless:
      return "useless";
    case Measurement::kRepeated:
      break;
  }
  return "repeated";
}

}  // namespace roadfix
