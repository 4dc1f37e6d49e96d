#include "core/locate/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/units/json_file.hpp"
#include "schema/schema.hpp"

namespace roadfix {
namespace {

constexpr double kSureByExamples = 0.5;  ///< more only where chance explains nothing
constexpr double kLargestParameter = 1e6;

const JsonFile kFile{"calibration file", "calibration-field", "calibration-json",
                     "write a new one with roadfix bench --calibrate"};

}  // namespace

double Calibration::probability(const SearchFigures& figures) const {
  double sum = bias;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const double figure = figures.*kCountedFigures[i].value;
    if (std::isnan(figure)) return 0.0;
    sum += terms[i].weight * std::min(figure, terms[i].max);
  }
  const double learned = std::min(highest, 1.0 / (1.0 + std::exp(-sum)));
  // By chance exp(-surprise) places fit as well; this is the probability that there is none.
  const double not_by_chance = shares_too_few_roads(figures) ? 0.0 : std::exp(-std::exp(-figures.surprise));
  return std::min(learned, std::max(kSureByExamples, not_by_chance));
}

Calibration parse_calibration(std::string_view text) {
  const nlohmann::json document = parse_json(text, kFile);
  const JsonField root(document, kFile);
  root.at("format").one_of({kCalibrationFormat});
  Calibration calibration;
  calibration.bias = root.at("bias").number(-kLargestParameter, kLargestParameter);
  for (std::size_t i = 0; i < kCountedFigures.size(); ++i) {
    const JsonField term = root.at("terms").at(std::string(kCountedFigures[i].name));
    calibration.terms[i] = {term.at("weight").number(0.0, kLargestParameter),
                            term.at("most").number(-kLargestParameter, kLargestParameter)};
  }
  calibration.highest = root.at("highest").number(0.0, 1.0 - 1e-9);
  const JsonField scale = root.at("sigma_scale");
  calibration.position_sigma_scale = scale.at("position").number(0.1, 100.0);
  calibration.heading_sigma_scale = scale.at("heading").number(0.1, 100.0);
  if (root.has("origin") && !root.at("origin").is_object()) root.at("origin").refuse("must be an object");
  return calibration;
}

std::shared_ptr<const Calibration> shipped_calibration() {
  static const auto kShipped = std::make_shared<const Calibration>(parse_calibration(schema::calibration_json()));
  return kShipped;
}

}  // namespace roadfix
