// What those who listen to a track are told.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "server/http/errors.hpp"
#include "server/tracks/track_registry.hpp"

namespace roadfix::server {

std::shared_ptr<TrackRegistry::Listener> TrackRegistry::stream(const std::string& id, std::int64_t after) {
  find(id);
  const std::lock_guard lock(mutex_);
  if (std::ssize(listeners_) >= limits_.streams) {
    throw http::Busy(
        fmt::format("{} event streams are open, the most allowed (serve --max-streams)", listeners_.size()),
        std::chrono::seconds(5));
  }
  return std::make_shared<Listener>(*this, id, after);
}

TrackRegistry::Listener::Listener(TrackRegistry& registry, std::string id, std::int64_t after)
    : registry_(registry), id_(std::move(id)), after_(after) {
  registry_.listeners_.insert(this);
}

TrackRegistry::Listener::~Listener() {
  const std::lock_guard lock(registry_.mutex_);
  registry_.listeners_.erase(this);
}

std::optional<TrackRegistry::Listener::News> TrackRegistry::Listener::next() {
  constexpr int kBatch = 64;
  constexpr std::chrono::seconds kPatience{1};
  std::unique_lock lock(registry_.mutex_);
  const std::uint64_t seen = registry_.changes_;
  lock.unlock();
  // In this order: of a track that has ended here, what the store no longer has is left below.
  const auto track = registry_.store().find(id_);
  const std::optional<TrackEnd> ended = track ? registry_.ended(*track) : TrackEnd::kFinished;
  Steps steps = registry_.store().steps_after(id_, after_, kBatch);
  lock.lock();
  if (steps.empty() && left_) {
    const auto is_told = [&](const StoredStep& step) { return step.sequence <= after_; };
    const auto begin = std::ranges::partition_point(*left_, is_told);
    steps.assign(begin, begin + std::min<std::ptrdiff_t>(kBatch, left_->end() - begin));
  }
  if (!steps.empty()) {
    after_ = steps.back().sequence;
    return News{std::move(steps), {}};
  }
  if (ended) return News{{}, ended};
  registry_.news_.wait_for(lock, kPatience, [&] { return registry_.stopping_ || registry_.changes_ != seen; });
  if (registry_.stopping_) return std::nullopt;
  return News{};
}

}  // namespace roadfix::server
