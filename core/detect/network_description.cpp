#include "core/detect/network_description.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "core/units/names_once.hpp"

namespace roadfix {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& what) {
  throw InvalidInput("model-description",
                     fmt::format("The network's description: {}. models/README.md lists its fields.", what));
}

const json& field(const json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end()) refuse(fmt::format("\"{}\" is missing", name));
  return *found;
}

double number_in(const json& value, const char* name, double min, double max) {
  if (!value.is_number()) refuse(fmt::format("\"{}\" must be a number", name));
  const double number = value.get<double>();
  if (!(number >= min && number <= max))
    refuse(fmt::format("\"{}\" = {} lies outside {} to {}", name, number, min, max));
  return number;
}

int integer_in(const json& object, const char* name, int min, int max) {
  const double number = number_in(field(object, name), name, min, max);
  if (number != std::floor(number)) refuse(fmt::format("\"{}\" must be a whole number", name));
  return static_cast<int>(number);
}

std::string text_of(const json& object, const char* name) {
  const json& value = field(object, name);
  if (!value.is_string()) refuse(fmt::format("\"{}\" must be a string", name));
  return value.get<std::string>();
}

bool first_of(const json& object, const char* name, std::string_view first, std::string_view second) {
  const std::string text = text_of(object, name);
  if (text != first && text != second) refuse(fmt::format("\"{}\" must be \"{}\" or \"{}\"", name, first, second));
  return text == first;
}

std::array<double, 3> three(const json& object, const char* name, double min, double max) {
  const json& values = field(object, name);
  if (!values.is_array() || values.size() != 3) refuse(fmt::format("\"{}\" must be three numbers", name));
  std::array<double, 3> result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = number_in(values[i], name, min, max);
  return result;
}

LocalContrast local_contrast_of(const json& value) {
  if (!value.is_object()) refuse("\"local_contrast\" must be an object");
  const LocalContrast local{integer_in(value, "window_px", 3, 1023),
                            number_in(field(value, "floor"), "floor", 1e-3, 255.0)};
  if (local.window_px % 2 == 0) refuse("\"window_px\" must be odd");
  return local;
}

void check_tiles(const NetworkDescription& network) {
  if (network.multiple % network.stride != 0) refuse("\"multiple\" must be a multiple of \"stride\"");
  if (network.tile_px % network.multiple != 0 || network.overlap_px % network.multiple != 0) {
    refuse("\"tile_px\" and \"overlap_px\" must be multiples of \"multiple\"");
  }
  if (2 * network.overlap_px > network.tile_px) refuse("\"overlap_px\" must be at most half of \"tile_px\"");
}

json parsed(std::string_view text) {
  try {
    return parse_with_names_once(text,
                                 [](const std::string& name) { refuse(fmt::format("\"{}\" is given twice", name)); });
  } catch (const json::exception&) {
    return {};
  }
}

}  // namespace

NetworkDescription parse_network_description(std::string_view text) {
  const json object = parsed(text);
  if (!object.is_object()) refuse("it is not a JSON object");
  NetworkDescription network;
  network.name = text_of(object, "name");
  network.gsd_m = number_in(field(object, "gsd_m"), "gsd_m", 0.01, 100.0);
  network.stride = integer_in(object, "stride", 1, 64);
  network.multiple = integer_in(object, "multiple", 1, 256);
  network.tile_px = integer_in(object, "tile_px", 16, 4096);
  network.overlap_px = integer_in(object, "overlap_px", 0, 2048);
  network.rgb = first_of(object, "channels", "rgb", "bgr");
  if (object.contains("local_contrast")) network.local_contrast = local_contrast_of(object["local_contrast"]);
  network.mean = three(object, "mean", 0.0, 255.0);
  network.std = three(object, "std", 1e-3, 1e6);
  network.logits = first_of(object, "output", "logits", "probability");
  const json& calibration = field(object, "calibration");
  if (!calibration.is_object()) refuse("\"calibration\" must be an object");
  network.calibration_scale = number_in(field(calibration, "scale"), "scale", 0.01, 100.0);
  network.calibration_bias = number_in(field(calibration, "bias"), "bias", -50.0, 50.0);
  if (object.contains("fnv1a64")) network.fnv1a64 = text_of(object, "fnv1a64");
  check_tiles(network);
  return network;
}

NetworkDescription read_network_description(const std::filesystem::path& model) {
  const auto path = std::filesystem::path(model).replace_extension(".json");
  const auto text = read_file(path);
  if (!text) refuse(fmt::format("{} cannot be read; it must lie beside {}", path.string(), model.filename().string()));
  return parse_network_description(*text);
}

}  // namespace roadfix
