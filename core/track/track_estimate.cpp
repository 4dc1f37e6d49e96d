#include "core/track/track_estimate.hpp"

namespace roadfix {

const char* explanation_of(Unclaimed why) {
  switch (why) {
    case Unclaimed::kFrameRepeated:
      return "the frame is one from before the vehicle moved, or shows what was seen before: check the camera and its "
             "link; or if the vehicle hovers, its odometry drifts: fly on";
    case Unclaimed::kFrameRejected:
      return "this frame does not fit at the place that the track believes in: wait for the next ones; if none fits, "
             "check height, attitude and movements, and how the camera is turned against the nose";
    case Unclaimed::kSeveralPlaces:
      return "less than 90 % of the belief lie at one place: fly on to where roads differ, or begin a track with a "
             "narrower prior";
    case Unclaimed::kPlaceTooWide:
      return "the place is known no better than to 25 m: fly on to where roads cross";
    case Unclaimed::kTooFewAgree:
      return "not yet three frames more were accepted than rejected: fly on over ground with roads";
    case Unclaimed::kNoneAgreedLately:
      return "no frame was accepted for a minute: fly on over ground with roads";
    case Unclaimed::kFramesAgreeLess:
      return "frames fit worse than they did, so that the vehicle may be elsewhere: it is searched for";
    case Unclaimed::kMayBeChance:
      return "what was seen since the last contradiction may fit by chance: fly on over ground with roads, or higher";
    case Unclaimed::kOthersNotRuledOut:
      return "no search has ruled out other places, or this one on ground of another size: fly on; if it stays so, the "
             "streets repeat, or the height is wrong: begin a track with scale_range, or one whose start is known; "
             "where steps take many seconds, searches end for lack of time";
    case Unclaimed::kNotBorneOut:
      break;
  }
  return "no search around the place has borne it out yet, or none for long: fly on";
}

}  // namespace roadfix
