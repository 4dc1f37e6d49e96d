// Which sources of a map are one witness of where its roads are. What was made of a source lies where that lies: an
// extract of another date, roads of another provider that took them from the same place, the same image read by another
// network. If it counted beside it, the two would outvote a third source that is right.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tiles/store/map_records.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix {

/// Whether two sources agree better than two that know nothing of each other do. `shared` says what each has to say.
bool is_copy(const SharedEvidence& shared);

class Witnesses {
 public:
  struct Around {
    Witness copies;  ///< of the source, and copies of these; without itself
    std::vector<Witness> others;
  };

  /// The map must outlive it, and its sources in force stay what they are.
  explicit Witnesses(MapWriter& writer) : writer_(&writer) {}

  /// Of the sources that share tiles with this one. Throws what MapWriter::shared_evidence() does.
  Around around(const std::string& source);

 private:
  bool are_one(const std::string& one, const std::string& other);

  MapWriter* writer_;
  std::map<std::pair<std::string, std::string>, bool> known_;
};

}  // namespace roadfix
