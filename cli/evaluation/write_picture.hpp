// Pictures that show what bench and fly did.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>

namespace roadfix::evaluation {

/// In the format that the ending says. Throws IoFailure "result-unwritable".
void write_picture(const std::filesystem::path& file, const cv::Mat& picture);

}  // namespace roadfix::evaluation
