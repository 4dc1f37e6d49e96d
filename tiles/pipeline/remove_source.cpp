#include "tiles/pipeline/remove_source.hpp"

namespace roadfix {

RemoveReport remove_source(MapWriter& writer, const std::string& source, const OnProgress& on_fusing,
                           const OnProgress& on_shifts, const std::stop_token& stop) {
  RemoveReport report;
  report.was_there = writer.remove_source(source, on_fusing, stop);
  report.shifts = measure_shifts(writer, writer.sources_in_force(), on_shifts, stop);
  return report;
}

}  // namespace roadfix
