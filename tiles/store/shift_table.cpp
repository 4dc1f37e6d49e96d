#include "tiles/store/shift_table.hpp"

#include <fmt/format.h>

namespace roadfix {
namespace {

using sqlite::Connection;
using sqlite::Statement;
using sqlite::Transaction;

}  // namespace

void mark_shifts_outdated(Connection& map) {
  map.execute("INSERT OR REPLACE INTO roadfix_meta (key, value) VALUES ('shifts_outdated', '1')");
}

bool shifts_outdated(Connection& map) {
  return sqlite::number(map, "SELECT count(*) FROM roadfix_meta WHERE key = 'shifts_outdated'") > 0;
}

void put_shifts(Connection& map, const std::map<std::string, std::optional<SourceShift>>& shifts) {
  Transaction transaction(map, Transaction::Kind::kWrite);
  Statement forget(map,
                   "DELETE FROM roadfix_shifts WHERE source_id IN (SELECT id FROM roadfix_sources WHERE name = ?1 AND "
                   "in_force = 1)");
  Statement put(map,
                "INSERT INTO roadfix_shifts (source_id, east_m, north_m, correlation, correlation_in_place, sigma_m) "
                "SELECT id, ?2, ?3, ?4, ?5, ?6 FROM roadfix_sources WHERE name = ?1 AND in_force = 1");
  for (const auto& [name, shift] : shifts) {
    forget.with(name).run();
    if (!shift) continue;
    put.with(name, shift->east_m, shift->north_m, shift->correlation, shift->correlation_in_place, shift->sigma_m)
        .run();
  }
  map.execute("DELETE FROM roadfix_meta WHERE key = 'shifts_outdated'");
  transaction.commit();
}

std::map<std::string, SourceShift> read_shifts(Connection& map) {
  std::map<std::string, SourceShift> shifts;
  Statement select(map,
                   "SELECT s.name, h.east_m, h.north_m, h.correlation, h.correlation_in_place, h.sigma_m FROM "
                   "roadfix_shifts h JOIN roadfix_sources s ON s.id = h.source_id WHERE s.in_force = 1");
  while (select.step()) {
    shifts[select.text(0)] = {.east_m = select.real(1),
                              .north_m = select.real(2),
                              .correlation = select.real(3),
                              .correlation_in_place = select.real(4),
                              .sigma_m = select.real(5)};
  }
  return shifts;
}

void remember_error_of_removed(Connection& map, std::int64_t source_id) {
  const double before_m = error_of_removed_m(map);
  Statement(
      map, fmt::format("INSERT OR REPLACE INTO roadfix_meta (key, value) SELECT 'error_of_removed_m', max({}, ?2) FROM "
                       "roadfix_sources s WHERE s.id = ?1",
                       kRegistrationInForce))
      .with(source_id, before_m)
      .run();
}

double error_of_removed_m(Connection& map) {
  Statement select(map,
                   "SELECT CAST(value AS REAL) FROM roadfix_meta WHERE key = 'error_of_removed_m' AND EXISTS (SELECT 1 "
                   "FROM roadfix_pending)");
  return select.step() ? select.real(0) : 0.0;
}

}  // namespace roadfix
