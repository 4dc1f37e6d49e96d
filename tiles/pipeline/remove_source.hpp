// A source out of a map, and what that changes of the others.
#pragma once

#include <stop_token>
#include <string>

#include "core/units/progress.hpp"
#include "tiles/pipeline/source_shift.hpp"
#include "tiles/store/map_writer.hpp"

namespace roadfix {

struct RemoveReport {
  bool was_there = false;  ///< else an earlier call was stopped, and this one went on
  ShiftReport shifts;      ///< of the sources that are left
};

/// MapWriter::remove_source(), which says what it throws; then measures the shifts of the others anew, since they may
/// have been shifted against this one. Throws Interrupted "work-stopped"; can be repeated then.
RemoveReport remove_source(MapWriter& writer, const std::string& source, const OnProgress& on_fusing,
                           const OnProgress& on_shifts, const std::stop_token& stop);

}  // namespace roadfix
