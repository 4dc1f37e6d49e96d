#include "server/http/chunk_check.hpp"

#include <algorithm>
#include <utility>

#include "server/http/url.hpp"

namespace roadfix::http {
namespace {

constexpr int kMostDigits = 15;

}  // namespace

bool ChunkCheck::follow(std::string_view bytes) {
  while (!bytes.empty() && part_ != Part::kRest) {
    if (part_ == Part::kData) {
      const std::size_t skipped = std::min(left_, bytes.size());
      left_ -= skipped;
      bytes.remove_prefix(skipped);
      if (left_ == 0) part_ = Part::kDataEnd;
      continue;
    }
    if (!follow_byte(bytes.front())) return false;
    bytes.remove_prefix(1);
  }
  return true;
}

bool ChunkCheck::follow_byte(char byte) {
  switch (part_) {
    case Part::kSize:
      return in_size(byte);
    case Part::kExtension:
      if (byte == '\r') part_ = Part::kSizeEnd;
      return byte != '\n';
    case Part::kSizeEnd:
      part_ = left_ == 0 ? Part::kTrailersOrEnd : Part::kData;
      return byte == '\n';
    case Part::kDataEnd:
      part_ = Part::kDataLineFeed;
      return byte == '\r';
    case Part::kDataLineFeed:
      part_ = Part::kSize;
      return byte == '\n';
    case Part::kTrailersOrEnd:
      part_ = byte == '\r' ? Part::kLastLineFeed : Part::kTrailer;
      return byte != '\n';
    case Part::kTrailer:
      if (byte == '\r') part_ = Part::kTrailerLineFeed;
      return byte != '\n';
    case Part::kTrailerLineFeed:
      part_ = Part::kTrailersOrEnd;
      return byte == '\n';
    case Part::kLastLineFeed:
      part_ = Part::kRest;
      return byte == '\n';
    case Part::kData:
    case Part::kRest:
      break;
  }
  return true;
}

bool ChunkCheck::is_trailer(char next) const {
  return (part_ == Part::kTrailersOrEnd && next != '\r') || part_ == Part::kTrailer || part_ == Part::kTrailerLineFeed;
}

bool ChunkCheck::in_size(char byte) {
  if (const int value = hex_digit(byte); value >= 0) {
    left_ = left_ << 4U | static_cast<std::size_t>(value);
    return ++digits_ <= kMostDigits;
  }
  const bool any = std::exchange(digits_, 0) > 0;
  if (byte == '\r') {
    part_ = Part::kSizeEnd;
  } else {
    part_ = Part::kExtension;
  }
  return any && (byte == '\r' || byte == ';' || byte == ' ' || byte == '\t');
}

}  // namespace roadfix::http
