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
  if (auto installed = first_model({beside, fs::path(ROADFIX_INSTALLED_MODELS) / "roadnet.onnx"})) return installed;
  // Of another user, perhaps, who built this and keeps the sources to himself.
  const fs::path source = fs::path(ROADFIX_SOURCE_MODELS) / "roadnet.onnx";
  return fs::is_regular_file(source, ignored) ? std::optional(source) : std::nullopt;
}

std::optional<fs::path> first_model(const std::vector<fs::path>& places) {
  for (const fs::path& path : places) {
    std::error_code problem;
    const fs::file_status status = fs::status(path, problem);
    if (fs::is_regular_file(status)) return path;
    if (status.type() != fs::file_type::none) continue;
    throw InvalidInput("model-missing",
                       fmt::format("{}: {}. Let everyone read the folders of the installation, name the weights with "
                                   "--model, or use --detector tree.",
                                   path.string(), problem.message()));
  }
  return std::nullopt;
}

}  // namespace roadfix
