#include "server/http/gunzip.hpp"

#include <array>
#include <new>

namespace roadfix::http {
namespace {

constexpr int kGzipOnly = 16 + MAX_WBITS;  // see inflateInit2() in zlib.h

}  // namespace

Gunzip::Gunzip() {
  if (::inflateInit2(&stream_, kGzipOnly) != Z_OK) throw std::bad_alloc();
}

Gunzip::~Gunzip() { ::inflateEnd(&stream_); }

bool Gunzip::unpack(std::string_view packed, const std::function<bool(const char*, std::size_t)>& take) {
  std::array<Bytef, 16384> buffer;
  stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));  // zlib only reads
  stream_.avail_in = static_cast<uInt>(packed.size());
  stream_.avail_out = 0;
  while (stream_.avail_in > 0 || (in_member_ && stream_.avail_out == 0)) {
    stream_.next_out = buffer.data();
    stream_.avail_out = buffer.size();
    const int result = ::inflate(&stream_, Z_NO_FLUSH);
    in_member_ = result != Z_STREAM_END;
    const bool goes_on = result == Z_OK || (result == Z_BUF_ERROR && stream_.avail_in == 0);
    if (in_member_ && !goes_on) return false;
    const std::size_t unpacked = buffer.size() - stream_.avail_out;
    if (unpacked > 0 && !take(reinterpret_cast<const char*>(buffer.data()), unpacked)) return false;
    if (!in_member_) ::inflateReset(&stream_);
  }
  return true;
}

}  // namespace roadfix::http
