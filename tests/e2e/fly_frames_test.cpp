// roadfix fly over HTTP, once with roads that the vehicles detect themselves and once with frames in which the service
// does: a rendered town is mapped before and flown over after its earthquake.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/e2e/service_process.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix {
namespace {

using testing::ProgramResult;
using testing::run_program;
using testing::text_of;

using Row = std::vector<std::string>;

/// Without the last column, which is time.
std::vector<Row> rows_of(const std::filesystem::path& csv) {
  std::vector<Row> rows;
  std::istringstream lines(text_of(csv));
  for (std::string line; std::getline(lines, line);) {
    Row& row = rows.emplace_back();
    std::istringstream cells(line.substr(0, line.rfind(',')));
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
  }
  return rows;
}

class FlownOverHttp : public ::testing::Test {
 protected:
  FlownOverHttp() {
    EXPECT_EQ(roadfix("world " + town() + " --size-km 0.7x0.7 --frames 2 --footprint-m 300").code, 0);
    EXPECT_EQ(roadfix("ingest " + town() + "/pre.tif --detector tree --map " + (folder_ / "town.gpkg").string()).code,
              0);
  }

  ProgramResult roadfix(const std::string& arguments) const { return run_program(folder_.path(), arguments); }
  std::string town() const { return (folder_ / "town").string(); }

  /// Two vehicles over what the earthquake left, by a prior of the whole map.
  std::vector<Row> flown(const std::string& options, const std::string& csv) const {
    return flown_over("post.tif --footprint-m 300 --steps 6 --missing 0.2 --runs 2" + options, csv);
  }

  std::vector<Row> flown_over(const std::string& what, const std::string& csv) const {
    const ProgramResult result = roadfix("fly " + (folder_ / "town.gpkg").string() + " --over " + town() + "/" + what +
                                         " --particles 500 --seed 3 --csv " + (folder_ / csv).string());
    EXPECT_EQ(result.code, 0) << result.err;
    return rows_of(folder_ / csv);
  }

  const testing::TemporaryFolder folder_;
};

/// The same frames, as of a camera that looked ahead and to the side through a lens that bends straight lines.
void write_as_of_a_camera(const std::filesystem::path& frames_csv, const std::filesystem::path& camera_csv) {
  std::istringstream lines(text_of(frames_csv));
  std::ofstream camera(camera_csv);
  for (std::string line; std::getline(lines, line);) {
    const bool header = line.starts_with("file,");
    camera << line.substr(0, line.rfind(','))
           << (header ? ",agl_m,focal_px,roll_deg,pitch_deg,principal_px,distortion\n"
                      : ",250,500,2,-10,401 398,-0.1 0.02 0 0.001\n");
  }
}

/// Text that is equal, or numbers that differ by their last digit.
bool alike(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const std::size_t point = a.find('.');
  if (point == std::string::npos || b.find('.') == std::string::npos) return false;
  const double unit = std::pow(10.0, -static_cast<double>(a.size() - point - 1));
  return std::abs(std::stod(a) - std::stod(b)) <= 1.5 * unit;
}

TEST_F(FlownOverHttp, FramesAreAnsweredWithTheNumbersThatTheirRoadsAre) {
  // With time for everything: a loaded machine may take minutes.
  const testing::ServiceProcess service(folder_.path(), {"--request-time", "600", "--tree-roots", "500"});
  const std::string there = " --vehicles 2 --server http://127.0.0.1:" + std::to_string(service.port());
  const std::string tree = " --detector tree --tree-roots 500";
  const std::vector<Row> by_frames = flown(there + " --send frames", "frames.csv");
  EXPECT_EQ(by_frames, flown(there + " --send features" + tree, "features.csv"));

  const std::vector<Row> by_library = flown(tree, "library.csv");
  ASSERT_EQ(by_frames.size(), 13U) << "a header and two flights of six steps";
  ASSERT_EQ(by_library.size(), by_frames.size());
  for (std::size_t i = 0; i < by_frames.size(); ++i) {
    ASSERT_EQ(by_library[i].size(), by_frames[i].size());
    for (std::size_t k = 0; k < by_frames[i].size(); ++k) {
      EXPECT_TRUE(alike(by_library[i][k], by_frames[i][k]))
          << by_frames[0][k] << " of line " << i << ": " << by_library[i][k] << " and " << by_frames[i][k];
    }
  }
}

TEST_F(FlownOverHttp, SaysWhereTheServiceHasAnotherMap) {
  ASSERT_EQ(roadfix("ingest " + town() + "/post.tif --detector tree --map " + (folder_ / "other.gpkg").string()).code,
            0);
  const testing::ServiceProcess service(folder_.path(), {"--request-time", "600"});
  const auto said_of = [&](const std::string& map) {
    const ProgramResult result = roadfix("fly " + (folder_ / "town.gpkg").string() +
                                         " --footprint-m 300 --steps 1 --runs 1 --particles 500 --map " + map +
                                         " --server http://127.0.0.1:" + std::to_string(service.port()));
    EXPECT_EQ(result.code, 0) << result.err;
    return result.err;
  };
  EXPECT_THAT(said_of("other"), ::testing::HasSubstr("town.gpkg is another map (version "));
  EXPECT_THAT(said_of("town"), ::testing::Not(::testing::HasSubstr("another map")));
}

TEST_F(FlownOverHttp, RecordedFramesOfACameraAreAnsweredWithTheNumbersThatTheirRoadsAre) {
  write_as_of_a_camera(town() + "/frames/frames.csv", town() + "/frames/camera.csv");
  const testing::ServiceProcess service(folder_.path(), {"--request-time", "600", "--tree-roots", "500"});
  const std::string there = "frames/camera.csv --server http://127.0.0.1:" + std::to_string(service.port());
  const std::vector<Row> by_frames = flown_over(there + " --send frames", "frames.csv");
  EXPECT_EQ(by_frames.size(), 3U) << "a header and a flight of two steps";
  EXPECT_EQ(by_frames, flown_over(there + " --detector tree --tree-roots 500", "features.csv"));
}

}  // namespace
}  // namespace roadfix
