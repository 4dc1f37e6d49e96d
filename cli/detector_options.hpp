// The options by which every command lets its user choose the detector.
#pragma once

#include "cli/command.hpp"
#include "core/detect/make_detector.hpp"

namespace roadfix::cli {

/// Adds --detector, --model, --orientations and the growing tree's --tree-..., which write into `choice`; it must live
/// as long as the command.
/// `usual_orientations`: those without the option, as its help says.
void add_detector_options(CLI::App& command, DetectorChoice& choice, int usual_orientations = 1);

/// What an option of NeuralOptions::orientations may be.
CLI::Validator orientations();

}  // namespace roadfix::cli
