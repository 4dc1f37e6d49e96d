#include "server/tracks/track_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/support/as_another_user.hpp"
#include "tests/support/code_of.hpp"
#include "tests/support/map_file.hpp"
#include "tests/support/sqlite_file.hpp"
#include "tests/support/street_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roadfix::server {
namespace {

using roadfix::testing::code_of;
using roadfix::testing::message_of;
using ::testing::HasSubstr;

constexpr std::int64_t kPlenty = std::int64_t{1} << 30;

StoredTrack track(const std::string& id) { return {id, "::1", "{}", {"town", "v1"}, 1, 1, {}}; }

std::vector<std::byte> state(std::size_t bytes) { return std::vector<std::byte>(bytes, std::byte{7}); }

TEST(TrackStore, KeepsTracksAndStepsWhenItIsOpenedAgain) {
  const testing::TemporaryFolder folder;
  {
    TrackStore store(folder / "tracks.sqlite", kPlenty);
    store.add(track("a"));
    store.add(track("b"));
    for (const std::int64_t sequence : {3, 4, 9}) {
      EXPECT_TRUE(store.add_step("a", 10 + sequence, state(100), {sequence, 77, "answer " + std::to_string(sequence)}));
    }
  }
  const TrackStore store(folder / "tracks.sqlite", kPlenty);
  EXPECT_EQ(store.flying().size(), 2U);
  EXPECT_EQ(store.find("a")->touched_us, 19);
  EXPECT_EQ(store.state("a"), state(100));
  EXPECT_TRUE(store.state("b").empty());
  EXPECT_EQ(store.last_step("a")->answer, "answer 9");
  EXPECT_EQ(store.step("a", 4)->answer, "answer 4");
  EXPECT_FALSE(store.step("a", 5));
  EXPECT_EQ(store.steps_after("a", 3, 10).size(), 2U);
  EXPECT_EQ(store.steps_after("a", -1, 1).front().sequence, 3);
}

TEST(TrackStore, ReturnsTheLastStepsOfATrackThatEnds) {
  const testing::TemporaryFolder folder;
  TrackStore store(folder / "tracks.sqlite", kPlenty);
  for (const char* id : {"a", "b"}) {
    store.add(track(id));
    for (const std::int64_t sequence : {3, 4, 9}) {
      ASSERT_TRUE(store.add_step(id, 2, state(100), {sequence, 0, "answer " + std::to_string(sequence)}));
    }
  }
  const std::vector<StoredStep> last = store.end("a", TrackEnd::kFinished, 3);
  ASSERT_EQ(last.size(), 2U);
  EXPECT_EQ(last[0].answer, "answer 4");
  EXPECT_EQ(last[1].sequence, 9);
  EXPECT_TRUE(store.end("b", TrackEnd::kFinished).empty()) << "nobody asked for them";
}

TEST(TrackStore, TakesNoStepOfATrackThatEnded) {
  const testing::TemporaryFolder folder;
  TrackStore store(folder / "tracks.sqlite", kPlenty);
  store.add(track("a"));
  ASSERT_TRUE(store.add_step("a", 2, state(100), {0, 0, "answer"}));
  store.end("a", TrackEnd::kFinished);
  EXPECT_FALSE(store.add_step("a", 3, state(100), {1, 0, "answer"}));
  EXPECT_FALSE(store.last_step("a")) << "its steps went with it";
  EXPECT_TRUE(store.flying().empty());
  EXPECT_EQ(store.find("a")->ended, TrackEnd::kFinished);
}

TEST(TrackStore, KeepsHowATrackEndedFirst) {
  const testing::TemporaryFolder folder;
  TrackStore store(folder / "tracks.sqlite", kPlenty);
  store.add(track("a"));
  store.end("a", TrackEnd::kFinished);
  store.end("a", TrackEnd::kExpired);
  EXPECT_EQ(store.find("a")->ended, TrackEnd::kFinished);
}

TEST(TrackStore, KeepsTheStepsOfATrackThatExpiredUntilItIsForgotten) {
  const testing::TemporaryFolder folder;
  TrackStore store(folder / "tracks.sqlite", kPlenty);
  store.add(track("flown"));
  ASSERT_TRUE(store.add_step("flown", 2, state(100), {0, 0, "answer"}));
  store.end("flown", TrackEnd::kExpired);
  EXPECT_EQ(store.steps_after("flown", -1, 10).size(), 1U);
  EXPECT_TRUE(store.state("flown").empty());
  for (int i = 0; i < 100; ++i) {
    const std::string later = "t" + std::to_string(i);
    EXPECT_TRUE(store.find("flown")) << i;
    store.add(track(later));
    store.end(later, TrackEnd::kExpired);
  }
  EXPECT_FALSE(store.find("flown"));
  EXPECT_TRUE(store.steps_after("flown", -1, 10).empty());
}

TEST(TrackStore, GivesTheRoomOfTheFirstFlightsToThoseThatComeWhateverTheirDates) {
  const testing::TemporaryFolder folder;
  TrackStore store(folder / "tracks.sqlite", 1 << 20);
  for (int i = 0; i < 20; ++i) {
    const std::string id = "t" + std::to_string(i);
    store.add(track(id));
    ASSERT_TRUE(store.add_step(id, 1000 - i, state(100), {0, 0, std::string(100'000, 'a')}));
    store.end(id, TrackEnd::kExpired);
  }
  EXPECT_FALSE(store.last_step("t0"));
  EXPECT_TRUE(store.find("t0")) << "that it has ended is still known";
  EXPECT_TRUE(store.last_step("t18"));
  EXPECT_TRUE(store.last_step("t19"));
}

TEST(TrackStore, KeepsOfFlightsThatAreOverNoMoreThanHalfOfWhatTheDiskHasRoomFor) {
  const testing::TemporaryFolder folder;
  TrackStore store(folder / "tracks.sqlite", kPlenty, [](const auto&) { return 400'000; });
  for (int i = 0; i < 10; ++i) {
    const std::string id = "t" + std::to_string(i);
    store.add(track(id));
    ASSERT_TRUE(store.add_step(id, 2 + i, state(100), {0, 0, std::string(100'000, 'a')}));
    store.end(id, TrackEnd::kExpired);
  }
  EXPECT_FALSE(store.last_step("t5"));
  EXPECT_TRUE(store.last_step("t9"));
}

TEST(TrackStore, GivesTheRoomOfFlightsThatAreOverToOneThatGoesOn) {
  const testing::TemporaryFolder folder;
  TrackStore store(folder / "tracks.sqlite", 1 << 20);
  for (const char* id : {"t0", "t1", "t2", "t3"}) {
    store.add(track(id));
    ASSERT_TRUE(store.add_step(id, id[1], state(100), {0, 0, std::string(100'000, 'a')}));
    store.end(id, TrackEnd::kExpired);
  }
  store.add(track("flying"));
  const auto fly = [&](int i) { (void)store.add_step("flying", 99, state(100), {i, 0, std::string(100'000, 'b')}); };
  for (int i = 0; i < 7; ++i) EXPECT_EQ(code_of([&] { fly(i); }), "no error") << i;
  EXPECT_FALSE(store.last_step("t0"));
  EXPECT_TRUE(store.last_step("t3")) << "no more than it takes";
  EXPECT_FALSE(store.problem());
  for (int i = 7; i < 9; ++i) EXPECT_EQ(code_of([&] { fly(i); }), "no error") << i;
  EXPECT_EQ(code_of([&] {
              fly(9);
              fly(10);
            }),
            "track-store-full")
      << "all of it is of the one that flies";
}

TEST(TrackStore, ForgetsTheFirstOfTheTracksThatEndedWhateverTheirDates) {
  const testing::TemporaryFolder folder;
  TrackStore store(folder / "tracks.sqlite", kPlenty);
  store.add(track("flying"));
  for (int i = 0; i <= 100; ++i) {
    const std::string id = "t" + std::to_string(i);
    store.add(track(id));
    ASSERT_TRUE(store.add_step(id, 1000 - i, state(100), {0, 0, "answer"}));  // a clock that goes back
    store.end(id, TrackEnd::kExpired);
  }
  EXPECT_FALSE(store.find("t0"));
  EXPECT_FALSE(store.last_step("t0"));
  for (const char* id : {"t1", "t100"}) {
    ASSERT_TRUE(store.find(id));
    EXPECT_EQ(store.find(id)->ended, TrackEnd::kExpired);
    EXPECT_TRUE(store.last_step(id));
  }
  EXPECT_TRUE(store.find("flying"));
}

TEST(TrackStore, KeepsFlightsThatExpiredHoweverManyTracksAreFinished) {
  const testing::TemporaryFolder folder;
  TrackStore store(folder / "tracks.sqlite", kPlenty);
  store.add(track("flown"));
  ASSERT_TRUE(store.add_step("flown", 2, state(100), {0, 0, "answer"}));
  store.end("flown", TrackEnd::kExpired);
  for (int i = 0; i <= 100; ++i) {
    const std::string id = "t" + std::to_string(i);
    store.add(track(id));
    store.end(id, TrackEnd::kFinished);
  }
  EXPECT_TRUE(store.last_step("flown"));
  EXPECT_FALSE(store.find("t0"));
  EXPECT_TRUE(store.find("t1"));
}

TEST(TrackStore, IsAsBeforeWhenItIsFullAndGoesOnWhenThereIsRoom) {
  const testing::TemporaryFolder folder;
  TrackStore store(folder / "tracks.sqlite", 144 << 10);
  store.add(track("a"));
  store.add(track("b"));
  ASSERT_TRUE(store.add_step("a", 5, state(40'000), {0, 0, "first"}));
  ASSERT_TRUE(store.add_step("b", 5, state(40'000), {0, 0, "first"}));
  const auto step = [&] { (void)store.add_step("a", 6, state(80'000), {1, 0, "second"}); };
  EXPECT_EQ(code_of(step), "track-store-full");
  EXPECT_THAT(message_of(step), HasSubstr("nothing was changed"));
  EXPECT_EQ(store.last_step("a")->answer, "first");
  EXPECT_EQ(store.state("a").size(), 40'000U);
  EXPECT_EQ(store.find("a")->touched_us, 5);
  store.end("b", TrackEnd::kFinished);
  EXPECT_TRUE(store.add_step("a", 6, state(80'000), {1, 0, "second"}));
  EXPECT_EQ(store.last_step("a")->answer, "second");
}

TEST(TrackStore, StaysFullThoughATrackBeginsAndSaysWhoseLimitItMayBe) {
  const testing::TemporaryFolder folder;
  TrackStore store(folder / "tracks.sqlite", 1 << 20);
  store.add(track("a"));
  EXPECT_EQ(code_of([&] { (void)store.add_step("a", 5, state(2 << 20), {0, 0, "first"}); }), "track-store-full");
  store.add(track("b"));
  EXPECT_THAT(store.problem(), ::testing::Optional(HasSubstr("--tracks-size allows 1 MiB")));
  store.end("b", TrackEnd::kFinished);
  EXPECT_FALSE(store.problem());
}

TEST(TrackStore, AdvisesToEndTracksWhereItsLimitIsReachedButNotWhereTheDiskIsFull) {
  for (const bool disk_is_full : {false, true}) {
    const testing::TemporaryFolder folder;
    TrackStore store(folder / "tracks.sqlite", 1 << 20, [&](const auto&) { return disk_is_full ? 100'000 : kPlenty; });
    store.add(track("a"));
    const std::string refusal = message_of([&] { (void)store.add_step("a", 5, state(2 << 20), {0, 0, "first"}); });
    EXPECT_THAT(refusal, HasSubstr(disk_is_full ? "their disk has 0 MiB free" : "its disk has 1024 MiB free"));
    EXPECT_THAT(refusal,
                HasSubstr(disk_is_full ? "changed; make room on the disk" : "changed; end tracks or make room"));
  }
}

TEST(TrackStore, SaysBeforeTheFirstStepThatItsDiskIsFullAndNoLongerOnceAStepIsStored) {
  const testing::TemporaryFolder folder;
  TrackStore store(folder / "tracks.sqlite", kPlenty, [](const auto&) { return 100'000; });
  store.add(track("a"));
  EXPECT_THAT(store.problem(), ::testing::Optional(HasSubstr("their disk has 0 MiB free")));
  ASSERT_TRUE(store.add_step("a", 5, state(100), {0, 0, "first"}));
  EXPECT_FALSE(store.problem());
}

TEST(TrackStore, IsHeldByOneServiceAtATime) {
  const testing::TemporaryFolder folder;
  auto first = std::make_unique<TrackStore>(folder / "tracks.sqlite", kPlenty);
  const auto open = [&] { const TrackStore second(folder / "tracks.sqlite", kPlenty); };
  EXPECT_EQ(code_of(open), "track-store-busy");
  first.reset();
  EXPECT_EQ(code_of(open), "no error");
}

TEST(TrackStore, SaysThatItsFileWasDeletedOrReplacedAndTakesNoStepThatWouldBeLost) {
  const testing::TemporaryFolder folder;
  const auto path = folder / "tracks.sqlite";
  TrackStore store(path, kPlenty);
  store.add(track("a"));
  ASSERT_FALSE(store.problem());
  const auto add_step = [&] { (void)store.add_step("a", 2, state(100), {0, 0, "answer"}); };
  std::filesystem::rename(path, folder / "kept");
  EXPECT_THAT(store.problem().value_or(""), HasSubstr("deleted"));
  EXPECT_EQ(code_of(add_step), "track-store-unavailable");
  EXPECT_EQ(code_of([&] { store.add(track("b")); }), "track-store-unavailable");
  std::ofstream(path) << "another";
  EXPECT_EQ(code_of(add_step), "track-store-unavailable");
  std::filesystem::rename(folder / "kept", path);
  EXPECT_EQ(code_of(add_step), "no error");
  EXPECT_FALSE(store.problem());
}

/// Byte 18 of the header is the version that a writer must know: SQLite reads newer ones and writes none.
/// https://www.sqlite.org/fileformat2.html#file_format_version_numbers
TEST(TrackStore, SaysThatItMayNotBeWrittenTo) {
  const testing::TemporaryFolder folder;
  { const TrackStore store(folder / "tracks.sqlite", kPlenty); }
  {
    std::fstream file(folder / "tracks.sqlite", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(18);
    file.put(3);
  }
  EXPECT_EQ(code_of([&] { const TrackStore store(folder / "tracks.sqlite", kPlenty); }), "track-store-read-only");
}

TEST(TrackStore, SaysThatItsFolderMayNotBeWrittenTo) {
  const testing::TemporaryFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms{0555});
  const testing::AsAnotherUser service;
  if (service.may_do_everything()) GTEST_SKIP();
  EXPECT_EQ(code_of([&] { const TrackStore store(folder / "tracks.sqlite", kPlenty); }), "track-store-read-only")
      << "no such file, says SQLite";
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(TrackStore, LeavesAMapThatIsNamedByMistakeAsItIs) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path map = folder / "town.gpkg";
  testing::write_map_file(map, testing::street_map(41, {2.0, {300'100, -3'200'050}, 40, 40}), 2.0);
  const std::string before = bytes_of(map);
  const auto open = [&] { TrackStore(map, kPlenty); };
  EXPECT_EQ(code_of(open), "track-store-unavailable");
  EXPECT_THAT(message_of(open), HasSubstr("holds no tracks but a map"));
  EXPECT_EQ(bytes_of(map), before);
}

TEST(TrackStore, LeavesTheFileOfAnotherProgramAsItIs) {
  const testing::TemporaryFolder folder;
  for (const char* tables :
       {"CREATE TABLE photos (taken)", "PRAGMA user_version = 2; CREATE TABLE photos (taken)",
        "CREATE TABLE tracks (title, album)", "PRAGMA user_version = 3; CREATE TABLE tracks (id, title, album)"}) {
    const std::filesystem::path path = folder / "library.sqlite";
    std::filesystem::remove(path);
    testing::open_sqlite(path, sqlite::Access::kCreate).execute(tables);
    const std::string before = bytes_of(path);
    EXPECT_THAT(message_of([&] { TrackStore(path, kPlenty); }), HasSubstr("holds no tracks")) << tables;
    EXPECT_TRUE(bytes_of(path) == before) << tables;
  }
}

TEST(TrackStore, LeavesTheTracksOfAnotherVersionAsTheyAre) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path path = folder / "tracks.sqlite";
  { TrackStore(path, kPlenty).add(track("a")); }
  const std::int64_t version = [&] {
    sqlite::Connection written = testing::open_sqlite(path);
    return sqlite::number(written, "PRAGMA user_version");
  }();
  for (const std::int64_t other : {version - 1, version + 1}) {
    testing::open_sqlite(path).execute(("PRAGMA user_version = " + std::to_string(other)).c_str());
    const std::string before = bytes_of(path);
    const auto open = [&] { TrackStore(path, kPlenty); };
    EXPECT_EQ(code_of(open), "track-store-unavailable");
    EXPECT_THAT(message_of(open), HasSubstr("another version of roadfix"));
    EXPECT_TRUE(bytes_of(path) == before) << other;
  }
}

TEST(TrackStore, SaysWhyItCannotBeOpened) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "noise.sqlite") << std::string(8192, 'x');
  EXPECT_EQ(code_of([&] { const TrackStore store(folder / "noise.sqlite", kPlenty); }), "track-store-corrupt");
  const auto open_in_no_folder = [&] { const TrackStore store(folder / "no/folder.sqlite", kPlenty); };
  EXPECT_EQ(code_of(open_in_no_folder), "track-store-unavailable");
  EXPECT_THAT(message_of(open_in_no_folder), HasSubstr("(No such file or directory)"));
}

}  // namespace
}  // namespace roadfix::server
