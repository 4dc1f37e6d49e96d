#include "server/tracks/track_events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "server/http/errors.hpp"

namespace roadfix::server {

TrackEvents::TrackEvents(int most, Source source) : most_(most), source_(std::move(source)) {}

std::shared_ptr<TrackEvents::Subscription> TrackEvents::stream(const std::string& id, std::int64_t after) {
  const std::lock_guard lock(mutex_);
  if (std::ssize(streams_) >= most_) {
    throw http::Busy(fmt::format("{} event streams are open, the most allowed (serve --max-streams)", streams_.size()),
                     std::chrono::seconds(5));
  }
  return std::make_shared<Subscription>(*this, id, after);
}

int TrackEvents::streams() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(streams_.size());
}

void TrackEvents::announce() {
  const std::lock_guard lock(mutex_);
  ++changes_;
  news_.notify_all();
}

void TrackEvents::end(const std::string& id, const EndInStore& end_in_store) {
  const std::lock_guard lock(mutex_);
  std::optional<std::int64_t> told;  // to those who listen to it, at least
  for (const Subscription* stream : streams_) {
    if (stream->id_ == id) told = std::min(told.value_or(stream->after_), stream->after_);
  }
  const auto left = std::make_shared<const Subscription::Steps>(end_in_store(told));
  for (Subscription* stream : streams_) {
    if (stream->id_ == id && !stream->left_) stream->left_ = left;  // it may be ended twice at once
  }
  ++changes_;
  news_.notify_all();
}

void TrackEvents::stop() {
  const std::lock_guard lock(mutex_);
  stopping_ = true;
  news_.notify_all();
}

TrackEvents::Subscription::Subscription(TrackEvents& events, std::string id, std::int64_t after)
    : events_(events), id_(std::move(id)), after_(after) {
  events_.streams_.insert(this);
}

TrackEvents::Subscription::~Subscription() {
  const std::lock_guard lock(events_.mutex_);
  events_.streams_.erase(this);
}

std::optional<TrackEvents::News> TrackEvents::Subscription::next() {
  constexpr int kBatch = 64;
  constexpr std::chrono::seconds kPatience{1};
  std::unique_lock lock(events_.mutex_);
  const std::uint64_t seen = events_.changes_;
  lock.unlock();
  auto [steps, ended] = events_.source_(id_, after_, kBatch);
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
  events_.news_.wait_for(lock, kPatience, [&] { return events_.stopping_ || events_.changes_ != seen; });
  if (events_.stopping_) return std::nullopt;
  return News{};
}

}  // namespace roadfix::server
