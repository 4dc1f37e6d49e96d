#include "tiles/export/side_files.hpp"

#include <string>
#include <string_view>
#include <system_error>

#include "core/units/text.hpp"

namespace roadfix {
namespace {

namespace fs = std::filesystem;

bool holds_its_place(std::string_view ending) { return ending == ".tif" || ending == ".tiff" || ending == ".mbtiles"; }

std::string upper_case(std::string text) {
  for (char& c : text) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return text;
}

}  // namespace

fs::path common_world_file(fs::path picture) { return picture.replace_extension(".wld"); }

void remove_side_files(const fs::path& picture) {
  std::error_code none;
  for (const char* suffix : {".ovr", ".aux.xml", ".msk"}) fs::remove(picture.string() + suffix, none);
  const std::string ending = lower_case(picture.extension().string());
  if (!holds_its_place(ending)) fs::remove(common_world_file(picture), none);
  if (ending.size() < 2) return;
  for (const std::string& world : {std::string{'.', ending[1], ending.back(), 'w'}, ending + 'w'}) {  // .pgw, .pngw
    fs::remove(fs::path(picture).replace_extension(world), none);
    fs::remove(fs::path(picture).replace_extension(upper_case(world)), none);
  }
}

}  // namespace roadfix
