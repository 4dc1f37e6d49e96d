#include "tiles/store/map_error.hpp"

#include <fmt/format.h>

#include "core/units/error.hpp"

namespace roadfix {

std::exception_ptr map_error(const std::filesystem::path& map, sqlite::Failure failure, const std::string& detail) {
  using sqlite::Failure;
  using std::make_exception_ptr;
  const std::string file = map.string();
  switch (failure) {
    case Failure::kNeedsRecovery:
      return make_exception_ptr(IoFailure(
          kMapNeedsRecovery, fmt::format("{}: a write to it was cut short and cannot be undone here. Open it once "
                                         "where it may be written to, for example with roadfix verify",
                                         file)));
    case Failure::kNotADatabase:
      return make_exception_ptr(
          InvalidInput("map-not-ours", fmt::format("{}: not a GeoPackage. Name a map made by roadfix", file)));
    case Failure::kDamaged:
      return make_exception_ptr(CorruptData(
          "map-corrupt", fmt::format("{}: the file is damaged ({}). Restore it from a copy or ingest its sources "
                                     "into a new map",
                                     file, detail)));
    case Failure::kOtherTables:
      return make_exception_ptr(
          CorruptData("map-corrupt", fmt::format("{}: its tables are not those of a map ({})", file, detail)));
    case Failure::kBusy:
      return make_exception_ptr(
          InUse("map-busy", fmt::format("{}: another process has locked the file. Try again", file)));
    case Failure::kNotWritable:
      return make_exception_ptr(
          IoFailure("map-not-writable", fmt::format("{}: cannot be written to ({})", file, detail)));
    case Failure::kMoved:
      return make_exception_ptr(IoFailure(
          "map-not-writable", fmt::format("{}: it was moved, removed or replaced while it was written to. What was "
                                          "finished until then is in the file that was there: put it back and repeat "
                                          "the command to go on",
                                          file)));
    case Failure::kFull:
      return make_exception_ptr(
          IoFailure("disk-full", fmt::format("{}: no space left on the disk. Free some and repeat the command", file)));
    case Failure::kOther:
      break;
  }
  return make_exception_ptr(IoFailure("map-io", fmt::format("{}: {}", file, detail)));
}

}  // namespace roadfix
