// A town, its service, which follows one track of a client at a time, and what /openapi.json says of it.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/e2e/service_fixture.hpp"
#include "tests/e2e/tile_at.hpp"
#include "tests/support/json_schema.hpp"

namespace roadfix::testing {

class DescribedService : public ::testing::Test {
 protected:
  DescribedService() {
    write_map_file(folder_ / "town.gpkg", town_.roads, 2.0);
    service_.emplace(folder_.path(), std::vector<std::string>{"--max-client-tracks", "1", "--request-time", "600"});
    client_.emplace(client_of(*service_));
    document_ = json_of(client_->Get("/openapi.json"));
  }

  const nlohmann::json& resolved(const nlohmann::json& node) const { return testing::resolved(document_, node); }

  /// What the document says of an answer.
  const nlohmann::json& response(const std::string& operation_id, int status) const {
    for (const auto& [path, item] : document_.at("paths").items()) {
      for (const auto& [method, operation] : item.items()) {
        if (method == "parameters" || operation.at("operationId") != operation_id) continue;
        const nlohmann::json& responses = operation.at("responses");
        const std::string key = std::to_string(status);
        return resolved(responses.contains(key) ? responses[key] : responses.at("default"));
      }
    }
    throw std::runtime_error("no operation " + operation_id);
  }

  /// "lat=37.1&lon=38.2" of where the vehicle is.
  std::string place() const {
    return "lat=" + std::to_string(town_.place.lat_deg) + "&lon=" + std::to_string(town_.place.lon_deg);
  }
  std::string tile() const { return tile_at(town_.place); }
  /// What is seen where no road is.
  static std::string nothing() { return text_of(encode_feature_map(CellArray(128, 128, kNoRoad))); }

  const Town town_;
  const TemporaryFolder folder_;
  std::optional<ServiceProcess> service_;
  std::optional<httplib::Client> client_;
  nlohmann::json document_;
};

}  // namespace roadfix::testing
