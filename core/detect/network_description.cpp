#include "core/detect/network_description.hpp"

#include <fmt/format.h>

#include <vector>

#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "core/units/json_file.hpp"

namespace roadfix {
namespace {

const JsonFile kFile{"network description", "model-description", "model-description",
                     "models/README.md lists its fields"};

int integer_in(const JsonField& root, const char* name, double min, double max) {
  return static_cast<int>(root.at(name).whole_number(min, max));
}

std::array<double, 3> three(const JsonField& field, double min, double max) {
  const std::vector<JsonField> values = field.elements();
  if (values.size() != 3) field.refuse("must be three numbers");
  return {values[0].number(min, max), values[1].number(min, max), values[2].number(min, max)};
}

LocalContrast local_contrast_of(const JsonField& field) {
  field.allow_only({"window_px", "floor"});
  const LocalContrast local{integer_in(field, "window_px", 3, 1023), field.at("floor").number(1e-3, 255.0)};
  if (local.window_px % 2 == 0) field.at("window_px").refuse("must be odd");
  return local;
}

void check_tiles(const NetworkDescription& network, const JsonField& root) {
  if (network.multiple % network.stride != 0) root.at("multiple").refuse("must be a multiple of stride");
  if (network.tile_px % network.multiple != 0 || network.overlap_px % network.multiple != 0) {
    root.at("tile_px").refuse("and overlap_px must be multiples of multiple");
  }
  if (2 * network.overlap_px > network.tile_px) root.at("overlap_px").refuse("must be at most half of tile_px");
}

}  // namespace

NetworkDescription parse_network_description(std::string_view text) {
  const nlohmann::json document = parse_json(text, kFile);
  const JsonField root(document, kFile);
  root.allow_only({"name", "gsd_m", "stride", "multiple", "tile_px", "overlap_px", "channels", "local_contrast", "mean",
                   "std", "output", "calibration", "licence", "fnv1a64"});
  NetworkDescription network;
  network.name = root.at("name").text();
  network.gsd_m = root.at("gsd_m").number(0.01, 100.0);
  network.stride = integer_in(root, "stride", 1, 64);
  network.multiple = integer_in(root, "multiple", 1, 256);
  network.tile_px = integer_in(root, "tile_px", 16, 4096);
  network.overlap_px = integer_in(root, "overlap_px", 0, 2048);
  network.rgb = root.at("channels").one_of({"rgb", "bgr"}) == "rgb";
  if (root.has("local_contrast")) network.local_contrast = local_contrast_of(root.at("local_contrast"));
  network.mean = three(root.at("mean"), 0.0, 255.0);
  network.std = three(root.at("std"), 1e-3, 1e6);
  network.logits = root.at("output").one_of({"logits", "probability"}) == "logits";
  const JsonField calibration = root.at("calibration");
  calibration.allow_only({"scale", "bias"});
  network.calibration_scale = calibration.at("scale").number(0.01, 100.0);
  network.calibration_bias = calibration.at("bias").number(-50.0, 50.0);
  if (root.has("fnv1a64")) network.fnv1a64 = root.at("fnv1a64").text();
  check_tiles(network, root);
  return network;
}

NetworkDescription read_network_description(const std::filesystem::path& model) {
  const auto path = std::filesystem::path(model).replace_extension(".json");
  const auto text = read_file(path);
  if (!text) {
    throw InvalidInput("model-description", fmt::format("{} cannot be read; it must lie beside {}", path.string(),
                                                        model.filename().string()));
  }
  return parse_network_description(*text);
}

}  // namespace roadfix
