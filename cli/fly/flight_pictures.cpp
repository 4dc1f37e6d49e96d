#include "cli/fly/flight_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cli/evaluation/write_picture.hpp"

namespace roadfix::fly {
namespace {

constexpr std::size_t kParticles = 3000;

std::string caption_of(const std::string& filter, const Record& record) {
  return fmt::format("step {}   {}   error {:.0f} m   {}   {} particles, {} clusters", record.sequence, filter,
                     record.error_m, record.estimate.converged() ? "converged" : "searching", record.estimate.particles,
                     record.estimate.cluster_count);
}

}  // namespace

FlightPictures::FlightPictures(const MapView& map, const Orthoimage* imagery, const Footprint& footprint,
                               FlightPictureOptions options)
    : map_(map), footprint_(footprint), options_(std::move(options)) {
  if (options_.folder.empty() && options_.film.empty()) return;
  if (options_.steps.empty()) options_.steps = {0, 1, 5, 20, 80};
  backdrop_ = backdrop_of(map, imagery, options_.longest_px);
}

void FlightPictures::show(const std::string& filter, const Record& record, const Localizer& localizer) {
  if (backdrop_.pixels.empty()) return;
  Reel& reel = reel_of(filter);
  reel.path.push_back(record.truth.position);
  Scene scene{caption_of(filter, record), &record, reel.path, {}, footprint_};
  for (const GeoPose& pose : localizer.particles(kParticles)) {
    scene.particles.push_back(on_grid(pose, map_.zone));
  }
  reel.last = drawn(backdrop_, map_.zone, scene);
  reel.last_step = record.sequence;
  if (!options_.film.empty()) reel.film.add(reel.last);
  if (chosen(record.sequence)) write(reel, reel.last, record.sequence);
}

void FlightPictures::finish() const {
  for (const Reel& reel : reels_) {
    if (!chosen(reel.last_step)) write(reel, reel.last, reel.last_step);
  }
}

std::string FlightPictures::gif() {
  Film& film = reels_.front().film;
  for (std::size_t i = 1; i < reels_.size(); ++i) film.append_right(reels_[i].film);
  return film.gif(options_.frames_per_second);
}

FlightPictures::Reel& FlightPictures::reel_of(const std::string& filter) {
  const auto known = std::ranges::find(reels_, filter, &Reel::filter);
  if (known != reels_.end()) return *known;
  reels_.push_back({filter, {}, {}, {}, 0});
  return reels_.back();
}

bool FlightPictures::chosen(std::int64_t step) const {
  return std::ranges::find(options_.steps, static_cast<int>(step)) != options_.steps.end();
}

void FlightPictures::write(const Reel& reel, const cv::Mat& picture, std::int64_t step) const {
  if (options_.folder.empty()) return;
  evaluation::write_picture(fmt::format("{}/{}-{:04}.png", options_.folder, reel.filter, step), picture);
}

}  // namespace roadfix::fly
