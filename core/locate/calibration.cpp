#include "core/locate/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "core/units/error.hpp"
#include "core/units/names_once.hpp"
#include "schema/schema.hpp"

namespace roadfix {
namespace {

using nlohmann::json;

constexpr double kSureByExamples = 0.5;  ///< more only where chance explains nothing

[[noreturn]] void refuse(const std::string& field, const std::string& what) {
  throw InvalidInput("calibration-field", fmt::format("calibration file: {} {}; write a new one with roadfix bench "
                                                      "--calibrate",
                                                      field, what));
}

double number(const json& object, const std::string& key, double low, double high) {
  if (!object.is_object() || !object.contains(key) || !object.at(key).is_number()) refuse(key, "must be a number");
  const auto value = object.at(key).get<double>();
  if (!(value >= low && value <= high)) refuse(key, fmt::format("is {}, not within {} to {}", value, low, high));
  return value;
}

Calibration::Term term(const json& terms, const std::string& name) {
  constexpr double kLargest = 1e6;
  if (!terms.is_object() || !terms.contains(name)) refuse(name, "is missing");
  return {number(terms.at(name), "weight", 0.0, kLargest), number(terms.at(name), "most", -kLargest, kLargest)};
}

json parsed(std::string_view text) {
  try {
    return parse_with_names_once(text, [](const std::string& name) { refuse(name, "is given twice"); });
  } catch (const json::parse_error& error) {
    throw InvalidInput("calibration-json", fmt::format("calibration file: byte {} is no JSON; write a new one with "
                                                       "roadfix bench --calibrate",
                                                       error.byte));
  } catch (const json::out_of_range& error) {
    throw InvalidInput("calibration-json", fmt::format("calibration file: {}; write a new one with roadfix bench "
                                                       "--calibrate",
                                                       error.what()));
  }
}

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
  const bool one_road = !(figures.roads_across >= kMinRoadsAcross);
  const double not_by_chance = one_road ? 0.0 : std::exp(-std::exp(-figures.surprise));
  return std::min(learned, std::max(kSureByExamples, not_by_chance));
}

Calibration parse_calibration(std::string_view text) {
  const json document = parsed(text);
  if (!document.is_object() || document.value("format", json()) != kCalibrationFormat) {
    refuse("format", fmt::format("is not \"{}\"", kCalibrationFormat));
  }
  constexpr double kLargest = 1e6;
  const json terms = document.value("terms", json());
  Calibration calibration;
  calibration.bias = number(document, "bias", -kLargest, kLargest);
  for (std::size_t i = 0; i < kCountedFigures.size(); ++i) {
    calibration.terms[i] = term(terms, std::string(kCountedFigures[i].name));
  }
  calibration.highest = number(document, "highest", 0.0, 1.0 - 1e-9);
  const json scale = document.value("sigma_scale", json());
  calibration.position_sigma_scale = number(scale, "position", 0.1, 100.0);
  calibration.heading_sigma_scale = number(scale, "heading", 0.1, 100.0);
  return calibration;
}

const Calibration& default_calibration() {
  static const Calibration kShipped = parse_calibration(schema::calibration_json());
  return kShipped;
}

}  // namespace roadfix
