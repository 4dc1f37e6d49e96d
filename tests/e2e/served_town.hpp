// The service with one town, for as long as a test suite lasts.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/e2e/service_fixture.hpp"

namespace roadfix::testing {

class ServedTown : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    town = new Town;
    folder = new TemporaryFolder;
    write_map_file(*folder / "town.gpkg", town->roads, 2.0);
    service = new ServiceProcess(folder->path(), {"--cors-origin", "*", "--request-time", "600"});
  }
  static void TearDownTestSuite() {
    delete service;
    delete folder;
    delete town;
  }

  static std::string window_query(double heading_deg) {
    return "/v1/maps/town/window?lat=" + std::to_string(town->place.lat_deg) +
           "&lon=" + std::to_string(town->place.lon_deg) +
           "&width_m=320&height_m=320&heading_deg=" + std::to_string(heading_deg);
  }

  inline static Town* town = nullptr;
  inline static TemporaryFolder* folder = nullptr;
  inline static ServiceProcess* service = nullptr;
  httplib::Client client_ = client_of(*service);
};

}  // namespace roadfix::testing
