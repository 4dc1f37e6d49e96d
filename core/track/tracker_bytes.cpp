#include "core/track/tracker_bytes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "core/units/error.hpp"

namespace roadfix {
namespace {

using Frame = RecentFrames::Frame;

static_assert(std::endian::native == std::endian::little);
constexpr std::size_t kWordBytes = 8;
constexpr std::uint64_t kMagic = 0x3830'5354'4652ULL;  // "RFTS08"

[[noreturn]] void refuse(const char* why) {
  throw CorruptData("track-store-corrupt",
                    std::string("the stored state of a track ") + why + ": delete the track and begin a new one");
}

// What is stored, in the order of the bytes: `io` writes or reads it. Each list is for both, so that they agree.

void pass_members(auto& io, auto& state) {
  auto& [filter, searched, last, measured, last_search, nadir_sigma_m, claim, accepted_time_us, recent, last_view,
         motion, reach] = state;
  io(searched, last->sequence, last->time_us, measured, last_search, nadir_sigma_m, accepted_time_us);
  io(claim.supported, claim.log_odds, claim.confirmed, claim.looked_time_us, claim.flown_m);
  io(motion.velocity, motion.turn_rate_rad_s, motion.odometry_is_wrong, motion.coasts, motion.coasted_s,
     motion.unseen_m, motion.unseen_s, reach);
  io(last_view.seen, last_view.stands_still, last_view.earlier, last_view.earlier_picture);
  io(filter.seed, filter.step, filter.resets, filter.slow_fit, filter.fast_fit, filter.particles);
  io(recent);
}

void pass_reach(auto& io, auto& reach) {
  io(reach.position.east_m, reach.position.north_m, reach.heading, reach.radius_m, reach.heading_half_width,
     reach.turn_rad2);
}

void pass_frame(auto& io, auto& frame) {
  auto& [features, offset, higher_m] = frame.placed;
  assert(higher_m == 0.0);  // tracks size each frame when it comes
  io(features.cells, features.cell_m, features.nadir.col, features.nadir.row, features.nadir_sigma_m,
     features.nadir_heading_sigma);
  io(offset.forward_m, offset.right_m, offset.turn, frame.position_m2, frame.turn_rad2);
}

void pass_view(auto& io, auto& view) { io(view.digest, view.moved_m, view.turned_rad); }

void pass_picture(auto& io, auto& picture) {
  io(picture.sketch, picture.moved.forward_m, picture.moved.right_m, picture.moved.turn, picture.came_again);
}

auto columns_of(auto& p) {
  return std::array{&p.east_m,          &p.north_m, &p.heading_rad, &p.drift_east_m_s,
                    &p.drift_north_m_s, &p.weight,  &p.log_scale};
}

class Writer {
 public:
  void operator()(const auto&... values) { (put(values), ...); }
  std::vector<std::byte> bytes() && { return std::move(bytes_); }

 private:
  void put(std::span<const std::byte> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
  void put(std::uint64_t word) { put(std::as_bytes(std::span(&word, 1))); }
  void put(std::int64_t number) { put(static_cast<std::uint64_t>(number)); }
  void put(double number) { put(std::bit_cast<std::uint64_t>(number)); }
  void put(bool flag) { put(std::uint64_t{flag}); }
  void put(Angle angle) { put(angle.radians()); }
  void put(const Reach& reach) { pass_reach(*this, reach); }
  void put(const BodyVelocity& velocity) { (*this)(velocity.forward_m_s, velocity.right_m_s); }
  void put(const PictureSketch& sketch) { put(std::as_bytes(std::span(sketch.parts))); }
  void put(const EarlierPicture& picture) { pass_picture(*this, picture); }
  template <typename Value>
  void put(const std::optional<Value>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  void put(const CellArray& cells) {
    (*this)(std::int64_t{cells.cols()}, std::int64_t{cells.rows()}, std::as_bytes(cells.cells()));
  }
  void put(const std::vector<SeenView>& seen) {
    put(std::uint64_t{seen.size()});
    for (const SeenView& view : seen) pass_view(*this, view);
  }
  void put(const RecentFrames& recent) {
    put(std::uint64_t{recent.frames().size()});
    for (const Frame& frame : recent.frames()) pass_frame(*this, frame);
  }
  void put(const Particles& particles) {
    put(std::uint64_t{particles.size()});
    for (const auto* column : columns_of(particles)) put(std::as_bytes(std::span(*column)));
  }

  std::vector<std::byte> bytes_;
};

/// Reserves no memory for more than there are bytes.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}

  void operator()(auto&... values) { (take(values), ...); }
  bool is_at_end() const { return rest_.empty(); }

 private:
  std::span<const std::byte> bytes(std::uint64_t count) {
    if (rest_.size() < count) refuse("is not whole");
    const auto taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  void take(std::uint64_t& word) { std::memcpy(&word, bytes(kWordBytes).data(), kWordBytes); }
  void take(std::int64_t& number) {  // all that are stored are counted up from 0
    number = std::bit_cast<std::int64_t>(taken<std::uint64_t>());
    if (number < 0) refuse("holds a number below 0");
  }
  void take(double& number) {
    number = std::bit_cast<double>(taken<std::uint64_t>());
    if (!std::isfinite(number)) refuse("holds what is no number");
  }
  void take(bool& flag) {
    const auto word = taken<std::uint64_t>();
    if (word > 1) refuse("holds neither yes nor no");
    flag = word == 1;
  }
  void take(Angle& angle) { angle = Angle::radians(taken<double>()); }
  void take(Reach& reach) { pass_reach(*this, reach); }
  void take(BodyVelocity& velocity) { (*this)(velocity.forward_m_s, velocity.right_m_s); }
  void take(PictureSketch& sketch) {
    const auto parts = std::as_writable_bytes(std::span(sketch.parts));
    std::ranges::copy(bytes(parts.size()), parts.begin());
    if (std::ranges::any_of(sketch.parts, [](int part) { return std::abs(part) > 1; })) refuse("has no such sketch");
  }
  void take(EarlierPicture& picture) { pass_picture(*this, picture); }
  template <typename Value>
  void take(std::optional<Value>& value) {
    if (taken<bool>()) value = taken<Value>();
  }
  void take(CellArray& cells) {
    const auto cols = taken<std::int64_t>();
    const auto rows = taken<std::int64_t>();
    if (std::min(cols, rows) == 0 || std::max(cols, rows) > RecentFrames::kMaxAcross) refuse("has frames of no size");
    const auto stored = bytes(static_cast<std::uint64_t>(cols * rows));
    cells = CellArray(static_cast<int>(cols), static_cast<int>(rows));
    std::ranges::copy(stored, std::as_writable_bytes(cells.cells()).begin());
  }
  void take(std::vector<SeenView>& seen) {
    const auto count = taken<std::uint64_t>();
    if (count > LastView::kRemembered) refuse("has seen more views than any track remembers");
    seen.resize(count);
    for (SeenView& view : seen) pass_view(*this, view);
  }
  void take(RecentFrames& recent) {
    const auto count = taken<std::uint64_t>();
    if (count > RecentFrames::kMaxFrames) refuse("has more frames than any track");
    std::vector<Frame> frames(count);
    for (Frame& frame : frames) pass_frame(*this, frame);
    recent = RecentFrames(std::move(frames));
  }
  void take(Particles& particles) {
    const auto columns = columns_of(particles);
    const auto count = taken<std::uint64_t>();
    if (count == 0 || count > rest_.size() / (kWordBytes * columns.size())) refuse("is not whole");
    particles.resize(count);
    for (auto* column : columns) {
      std::memcpy(column->data(), bytes(kWordBytes * count).data(), kWordBytes * count);
      if (!std::ranges::all_of(*column, [](double x) { return std::isfinite(x); })) refuse("holds what is no number");
    }
  }
  template <typename Value>
  Value taken() {
    Value value{};
    take(value);
    return value;
  }

  std::span<const std::byte> rest_;
};

bool is_share(double value) { return value >= 0.0 && value <= 1.0; }

bool is_valid(const FilterState& filter) {
  constexpr double kRounding = 1e-6;  // of weights that sum to 1
  const std::vector<double>& weights = filter.particles.weight;
  return std::ranges::all_of(weights, is_share) &&
         std::abs(std::accumulate(weights.begin(), weights.end(), -1.0)) <= kRounding &&
         std::ranges::all_of(filter.particles.log_scale, [](double s) { return std::abs(s) <= 1.0; }) &&
         filter.slow_fit > 0.0 && is_share(filter.slow_fit) && is_share(filter.fast_fit);
}

bool is_valid(const RecentFrames& recent) {
  return std::ranges::all_of(recent.frames(), [&](const Frame& frame) {
    const FeatureMap& features = frame.placed.features;
    return features.cell_m > 0.0 && features.cell_m == recent.frames().front().placed.features.cell_m &&
           features.nadir_sigma_m >= 0.0 && features.nadir_heading_sigma >= Angle() && frame.position_m2 >= 0.0 &&
           frame.turn_rad2 >= 0.0 && RecentFrames::may_keep(frame);
  });
}

bool is_valid(const TrackClaim& claim) { return claim.supported <= TrackClaim::kMaxSupport && claim.log_odds >= 0.0; }

bool is_valid(const LastView& view) {
  const auto is_valid_view = [](const SeenView& seen) { return seen.moved_m >= 0.0 && seen.turned_rad >= 0.0; };
  return std::ranges::all_of(view.seen, is_valid_view) && view.earlier.frames().size() <= 1 && is_valid(view.earlier);
}

bool is_valid(const Reach& reach) {
  return reach.radius_m >= 0.0 && reach.heading_half_width >= Angle() && reach.turn_rad2 >= 0.0;
}

bool is_valid(const TrackerState& state) {
  return state.measured - 1 <= state.last->sequence && state.last_search <= state.measured &&
         state.nadir_sigma_m >= 0.0 && state.motion.unseen_m >= 0.0 && state.motion.unseen_s >= 0.0 &&
         is_valid(state.claim) && is_valid(state.last_view) && is_valid(state.filter) && is_valid(state.recent) &&
         (!state.reach || is_valid(*state.reach));
}

}  // namespace

std::vector<std::byte> to_bytes(const TrackerState& state) {
  assert(state.last);
  Writer writer;
  writer(kMagic);
  pass_members(writer, state);
  return std::move(writer).bytes();
}

TrackerState tracker_state_of(std::span<const std::byte> bytes) {
  Reader reader(bytes);
  std::uint64_t magic = 0;
  reader(magic);
  if (magic != kMagic) refuse("is of no known version");
  TrackerState state;
  state.last.emplace();
  pass_members(reader, state);
  if (!reader.is_at_end()) refuse("goes on beyond its end");
  if (!is_valid(state)) refuse("holds values that no track has");
  return state;
}

}  // namespace roadfix
