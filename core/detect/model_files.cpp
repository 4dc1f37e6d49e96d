#include "core/detect/model_files.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "core/units/error.hpp"

namespace roadfix {

namespace fs = std::filesystem;

namespace {

constexpr const char* shipped(SourceContent compared) {
  return compared == SourceContent::kImagery ? "roadnet-imagery.onnx" : "roadnet.onnx";
}

constexpr SourceContent other_than(SourceContent compared) {
  return compared == SourceContent::kImagery ? SourceContent::kRoads : SourceContent::kImagery;
}

std::optional<fs::path> named_by_environment() {
  const char* named = std::getenv("ROADFIX_MODEL");
  return named != nullptr && *named != '\0' ? std::optional<fs::path>(named) : std::nullopt;
}

std::vector<fs::path> shipped_in(const fs::path& folder, SourceContent compared) {
  return {folder / shipped(compared), folder / shipped(other_than(compared))};
}

}  // namespace

std::optional<fs::path> default_model(SourceContent compared) {
  if (auto named = named_by_environment()) {
    if (fs::is_regular_file(*named)) return named;
    throw InvalidInput("model-missing",
                       fmt::format("The environment's ROADFIX_MODEL names {}, which is no file.", named->string()));
  }
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  for (const fs::path& folder :
       {program.parent_path().parent_path() / "share/roadfix/models", fs::path(ROADFIX_INSTALLED_MODELS)}) {
    if (auto installed = first_model(shipped_in(folder, compared))) return installed;
  }
  // Of another user, perhaps, who built this and keeps the sources to himself.
  for (const fs::path& source : shipped_in(ROADFIX_SOURCE_MODELS, compared)) {
    if (fs::is_regular_file(source, ignored)) return source;
  }
  return std::nullopt;
}

std::optional<std::string> stood_in_for(const fs::path& model, SourceContent compared) {
  return model.filename() == shipped(other_than(compared)) ? std::optional<std::string>(shipped(compared))
                                                           : std::nullopt;
}

std::optional<std::string> note_on_missing_network() {
  if (named_by_environment()) return std::nullopt;
  for (const SourceContent compared : {SourceContent::kImagery, SourceContent::kRoads}) {
    const auto model = default_model(compared);
    const auto missing = model ? stood_in_for(*model, compared) : std::nullopt;
    if (!missing) continue;
    return fmt::format("the network {} is missing, and {} reads in its place: fixes are fewer. Put it there", *missing,
                       model->string());
  }
  return std::nullopt;
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
