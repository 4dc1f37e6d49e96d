#include "core/locate/recent_frames.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "core/units/error.hpp"
#include "core/units/words.hpp"

namespace roadfix {
namespace {

using Frame = RecentFrames::Frame;

constexpr std::uint64_t kMagic = 0x3130'4646'4652ULL;  // "RFFF01"
constexpr double kMaxCombinedCells = 16e6;             // more than frames make that may be kept

double slip_m(const Frame& frame) {
  const double arm = 0.5 * frame.placed.features.side_m();
  return std::sqrt(frame.position_m2 + arm * arm * frame.turn_rad2);
}

bool is_near_enough(const Frame& frame) {
  return slip_m(frame) <= RecentFrames::kMaxSlipM &&
         distance_m(frame.placed.offset) <= RecentFrames::kMaxSides * frame.placed.features.side_m();
}

bool is_small_enough(const FeatureMap& features) {
  return std::max(features.cells.cols(), features.cells.rows()) <= RecentFrames::kMaxAcross &&
         features.off_nadir_cells() <= RecentFrames::kMaxAcross;
}

/// The same place from where the vehicle is after `step`.
BodyOffset seen_after(const Odometry& step, const BodyOffset& before) {
  return offset_from(moved({}, step), moved({}, before));
}

[[noreturn]] void refuse(const char* what) {
  throw CorruptData("track-frames-corrupt",
                    std::string("the stored frames of a track ") + what + ": delete the track and begin a new one");
}

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}

  std::uint64_t word() { return word_at(take(kWordBytes), 0); }
  double number() {
    const auto value = std::bit_cast<double>(word());
    if (!std::isfinite(value)) refuse("hold what is no number");
    return value;
  }
  std::span<const std::byte> take(std::size_t count) {
    if (rest_.size() < count) refuse("are not whole");
    const auto taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  bool at_end() const { return rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
};

void put(std::vector<std::byte>& bytes, const Frame& frame) {
  const FeatureMap& features = frame.placed.features;
  const BodyOffset& offset = frame.placed.offset;
  put_word(bytes, static_cast<std::uint64_t>(features.cells.cols()));
  put_word(bytes, static_cast<std::uint64_t>(features.cells.rows()));
  for (const double value : {features.cell_m, features.nadir.col, features.nadir.row, offset.forward_m, offset.right_m,
                             offset.turn.radians(), frame.position_m2, frame.turn_rad2}) {
    put_word(bytes, std::bit_cast<std::uint64_t>(value));
  }
  const auto cells = std::as_bytes(features.cells.cells());
  bytes.insert(bytes.end(), cells.begin(), cells.end());
}

Frame read_frame(Reader& reader) {
  const std::uint64_t cols = reader.word();
  const std::uint64_t rows = reader.word();
  if (cols == 0 || rows == 0 || std::max(cols, rows) > RecentFrames::kMaxAcross) refuse("have a size that none has");
  Frame frame;
  FeatureMap& features = frame.placed.features;
  features.cells = CellArray(static_cast<int>(cols), static_cast<int>(rows));
  features.cell_m = reader.number();
  features.nadir.col = reader.number();
  features.nadir.row = reader.number();
  frame.placed.offset.forward_m = reader.number();
  frame.placed.offset.right_m = reader.number();
  frame.placed.offset.turn = Angle::radians(reader.number());
  frame.position_m2 = reader.number();
  frame.turn_rad2 = reader.number();
  std::ranges::copy(reader.take(cols * rows), std::as_writable_bytes(features.cells.cells()).begin());
  if (!(features.cell_m > 0.0 && frame.position_m2 >= 0.0 && frame.turn_rad2 >= 0.0 && is_near_enough(frame) &&
        is_small_enough(features))) {
    refuse("hold values that none has");
  }
  return frame;
}

}  // namespace

void RecentFrames::move(const Odometry& odometry, const OdometryCovariance& covariance) {
  for (Frame& frame : frames_) {
    BodyOffset& offset = frame.placed.offset;
    offset = seen_after(odometry, offset);
    const double arm = distance_m(offset);
    frame.position_m2 += std::max(covariance[0][0], covariance[1][1]) + arm * arm * covariance[2][2];
    frame.turn_rad2 += covariance[2][2];
  }
  std::erase_if(frames_, [](const Frame& frame) { return !is_near_enough(frame); });
}

void RecentFrames::keep(const FeatureMap& features) {
  if (!is_small_enough(features)) return;
  if (!frames_.empty() && frames_.front().placed.features.cell_m != features.cell_m) frames_.clear();
  const double apart_m = kApartShare * features.cell_m * std::min(features.cells.cols(), features.cells.rows());
  const auto shows_the_same = [&](const Frame& kept) { return distance_m(kept.placed.offset) < apart_m; };
  if (std::ranges::any_of(frames_, shows_the_same)) return;
  frames_.push_back({{features, {}}, 0.0, 0.0});
  std::size_t sum = 0;
  std::size_t count = 0;
  for (auto frame = frames_.rbegin(); frame != frames_.rend() && count < kMaxFrames; ++frame, ++count) {
    sum += frame->placed.features.cells.cells().size();
    if (sum > kMaxCells) break;
  }
  frames_.erase(frames_.begin(), frames_.end() - static_cast<std::ptrdiff_t>(count));
}

FeatureMap RecentFrames::laid_around(const FeatureMap& features) const {
  if (!is_small_enough(features)) return features;
  std::vector<PlacedFeatures> parts{{features, {}}};
  for (const Frame& frame : frames_) {
    if (frame.placed.features.cell_m == features.cell_m) parts.push_back(frame.placed);
  }
  return parts.size() == 1 ? features : combined(parts, kMaxCombinedCells);
}

std::vector<std::byte> RecentFrames::to_bytes() const {
  if (frames_.empty()) return {};
  std::vector<std::byte> bytes;
  put_word(bytes, kMagic);
  put_word(bytes, frames_.size());
  for (const Frame& frame : frames_) put(bytes, frame);
  return bytes;
}

RecentFrames RecentFrames::of_bytes(std::span<const std::byte> bytes) {
  RecentFrames result;
  if (bytes.empty()) return result;
  Reader reader(bytes);
  if (reader.word() != kMagic) refuse("are of no known version");
  const std::uint64_t count = reader.word();
  if (count == 0 || count > kMaxFrames) refuse("are more or fewer than any track has");
  for (std::uint64_t i = 0; i < count; ++i) result.frames_.push_back(read_frame(reader));
  if (!reader.at_end()) refuse("go on beyond their end");
  const double cell_m = result.frames_.front().placed.features.cell_m;
  if (!std::ranges::all_of(result.frames_, [&](const Frame& f) { return f.placed.features.cell_m == cell_m; })) {
    refuse("have cells of several sizes");
  }
  return result;
}

}  // namespace roadfix
