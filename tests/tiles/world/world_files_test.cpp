// The folder of a rendered world, when it is stopped, rendered anew or not to be written.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/units/error.hpp"
#include "tests/tiles/world/small_world.hpp"

namespace roadfix::world {
namespace {

using roadfix::testing::TemporaryFolder;
using testing::bytes_of;
using testing::failure;
using testing::render;
using testing::small_settings;

TEST(WorldFiles, LeavesNoHalfPictureWhenItIsStopped) {
  const TemporaryFolder folder;
  std::stop_source stop;
  const auto stop_after_one = [&](std::int64_t, std::int64_t) { stop.request_stop(); };
  EXPECT_THROW(render_world(small_settings(), folder.path(), stop_after_one, stop.get_token()), Interrupted);
  EXPECT_FALSE(std::filesystem::exists(folder / "post.tif"));
  EXPECT_FALSE(std::filesystem::exists(folder / "post.tif.partial"));
}

TEST(WorldFiles, NeverLeavesPartsOfTwoWorldsWhenItIsStopped) {
  const TemporaryFolder folder;
  const auto stop_at = [&](std::int64_t tile) {
    std::stop_source stop;
    const auto watch = [&](std::int64_t done, std::int64_t) {
      if (done == tile) stop.request_stop();
    };
    EXPECT_THROW(render_world(small_settings(8), folder / "stopped", watch, stop.get_token()), Interrupted);
  };
  const auto missing = [&] {
    std::vector<std::string> names;
    for (const char* name :
         {"pre.tif", "post.tif", "roads.geojson", "frames/frame_01.png", "bench.json", "world.json"}) {
      if (!std::filesystem::exists(folder / "stopped" / name)) names.emplace_back(name);
    }
    return names;
  };
  const auto as_new = [&] {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "new")) {
      if (!entry.is_regular_file()) continue;
      const auto name = std::filesystem::relative(entry.path(), folder / "new");
      EXPECT_EQ(bytes_of(entry.path()), bytes_of(folder / "stopped" / name)) << name;
    }
  };
  render(small_settings(8), folder / "new");
  render(small_settings(7), folder / "stopped");
  EXPECT_THAT(missing(), ::testing::IsEmpty());
  stop_at(1);
  EXPECT_THAT(missing(),
              ::testing::ElementsAre("post.tif", "roads.geojson", "frames/frame_01.png", "bench.json", "world.json"));
  stop_at(2);
  EXPECT_THAT(missing(), ::testing::ElementsAre("frames/frame_01.png", "bench.json", "world.json"));
  render(small_settings(8), folder / "stopped");
  as_new();
}

TEST(WorldFiles, WithoutFramesHasNoManifestOfEarlierOnes) {
  const TemporaryFolder folder;
  WorldSettings settings = small_settings();
  render(settings, folder.path());
  settings.frames = 0;
  render(settings, folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder / "bench.json"));
}

TEST(WorldFiles, KeepsNoFramesOfTheWorldThatWasRenderedThereBefore) {
  const TemporaryFolder folder;
  render(small_settings(), folder.path());
  std::ofstream(folder / "frames" / "frame_of_mine.png") << "not rendered";
  WorldSettings settings = small_settings();
  settings.frames = 1;
  render(settings, folder.path());
  EXPECT_TRUE(std::filesystem::exists(folder / "frames" / "frame_01.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "frames" / "frame_02.png"));
  EXPECT_TRUE(std::filesystem::exists(folder / "frames" / "frame_of_mine.png"));
}

TEST(WorldFiles, SaysSoWhenItCannotBeWritten) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  EXPECT_EQ(failure(small_settings(), folder / "file"), "result-unwritable");
  EXPECT_EQ(failure(small_settings(), ""), "result-unwritable");
  std::ofstream(folder / "frames") << "in the way of the frames";
  EXPECT_EQ(failure(small_settings(), folder.path()), "result-unwritable");
}

}  // namespace
}  // namespace roadfix::world
