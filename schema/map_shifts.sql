-- A table of the map file that maps made before it lack. Described in map-format.md.
-- Sources in force that lie beside the others: where their roads fit those better.
CREATE TABLE IF NOT EXISTS roadfix_shifts (
  source_id INTEGER NOT NULL PRIMARY KEY REFERENCES roadfix_sources(id),
  east_m REAL NOT NULL,
  north_m REAL NOT NULL,
  correlation REAL NOT NULL,
  correlation_in_place REAL NOT NULL,
  sigma_m REAL NOT NULL
);
INSERT INTO gpkg_extensions
  SELECT 'roadfix_shifts', NULL, 'roadfix_map', 'Sources that lie beside the others. See schema/map-format.md of Roadfix.', 'read-write'
  WHERE NOT EXISTS (SELECT 1 FROM gpkg_extensions WHERE table_name = 'roadfix_shifts');
