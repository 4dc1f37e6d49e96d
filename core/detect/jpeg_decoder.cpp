#include "core/detect/jpeg_decoder.hpp"

#include <fmt/format.h>

#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>
// Needs size_t and FILE before it.
#include <jpeglib.h>
// Needs jpeglib.h before it.
#include <jerror.h>

#include "core/detect/road_detector.hpp"
#include "core/units/error.hpp"

namespace roadfix {
namespace {

constexpr int kMostScans = 100;  // encoders write about ten; as GDAL

/// What libjpeg's callbacks need. Everything that lives across a longjmp is owned here, outside the frame that jumps.
struct Reader {
  Reader() = default;
  ~Reader() { jpeg_destroy_decompress(&jpeg); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf before{};
  std::array<char, JMSG_LENGTH_MAX> message{};
  cv::Mat pixels;
  cv::Size2l told;
  std::stop_token stop;
};

void say(Reader& reader, const char* why) { std::strncpy(reader.message.data(), why, reader.message.size() - 1); }

[[noreturn]] void on_error(j_common_ptr jpeg) {
  auto& reader = *static_cast<Reader*>(jpeg->client_data);
  jpeg->err->format_message(jpeg, reader.message.data());
  std::longjmp(reader.before, 1);
}

/// Where libjpeg only warns (`level` < 0), it goes on with invented pixels, but for what some cameras write.
void on_message(j_common_ptr jpeg, int level) {
  const int code = jpeg->err->msg_code;
  if (level < 0 && code != JWRN_EXTRANEOUS_DATA && code != JWRN_JFIF_MAJOR) on_error(jpeg);
}

/// Called for every row of blocks of every scan.
void on_progress(j_common_ptr jpeg) {
  auto& reader = *static_cast<Reader*>(jpeg->client_data);
  const bool many = reader.jpeg.input_scan_number > kMostScans;
  if (many) say(reader, "more than 100 scans");
  if (many || reader.stop.stop_requested()) std::longjmp(reader.before, 1);
}

void print_nothing(j_common_ptr) {}

void choose_colours(jpeg_decompress_struct& jpeg) {
  jpeg.out_color_space = jpeg.num_components == 1 ? JCS_GRAYSCALE : jpeg.num_components == 3 ? JCS_EXT_BGR : JCS_CMYK;
}

/// False: reader.message says why. No object with a destructor may live in this frame.
bool read(Reader& reader, std::span<const std::uint8_t> bytes) {
  jpeg_decompress_struct& jpeg = reader.jpeg;
  if (setjmp(reader.before) != 0) return false;
  jpeg_create_decompress(&jpeg);
  jpeg.progress = &reader.progress;
  jpeg_mem_src(&jpeg, bytes.data(), bytes.size());
  jpeg_read_header(&jpeg, TRUE);
  if (reader.told.width != jpeg.image_width || reader.told.height != jpeg.image_height) {
    say(reader, "it has two sizes");
    return false;
  }
  choose_colours(jpeg);
  jpeg_start_decompress(&jpeg);
  reader.pixels.create(static_cast<int>(jpeg.output_height), static_cast<int>(jpeg.output_width),
                       CV_8UC(jpeg.output_components));
  while (jpeg.output_scanline < jpeg.output_height) {
    JSAMPROW row = reader.pixels.ptr(static_cast<int>(jpeg.output_scanline));
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_decompress(&jpeg);
  return true;
}

}  // namespace

cv::Mat decode_jpeg(std::span<const std::uint8_t> bytes, cv::Size2l told, const std::stop_token& stop) {
  Reader reader;
  reader.told = told;
  reader.stop = stop;
  reader.progress.progress_monitor = on_progress;
  reader.jpeg.err = jpeg_std_error(&reader.errors);
  reader.errors.error_exit = on_error;
  reader.errors.emit_message = on_message;
  reader.errors.output_message = print_nothing;
  reader.jpeg.client_data = &reader;
  if (!read(reader, bytes)) {
    require_not_interrupted(stop);
    throw InvalidInput("image-damaged",
                       fmt::format("the JPEG image is damaged or cut off ({})", reader.message.data()));
  }
  if (reader.pixels.channels() > 3) {
    throw InvalidInput("image-format", "the JPEG image has the colours of a printer (CMYK): save it as RGB");
  }
  return reader.pixels;
}

}  // namespace roadfix
