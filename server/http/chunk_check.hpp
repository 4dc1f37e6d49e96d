// Follows the framing of a chunked body (RFC 9112 7.1) byte by byte. cpp-httplib reads sizes as "0x3" and ends a body
// at a bare line feed; what it leaves unread would be taken for the next request, which a proxy in front saw as body.
#pragma once

#include <cstddef>
#include <string_view>

namespace roadfix::http {

class ChunkCheck {
 public:
  /// False once these are no chunks. What follows the body is not looked at.
  bool follow(std::string_view bytes);
  /// Whether the next byte is one of the trailers, which may stand between the last chunk and the empty line.
  bool is_trailer(char next) const;

 private:
  enum class Part {
    kSize,
    kExtension,
    kSizeEnd,
    kData,
    kDataEnd,
    kDataLineFeed,
    kTrailersOrEnd,
    kTrailer,
    kTrailerLineFeed,
    kLastLineFeed,
    kRest
  };

  bool follow_byte(char byte);
  bool in_size(char byte);

  Part part_ = Part::kSize;
  int digits_ = 0;
  std::size_t left_ = 0;  ///< of the chunk
};

}  // namespace roadfix::http
