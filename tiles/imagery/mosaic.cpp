#include "tiles/imagery/mosaic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "core/detect/blank_ground.hpp"
#include "core/detect/orthoimage.hpp"
#include "core/units/error.hpp"
#include "tiles/imagery/band_notes.hpp"
#include "tiles/imagery/collar.hpp"
#include "tiles/imagery/georeference.hpp"
#include "tiles/imagery/picture_range.hpp"
#include "tiles/imagery/share_range.hpp"
#include "tiles/imagery/warp.hpp"
#include "tiles/sources/exported_roads.hpp"

namespace roadfix {
namespace {

constexpr std::size_t kIdleHandles = 48;
constexpr double kReachedPixels = 2.0;  // beyond an image, at most
constexpr ValueRange kExportedBytes{0.0, 254.0};
/// Windows one above the other that are read at a time by all threads together, or soon again.
constexpr double kHeightsKept = 6.0;

/// What an image holds, as far as those of one source have to agree.
struct Content {
  explicit Content(const RasterFile& file)
      : path(file.path()),
        channels(file.channels()),
        integers(file.holds_integers()),
        bytes(file.declared_range().has_value()),
        like_heights(looks_like_heights(file)) {}

  std::string_view values() const {
    if (!integers) return "real numbers";
    return bytes ? "bytes" : "integers of more than 8 bits";
  }

  std::string path;
  int channels;
  bool integers;
  bool bytes;
  bool like_heights;
};

/// One range of values serves them all.
void require_same_values(const Content& first, const Content& other) {
  if (first.values() == other.values()) return;
  throw InvalidInput("road-values-mixed",
                     fmt::format("{} holds {}, but {} holds {}: the value of a certain road differs. Ingest them one "
                                 "by one, as separate sources",
                                 first.path, first.values(), other.path, other.values()));
}

/// A model of heights beside an orthophoto would hide it, as the first by name.
void require_no_heights_beside_colours(const Content& first, const Content& other) {
  for (const auto& [heights, colours] : {std::pair{&first, &other}, {&other, &first}}) {
    if (!heights->like_heights || colours->channels < 3) continue;
    throw InvalidInput("imagery-mixed",
                       fmt::format("{} has colours, but {} has one band of real numbers, as heights have: ingest the "
                                   "orthophoto itself; if both are imagery, one by one",
                                   colours->path, heights->path));
  }
}

/// Within the picture that it is a part of.
cv::Rect place_in_view(const GroundImage& part) {
  cv::Size whole;
  cv::Point corner;
  part.observed.locateROI(whole, corner);
  return {corner, part.observed.size()};
}

double bytes_of_rows(const RasterFile& file, double rows) {
  GDALDataset& dataset = file.dataset();
  const int bytes = GDALGetDataTypeSizeBytes(dataset.GetRasterBand(1)->GetRasterDataType());
  return std::min<double>(rows, file.size().height) * file.size().width * dataset.GetRasterCount() * bytes;
}

}  // namespace

struct Mosaic::Image {
  /// Whether it may hold something there.
  bool touches(const GridBox& box) const {
    return footprint.overlaps(box) &&
           std::ranges::any_of(parts, [&](const GridBox& part) { return part.overlaps(box); });
  }

  Content content;
  GridBox footprint;
  std::vector<GridBox> parts;
  double gsd_m = 0.0;
  std::optional<ValueRange> declared;
  AlphaScale opacity = {};
  SampledShares sampled = {};
  bool exported = false;
  ValueRange range = {};
  std::shared_ptr<const Collar> collar = nullptr;
};

struct Mosaic::Handle {
  Handle(std::size_t image_index, std::shared_ptr<RasterFile> raster, UtmZone zone)
      : image(image_index), file(std::move(raster)), georeference(*file, zone) {}
  std::size_t image;
  std::shared_ptr<RasterFile> file;
  Georeference georeference;
};

Mosaic::Mosaic(const std::vector<std::string>& paths, const RasterOptions& options, ValueRule rule, UtmZone zone)
    : options_(options), rule_(rule), zone_(zone), gsd_m_(std::numeric_limits<double>::infinity()) {
  ThinnedValues values;
  for (const std::string& path : paths) add_image(path, values);
  choose_ranges(std::move(values).take());
  if (rule == ValueRule::kShare) channels_ = 1;
  if (rule == ValueRule::kPicture || options.collar) find_collars();
}

/// Adds to `values` what is sampled of an image whose type does not say its range.
void Mosaic::add_image(const std::string& path, ThinnedValues& values) {
  RasterFile file(path, options_);
  Content content(file);
  if (!images_.empty()) {
    const Content& first = images_.front().content;
    rule_ == ValueRule::kShare ? require_same_values(first, content)
                               : require_no_heights_beside_colours(first, content);
  }
  const Georeference georeference(file, zone_);
  Image image{std::move(content),
              georeference.footprint(),
              georeference.boxes_of_parts(),
              georeference.gsd_m(),
              rule_ == ValueRule::kPicture ? file.declared_range() : std::nullopt,
              file.opacity()};
  extent_ = united(extent_, image.footprint);
  gsd_m_ = std::min(gsd_m_, image.gsd_m);
  channels_ = std::max(channels_, image.content.channels);
  integers_ = integers_ || image.content.integers;
  if (images_.empty()) crs_ = crs_name(file.crs());
  PositionErrors errors = roadfix::position_errors(file, zone_);
  if (errors.placing.sigma_m > position_errors_.placing.sigma_m) position_errors_.placing = std::move(errors.placing);
  if (errors.datum.sigma_m > position_errors_.datum.sigma_m) position_errors_.datum = std::move(errors.datum);
  told_.push_back(provenance_in(file.dataset()));
  image.exported = holds_exported_roads(file.dataset());
  exported_ = exported_ && image.exported;
  if (rule_ == ValueRule::kPicture) notes_.add(file);
  if (!image.declared) {
    const std::vector<float> sample = file.sample_values();
    image.sampled = sampled_shares(sample);
    values.add(rule_ == ValueRule::kPicture ? without_fill(sample) : telling_values(sample));
    if (rule_ == ValueRule::kShare && look_beyond_samples(file, image.sampled)) values.add({image.sampled.max});
  }
  images_.push_back(std::move(image));
}

void Mosaic::choose_ranges(std::vector<float> values) {
  // Beside graded shares a value of 1 is next to nothing, beside masks of 0 and 255 it is another mask's road.
  const bool masks = rule_ == ValueRule::kShare && integers_ &&
                     std::ranges::all_of(images_, [](const Image& image) { return image.sampled.mask; });
  share_values_ = {.integers = integers_, .bytes = images_.front().content.bytes};
  if (rule_ == ValueRule::kShare && (channels_ == 1 || !integers_) && !values.empty()) {
    const auto [min, max] = std::ranges::minmax_element(values);
    share_values_.seen = {static_cast<double>(*min), static_cast<double>(*max)};
    share_values_.ones_only = integers_ && !masks && are_ones_only(values, *max);
  }
  const bool all_declared = std::ranges::all_of(images_, [](const Image& image) { return image.declared.has_value(); });
  if (all_declared) {
    range_ = *images_.front().declared;
  } else {
    range_ = rule_ == ValueRule::kPicture ? percentile_range(std::move(values)) : share_range(values, integers_);
  }
  const auto exact = [&](const Image& image) {
    return rule_ == ValueRule::kShare && image.exported && image.content.bytes;
  };
  if (std::ranges::all_of(images_, exact)) range_ = kExportedBytes;
  for (Image& image : images_) {
    image.range = image.declared.value_or(range_);
    if (masks && image.sampled.max == 1.0F) image.range = {0.0, 1.0};
    if (exact(image)) image.range = kExportedBytes;
    image.range.shares = rule_ == ValueRule::kShare;
  }
}

void Mosaic::find_collars() {
  for (Image& image : images_) {
    RasterFile file(image.content.path, options_);
    const std::optional<Rgb> colour = options_.collar ? options_.collar : find_collar(file, image.range);
    if (colour) image.collar = std::make_shared<Collar>(file, *colour, image.range);
  }
}

Mosaic::~Mosaic() = default;

Provenance Mosaic::told() const {
  Provenance all = combined(told_);
  if (std::ranges::any_of(told_, [](const Provenance& one) { return one.registration_sigma_m == 0.0; })) {
    all.registration_sigma_m = 0.0;
  }
  return all;
}

bool Mosaic::touches(const GridBox& box) const {
  return std::ranges::any_of(images_, [&](const Image& image) { return image.touches(box); });
}

GroundImage Mosaic::view(const GridBox& box, double gsd_m) const {
  const cv::Size size(static_cast<int>(std::lround(box.width_m() / gsd_m)),
                      static_cast<int>(std::lround(box.height_m() / gsd_m)));
  GroundImage result{cv::Mat(size, CV_8UC(channels_), cv::Scalar::all(0)), cv::Mat(size, CV_8UC1, cv::Scalar(0)),
                     gsd_m};
  for (std::size_t i = 0; i < images_.size(); ++i) {
    if (!images_[i].touches(box)) continue;
    std::unique_ptr<Handle> handle = borrow(i, box, gsd_m);
    const Orthoimage all{result, {box.min.east_m, box.max.north_m}};
    Orthoimage part = part_within(all, grown(images_[i].footprint, kReachedPixels * gsd_m));
    warp_into({*handle->file, handle->georeference, images_[i].range, images_[i].collar.get()}, part.box(), part.image);
    give_back(std::move(handle));
    if (rule_ == ValueRule::kPicture) exclude_blank(result, place_in_view(part.image));
  }
  return result;
}

std::shared_ptr<RasterFile> Mosaic::open(const Image& image, double gsd_m) const {
  auto file = std::make_shared<RasterFile>(image.content.path, options_);
  const std::optional<int> overview = file->overview_for(gsd_m / image.gsd_m);
  // The collar was judged on the pixels of the full image, and its windows are in them.
  if (overview && !image.collar) file = std::make_shared<RasterFile>(image.content.path, options_, overview);
  file->set_opacity(image.opacity);
  return file;
}

std::unique_ptr<Mosaic::Handle> Mosaic::borrow(std::size_t image, const GridBox& box, double gsd_m) const {
  std::shared_ptr<RasterFile> file;
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find_if(idle_, [&](const auto& handle) { return handle->image == image; });
    if (found != idle_.end()) {
      std::unique_ptr<Handle> handle = std::move(*found);
      idle_.erase(found);
      return handle;
    }
    if (const auto known = by_turns_.find(image); known != by_turns_.end()) file = known->second.lock();
  }
  if (!file) file = open(images_[image], gsd_m);
  if (file->unpacks_from_the_top()) {
    const std::lock_guard lock(mutex_);
    std::weak_ptr<RasterFile>& known = by_turns_[image];
    if (const auto other = known.lock()) {
      file = other;
    } else {
      known = file;
      keep_in_cache(bytes_of_rows(*file, kHeightsKept * box.height_m() / images_[image].gsd_m));
    }
  }
  const auto turn = file->take_turn();  // the georeference is read from the file
  return std::make_unique<Handle>(image, file, zone_);
}

void Mosaic::give_back(std::unique_ptr<Handle> handle) const {
  std::unique_ptr<Handle> oldest;  // closed outside the lock
  const std::lock_guard lock(mutex_);
  idle_.push_front(std::move(handle));
  if (idle_.size() <= kIdleHandles) return;
  oldest = std::move(idle_.back());
  idle_.pop_back();
}

}  // namespace roadfix
