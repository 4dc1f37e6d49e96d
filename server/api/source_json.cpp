#include "server/api/source_json.hpp"

namespace roadfix::api {

using nlohmann::json;

json to_json(const SourceStatus& source) {
  const SourceRecord& r = source.record;
  const Provenance& p = r.provenance;
  json answer{{"name", r.name},
              {"kind", to_string(r.content)},
              {"date", p.date},
              {"licence", p.licence},
              {"attribution", p.attribution},
              {"method", r.method},
              {"registration_sigma_m", p.registration_sigma_m},
              {"complete", source.complete && !source.is_damaged()},
              {"blocks_total", source.blocks_total},
              {"blocks_done", source.blocks_done}};
  if (source.complete) answer["ingested_at"] = source.ingested_at;
  if (source.shift) answer["shift"] = to_json(*source.shift);
  return answer;
}

json to_json(const SourceShift& shift) {
  return {{"east_m", shift.east_m}, {"north_m", shift.north_m}, {"sigma_m", shift.sigma_m}};
}

}  // namespace roadfix::api
