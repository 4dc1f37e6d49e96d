#include "cli/fly/film.hpp"

#include <gif_lib.h>

#include <array>
#include <cassert>
#include <memory>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <utility>

namespace roadfix::fly {
namespace {

// 6 x 7 x 6 shades of red, green and blue.
constexpr int kReds = 6;
constexpr int kGreens = 7;
constexpr int kBlues = 6;

constexpr int kColours = 256;

std::array<GifColorType, kColours> palette() {
  std::array<GifColorType, kColours> colours{};
  const auto shade = [](int step, int steps) { return static_cast<GifByteType>(255 * step / (steps - 1)); };
  for (int i = 0; i < kReds * kGreens * kBlues; ++i) {
    colours[static_cast<std::size_t>(i)] = {shade(i / (kGreens * kBlues), kReds), shade(i / kBlues % kGreens, kGreens),
                                            shade(i % kBlues, kBlues)};
  }
  return colours;
}

/// Ordered dithering: still ground stays still from frame to frame.
int dithered(int value, int steps, int threshold) {
  constexpr int kThresholds = 16;
  const int scaled = value * (steps - 1) * kThresholds + 255 * threshold;
  return std::min(scaled / (255 * kThresholds), steps - 1);
}

cv::Mat indexed(const cv::Mat& picture) {
  constexpr std::array<std::array<int, 4>, 4> kBayer{{{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}}};
  cv::Mat indices(picture.size(), CV_8UC1);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const cv::Vec3b& bgr = picture.at<cv::Vec3b>(y, x);
      const int threshold = kBayer[static_cast<std::size_t>(y % 4)][static_cast<std::size_t>(x % 4)];
      const int red = dithered(bgr[2], kReds, threshold);
      const int green = dithered(bgr[1], kGreens, threshold);
      const int blue = dithered(bgr[0], kBlues, threshold);
      indices.at<uchar>(y, x) = static_cast<uchar>((red * kGreens + green) * kBlues + blue);
    }
  }
  return indices;
}

/// Into memory, where only memory can be wanting.
class Writer {
 public:
  Writer() : gif_(EGifOpen(this, &Writer::put, nullptr)) {
    if (gif_ == nullptr) throw std::bad_alloc();
    EGifSetGifVersion(gif_, true);
  }
  ~Writer() {
    if (gif_ != nullptr) EGifCloseFile(gif_, nullptr);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void start(cv::Size size) {
    const auto colours = palette();
    const std::unique_ptr<ColorMapObject, decltype(&GifFreeMapObject)> map(GifMakeMapObject(kColours, colours.data()),
                                                                           GifFreeMapObject);
    require(EGifPutScreenDesc(gif_, size.width, size.height, 8, 0, map.get()));
    constexpr std::array<unsigned char, 3> kForEver{1, 0, 0};
    require(EGifPutExtensionLeader(gif_, APPLICATION_EXT_FUNC_CODE));
    require(EGifPutExtensionBlock(gif_, 11, "NETSCAPE2.0"));
    require(EGifPutExtensionBlock(gif_, kForEver.size(), kForEver.data()));
    require(EGifPutExtensionTrailer(gif_));
  }

  /// Only the changed part of a picture is written.
  void add(const cv::Mat& frame, const cv::Rect& changed, int hundredths) {
    const GraphicsControlBlock control{DISPOSE_DO_NOT, false, hundredths, NO_TRANSPARENT_COLOR};
    std::array<GifByteType, 4> bytes{};
    EGifGCBToExtension(&control, bytes.data());
    require(EGifPutExtension(gif_, GRAPHICS_EXT_FUNC_CODE, bytes.size(), bytes.data()));
    require(EGifPutImageDesc(gif_, changed.x, changed.y, changed.width, changed.height, false, nullptr));
    cv::Mat part = frame(changed).clone();
    for (int y = 0; y < part.rows; ++y) require(EGifPutLine(gif_, part.ptr(y), part.cols));
  }

  std::string finish() {
    require(EGifCloseFile(std::exchange(gif_, nullptr), nullptr));
    return std::move(bytes_);
  }

 private:
  static int put(GifFileType* gif, const GifByteType* bytes, int count) {
    static_cast<Writer*>(gif->UserData)
        ->bytes_.append(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(count));
    return count;
  }

  static void require(int result) {
    if (result != GIF_OK) throw std::bad_alloc();
  }

  std::string bytes_;
  GifFileType* gif_;
};

cv::Rect changed_part(const cv::Mat& before, const cv::Mat& frame) {
  std::vector<cv::Point> places;
  const cv::Mat different = before != frame;
  cv::findNonZero(different, places);
  if (places.empty()) return {0, 0, 1, 1};
  int left = frame.cols;
  int top = frame.rows;
  int right = 0;
  int bottom = 0;
  for (const cv::Point& p : places) {
    left = std::min(left, p.x);
    right = std::max(right, p.x + 1);
    top = std::min(top, p.y);
    bottom = std::max(bottom, p.y + 1);
  }
  return {left, top, right - left, bottom - top};
}

}  // namespace

/// Shows a film's frames one after the other.
class Film::Player {
 public:
  explicit Player(const Film& film) : film_(film) {}

  /// CV_8UC1, indices of the palette.
  cv::Mat next() {
    const cv::Mat change = cv::imdecode(film_.changes_.at(next_++), cv::IMREAD_GRAYSCALE);
    shown_ = shown_.empty() ? change : cv::Mat(shown_ ^ change);
    return shown_;
  }

 private:
  const Film& film_;
  std::size_t next_ = 0;
  cv::Mat shown_;
};

void Film::add(const cv::Mat& picture) { keep(indexed(picture)); }

void Film::keep(const cv::Mat& indices) {
  assert(last_.empty() || last_.size() == indices.size());
  const cv::Mat change = last_.empty() ? indices : cv::Mat(last_ ^ indices);
  cv::imencode(".png", change, changes_.emplace_back(), {cv::IMWRITE_PNG_COMPRESSION, 1});
  last_ = indices;
}

void Film::append_right(const Film& other) {
  assert(size() == other.size());
  Film both;
  Player left(*this);
  Player right(other);
  for (std::size_t i = 0; i < size(); ++i) {
    cv::Mat beside;
    cv::hconcat(left.next(), right.next(), beside);
    both.keep(beside);
  }
  *this = std::move(both);
}

std::string Film::gif(int frames_per_second) const {
  assert(size() > 0);
  constexpr int kLastHundredths = 200;
  Writer writer;
  writer.start(last_.size());
  Player player(*this);
  cv::Mat before;
  for (std::size_t i = 0; i < size(); ++i) {
    const bool is_last = i + 1 == size();
    const cv::Mat frame = player.next();
    writer.add(frame, i == 0 ? cv::Rect({0, 0}, frame.size()) : changed_part(before, frame),
               is_last ? kLastHundredths : 100 / frames_per_second);
    before = frame;
  }
  return writer.finish();
}

}  // namespace roadfix::fly
