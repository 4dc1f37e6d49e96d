// The first flight as pictures of chosen steps and as a film.
#pragma once

#include <string>
#include <vector>

#include "cli/fly/film.hpp"
#include "cli/fly/picture.hpp"

namespace roadfix::fly {

struct FlightPictureOptions {
  std::string folder;      ///< of the pictures, is there; empty = none
  std::vector<int> steps;  ///< empty = 0, 1, 5, 20, 80
  std::string film;        ///< file; empty = none
  int frames_per_second = 8;
  int longest_px = 900;
};

class FlightPictures {
 public:
  /// `imagery` may be null; all must outlive it.
  FlightPictures(const MapView& map, const Orthoimage* imagery, const Footprint& footprint,
                 FlightPictureOptions options);

  /// Steps of one filter in their order. Not thread-safe. Throws IoFailure "result-unwritable", as finish() does.
  void show(const std::string& filter, const Record& record, const Localizer& localizer);
  /// Writes each filter's last step.
  void finish() const;
  /// Of all steps, the filters side by side; to be asked for once, and only if there is to be one.
  std::string gif();

 private:
  struct Reel {
    std::string filter;
    std::vector<GridPoint> path;
    Film film;
    cv::Mat last;
    std::int64_t last_step = 0;
  };
  Reel& reel_of(const std::string& filter);
  bool chosen(std::int64_t step) const;
  void write(const Reel& reel, const cv::Mat& picture, std::int64_t step) const;

  const MapView& map_;
  Footprint footprint_;
  FlightPictureOptions options_;
  Backdrop backdrop_;
  std::vector<Reel> reels_;  ///< in the order in which the filters came
};

}  // namespace roadfix::fly
