#include "core/locate/recent_frames_bytes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "core/units/error.hpp"
#include "core/units/words.hpp"

namespace roadfix {
namespace {

using Frame = RecentFrames::Frame;

constexpr std::uint64_t kMagic = 0x3130'4646'4652ULL;  // "RFFF01"

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
  if (!(features.cell_m > 0.0 && frame.position_m2 >= 0.0 && frame.turn_rad2 >= 0.0 && RecentFrames::may_keep(frame))) {
    refuse("hold values that none has");
  }
  return frame;
}

}  // namespace

std::vector<std::byte> to_bytes(const RecentFrames& recent) {
  if (recent.frames().empty()) return {};
  std::vector<std::byte> bytes;
  put_word(bytes, kMagic);
  put_word(bytes, recent.frames().size());
  for (const Frame& frame : recent.frames()) put(bytes, frame);
  return bytes;
}

RecentFrames recent_frames_of(std::span<const std::byte> bytes) {
  if (bytes.empty()) return {};
  Reader reader(bytes);
  if (reader.word() != kMagic) refuse("are of no known version");
  const std::uint64_t count = reader.word();
  if (count == 0 || count > RecentFrames::kMaxFrames) refuse("are more or fewer than any track has");
  std::vector<Frame> frames;
  for (std::uint64_t i = 0; i < count; ++i) frames.push_back(read_frame(reader));
  if (!reader.at_end()) refuse("go on beyond their end");
  const double cell_m = frames.front().placed.features.cell_m;
  if (!std::ranges::all_of(frames, [&](const Frame& f) { return f.placed.features.cell_m == cell_m; })) {
    refuse("have cells of several sizes");
  }
  return RecentFrames(std::move(frames));
}

}  // namespace roadfix
