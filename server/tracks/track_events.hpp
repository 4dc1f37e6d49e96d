// Hands the steps of tracks out to those who listen to them.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "server/tracks/track_store.hpp"

namespace roadfix::server {

class TrackEvents {
 public:
  struct News {
    std::vector<StoredStep> steps;
    std::optional<TrackEnd> ended;  ///< as StoredTrack::ended
  };
  /// What is stored of a track: whether it has ended, asked first, and up to `count` steps above the sequence number.
  using Source = std::function<News(const std::string& id, std::int64_t after, int count)>;
  /// Ends a track in the store, and returns its steps above the sequence number; none without one.
  using EndInStore = std::function<std::vector<StoredStep>(std::optional<std::int64_t> after)>;

  /// At most so many streams at the same time.
  TrackEvents(int most, Source source);

  /// One stream for as long as it lives, which must not be longer than this. Throws Busy.
  class Subscription;
  std::shared_ptr<Subscription> stream(const std::string& id, std::int64_t after);
  int streams() const;

  /// Of a step that is in the store.
  void announce();
  /// The steps that go from the store are kept for the streams that were not told of them.
  void end(const std::string& id, const EndInStore& end_in_store);
  /// Ends the streams.
  void stop();

 private:
  const int most_;
  const Source source_;
  /// Of what follows, and of what `end` tells streams; never held while the source is asked.
  mutable std::mutex mutex_;
  std::condition_variable news_;
  std::uint64_t changes_ = 0;
  std::set<Subscription*> streams_;
  bool stopping_ = false;
};

class TrackEvents::Subscription {
 public:
  /// Holding the mutex of `events`.
  Subscription(TrackEvents& events, std::string id, std::int64_t after);
  ~Subscription();
  Subscription(const Subscription&) = delete;
  Subscription& operator=(const Subscription&) = delete;

  /// What was not handed out yet; waits for some, but not long. nullopt when the service stops.
  std::optional<News> next();

 private:
  friend class TrackEvents;
  using Steps = std::vector<StoredStep>;

  TrackEvents& events_;
  const std::string id_;
  std::int64_t after_;                      ///< sequence number of what was handed out last
  std::shared_ptr<const Steps> left_ = {};  ///< by the track that ended: what may not have been handed out yet
};

}  // namespace roadfix::server
