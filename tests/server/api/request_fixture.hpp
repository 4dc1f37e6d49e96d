// What the tests of requests share.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/detect/road_detector.hpp"
#include "server/api/content.hpp"
#include "server/http/errors.hpp"

namespace roadfix::api {

class NoRoads : public RoadDetector {
 public:
  CellArray detect(const GroundImage&, double, std::uint64_t, const std::stop_token&) const override {
    return {4, 4, kNoRoad};
  }
  double preferred_gsd_m() const override { return 1.0; }
  double halo_m() const override { return 0.0; }
  std::string name() const override { return "none"; }
  std::string settings() const override { return {}; }
};

inline Fields fields_of(nlohmann::json body, const std::vector<std::string>& known) {
  Fields fields;
  fields.add(std::move(body), known);
  return fields;
}

inline void give_picture(Content& content, std::vector<std::uint8_t> bytes) {
  content.decoded = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
  content.image = *content.decoded;
}

/// The complaint and the field that it is about: "missing-parameter lat".
std::string refused(const auto& read) {
  try {
    read();
    return "nothing";
  } catch (const http::InvalidField& error) {
    return error.code() + " " + error.field();
  }
}

}  // namespace roadfix::api
