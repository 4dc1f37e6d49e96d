// What a user writes for roadfix bench and fly: any bytes are a manifest, a table of frames, or InvalidInput.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <variant>

#include "cli/bench/manifest.hpp"
#include "cli/evaluation/frames_csv.hpp"
#include "core/detect/frame_camera.hpp"
#include "core/units/error.hpp"

namespace {

void read_manifest(std::string_view text) {
  try {
    const auto manifest = roadfix::bench::parse_manifest(text, ".");
    if (manifest.queries.empty() || manifest.methods.empty()) std::abort();
  } catch (const roadfix::InvalidInput&) {
    return;
  }
}

void read_frames(std::string_view text) {
  try {
    for (const auto& frame : roadfix::evaluation::parse_frames_csv(text)) {
      const auto* camera = std::get_if<roadfix::FrameCamera>(&frame.view);
      const double size_m = camera ? camera->agl_m : std::get<roadfix::StraightDown>(frame.view).gsd_m;
      if (frame.file.empty() || !(size_m >= 0.0)) std::abort();
    }
  } catch (const roadfix::InvalidInput&) {
    return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read_manifest(text);
  read_frames(text);
  return 0;
}
