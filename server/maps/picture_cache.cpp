#include "server/maps/picture_cache.hpp"

namespace roadfix::server {

std::optional<std::string> PictureCache::find(const std::string& key) {
  const std::lock_guard lock(mutex_);
  const auto found = index_.find(key);
  if (found == index_.end()) return std::nullopt;
  entries_.splice(entries_.begin(), entries_, found->second);
  return found->second->bytes;
}

void PictureCache::keep(const std::string& key, const std::string& bytes) {
  const std::lock_guard lock(mutex_);
  if (index_.contains(key)) return;
  entries_.push_front({key, bytes});
  index_[key] = entries_.begin();
  bytes_ += cost(entries_.front());
  while (bytes_ > capacity_) {
    bytes_ -= cost(entries_.back());
    index_.erase(entries_.back().key);
    entries_.pop_back();
  }
}

std::size_t PictureCache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace roadfix::server
