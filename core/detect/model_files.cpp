#include "core/detect/model_files.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "core/units/error.hpp"

namespace roadfix {

namespace fs = std::filesystem;

std::optional<fs::path> default_model() {
  if (const char* named = std::getenv("ROADFIX_MODEL"); named != nullptr && *named != '\0') {
    if (fs::is_regular_file(named)) return named;
    throw InvalidInput("model-missing",
                       fmt::format("The environment's ROADFIX_MODEL names {}, which is no file.", named));
  }
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path beside = program.parent_path().parent_path() / "share/roadfix/models/roadnet.onnx";
  for (const fs::path& path : {beside, fs::path(ROADFIX_INSTALLED_MODELS) / "roadnet.onnx",
                               fs::path(ROADFIX_SOURCE_MODELS) / "roadnet.onnx"}) {
    if (fs::is_regular_file(path, ignored)) return path;
  }
  return std::nullopt;
}

}  // namespace roadfix
