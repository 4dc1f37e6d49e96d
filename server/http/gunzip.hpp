// Unpacks gzip (RFC 1952) as it comes: members one after the other, each up to its checksum.
#pragma once

#include <zlib.h>

#include <cstddef>
#include <functional>
#include <string_view>

namespace roadfix::http {

class Gunzip {
 public:
  /// Throws std::bad_alloc.
  Gunzip();
  ~Gunzip();
  Gunzip(const Gunzip&) = delete;
  Gunzip& operator=(const Gunzip&) = delete;

  /// Hands on in pieces what the next bytes of the stream unpack to. False where they are damaged, or once `take` says
  /// so; then it is over.
  bool unpack(std::string_view packed, const std::function<bool(const char*, std::size_t)>& take);
  /// Whether the stream may end here: not within a member.
  bool is_whole() const { return !in_member_; }

 private:
  z_stream stream_{};
  bool in_member_ = false;
};

}  // namespace roadfix::http
