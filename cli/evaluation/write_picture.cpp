#include "cli/evaluation/write_picture.hpp"

#include <fmt/format.h>

#include <opencv2/imgcodecs.hpp>

#include "core/units/error.hpp"

namespace roadfix::evaluation {

void write_picture(const std::filesystem::path& file, const cv::Mat& picture) {
  if (cv::imwrite(file.string(), picture)) return;
  throw IoFailure(
      "result-unwritable",
      fmt::format("{} cannot be written: check that its folder may be written to, and is not full", file.string()));
}

}  // namespace roadfix::evaluation
