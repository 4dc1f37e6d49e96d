#include "cli/detector_options.hpp"

#include <string>

namespace roadfix::cli {

void add_detector_options(CLI::App& command, DetectorChoice& choice) {
  command.add_option("--detector", choice.name, std::string("Road detector, one of: ") + kDetectorNames)
      ->capture_default_str();
  command.add_option("--model", choice.model, "ONNX file of the neural detector, with its JSON beside it")
      ->type_name("FILE");
  command
      .add_option("--orientations", choice.orientations,
                  "1, 4 or 8: mean over the picture turned and mirrored; slower, better, for maps")
      ->capture_default_str()
      ->check(CLI::IsMember({1, 4, 8}));
}

}  // namespace roadfix::cli
