// Which sources of a map count as one witness of where its roads are. A copy shares the position error of its original:
// an extract of another date, roads that another provider took over, the same image read by another network. If both
// counted, they would outvote a third source that is right.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tiles/store/map_records.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix {

/// Of the ground that sources share so many tiles are compared, evenly spread over it.
inline constexpr std::int64_t kTilesCompared = 64;

/// Whether the two sources in `shared` agree better than independent ones do.
bool is_copy(const SharedEvidence& shared);

class Witnesses {
 public:
  struct Around {
    Witness copies;  ///< of the source, and copies of its copies; without the source itself
    std::vector<Witness> others;
  };

  /// The map must outlive this, and its sources in force must not change meanwhile.
  explicit Witnesses(MapWriter& writer) : writer_(&writer) {}

  /// Groups the sources that share tiles with this one. Throws what MapWriter::shared_evidence() does.
  Around around(const std::string& source);

 private:
  bool are_one(const std::string& one, const std::string& other);

  MapWriter* writer_;
  std::map<std::pair<std::string, std::string>, bool> known_;
};

}  // namespace roadfix
