// What those who listen to a track are told.
#include <utility>

#include "server/tracks/track_registry.hpp"

namespace roadfix::server {

TrackRegistry::Listener::Listener(TrackRegistry& registry, std::string id, std::int64_t after)
    : registry_(registry), id_(std::move(id)), after_(after) {
  ++registry_.streams_;
}

TrackRegistry::Listener::~Listener() {
  const std::lock_guard lock(registry_.mutex_);
  --registry_.streams_;
}

std::optional<TrackRegistry::Listener::News> TrackRegistry::Listener::next() {
  constexpr int kBatch = 64;
  constexpr std::chrono::seconds kPatience{1};
  std::unique_lock lock(registry_.mutex_);
  const std::uint64_t seen = registry_.changes_;
  lock.unlock();
  News news{registry_.store().steps_after(id_, after_, kBatch), {}};
  if (!news.steps.empty()) {
    after_ = news.steps.back().sequence;
    return news;
  }
  const auto track = registry_.store().find(id_);
  news.ended = track ? registry_.ended(*track) : TrackEnd::kFinished;
  if (news.ended) return news;
  lock.lock();
  registry_.news_.wait_for(lock, kPatience, [&] { return registry_.stopping_ || registry_.changes_ != seen; });
  if (registry_.stopping_) return std::nullopt;
  return news;
}

}  // namespace roadfix::server
