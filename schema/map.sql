-- The tables of a map file, version 2. Described in map-format.md.
-- The definitions of the gpkg_ tables are those of OGC GeoPackage 1.2 (12-128r14) and of its extension
-- Tiled Gridded Coverage Data (17-066r1), to the letter: validators compare them.
PRAGMA application_id = 0x47504B47; -- "GPKG"
PRAGMA user_version = 10200;

CREATE TABLE gpkg_spatial_ref_sys (
  srs_name TEXT NOT NULL,
  srs_id INTEGER NOT NULL PRIMARY KEY,
  organization TEXT NOT NULL,
  organization_coordsys_id INTEGER NOT NULL,
  definition TEXT NOT NULL,
  description TEXT
);
INSERT INTO gpkg_spatial_ref_sys VALUES
  ('Undefined Cartesian SRS', -1, 'NONE', -1, 'undefined', 'undefined Cartesian coordinate reference system'),
  ('Undefined geographic SRS', 0, 'NONE', 0, 'undefined', 'undefined geographic coordinate reference system'),
  ('WGS 84 geodetic', 4326, 'EPSG', 4326, 'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AXIS["Latitude",NORTH],AXIS["Longitude",EAST],AUTHORITY["EPSG","4326"]]', 'longitude/latitude coordinates in decimal degrees on the WGS 84 spheroid'),
  ('WGS 84 3D', 4979, 'EPSG', 4979, 'GEODCRS["WGS 84",DATUM["World Geodetic System 1984",ELLIPSOID["WGS 84",6378137,298.257223563,LENGTHUNIT["metre",1]]],CS[ellipsoidal,3],AXIS["latitude",north,ORDER[1],ANGLEUNIT["degree",0.0174532925199433]],AXIS["longitude",east,ORDER[2],ANGLEUNIT["degree",0.0174532925199433]],AXIS["ellipsoidal height",up,ORDER[3],LENGTHUNIT["metre",1]],ID["EPSG",4979]]', 'required by the gridded coverage extension');

CREATE TABLE gpkg_contents (
  table_name TEXT NOT NULL PRIMARY KEY,
  data_type TEXT NOT NULL,
  identifier TEXT UNIQUE,
  description TEXT DEFAULT '',
  last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')),
  min_x DOUBLE,
  min_y DOUBLE,
  max_x DOUBLE,
  max_y DOUBLE,
  srs_id INTEGER,
  CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id)
);

CREATE TABLE gpkg_tile_matrix_set (
  table_name TEXT NOT NULL PRIMARY KEY,
  srs_id INTEGER NOT NULL,
  min_x DOUBLE NOT NULL,
  min_y DOUBLE NOT NULL,
  max_x DOUBLE NOT NULL,
  max_y DOUBLE NOT NULL,
  CONSTRAINT fk_gtms_table_name FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
  CONSTRAINT fk_gtms_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys (srs_id)
);

CREATE TABLE gpkg_tile_matrix (
  table_name TEXT NOT NULL,
  zoom_level INTEGER NOT NULL,
  matrix_width INTEGER NOT NULL,
  matrix_height INTEGER NOT NULL,
  tile_width INTEGER NOT NULL,
  tile_height INTEGER NOT NULL,
  pixel_x_size DOUBLE NOT NULL,
  pixel_y_size DOUBLE NOT NULL,
  CONSTRAINT pk_ttm PRIMARY KEY (table_name, zoom_level),
  CONSTRAINT fk_tmm_table_name FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name)
);

CREATE TABLE gpkg_extensions (
  table_name TEXT,
  column_name TEXT,
  extension_name TEXT NOT NULL,
  definition TEXT NOT NULL,
  scope TEXT NOT NULL,
  CONSTRAINT ge_tce UNIQUE (table_name, column_name, extension_name)
);

CREATE TABLE gpkg_2d_gridded_coverage_ancillary (
  id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL,
  tile_matrix_set_name TEXT NOT NULL UNIQUE,
  datatype TEXT NOT NULL DEFAULT 'integer',
  scale REAL NOT NULL DEFAULT 1.0,
  offset REAL NOT NULL DEFAULT 0.0,
  precision REAL DEFAULT 1.0,
  data_null REAL,
  grid_cell_encoding TEXT DEFAULT 'grid-value-is-center',
  uom TEXT,
  field_name TEXT DEFAULT 'Height',
  quantity_definition TEXT DEFAULT 'Height',
  CONSTRAINT fk_g2dgtct_name FOREIGN KEY(tile_matrix_set_name) REFERENCES gpkg_tile_matrix_set ( table_name )
  CHECK (datatype in ('integer','float'))
);

CREATE TABLE gpkg_2d_gridded_tile_ancillary (
  id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL,
  tpudt_name TEXT NOT NULL,
  tpudt_id INTEGER NOT NULL,
  scale REAL NOT NULL DEFAULT 1.0,
  offset REAL NOT NULL DEFAULT 0.0,
  min REAL DEFAULT NULL,
  max REAL DEFAULT NULL,
  mean REAL DEFAULT NULL,
  std_dev REAL DEFAULT NULL,
  CONSTRAINT fk_g2dgtat_name FOREIGN KEY (tpudt_name) REFERENCES gpkg_contents(table_name),
  UNIQUE (tpudt_name, tpudt_id)
);

-- The fused map: finest level and overviews.
CREATE TABLE road_probability (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  zoom_level INTEGER NOT NULL,
  tile_column INTEGER NOT NULL,
  tile_row INTEGER NOT NULL,
  tile_data BLOB NOT NULL,
  UNIQUE (zoom_level, tile_column, tile_row)
);

CREATE TABLE roadfix_meta (
  key TEXT NOT NULL PRIMARY KEY,
  value TEXT NOT NULL
);

-- At most one row of a name is in force and at most one is being ingested to take its place.
CREATE TABLE roadfix_sources (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  name TEXT NOT NULL,
  kind TEXT NOT NULL,
  location TEXT NOT NULL,
  fingerprint TEXT NOT NULL,
  date TEXT NOT NULL,
  licence TEXT NOT NULL,
  attribution TEXT NOT NULL,
  method TEXT NOT NULL,
  registration_sigma_m REAL NOT NULL,
  in_force INTEGER NOT NULL CHECK (in_force IN (0, 1)),
  ingested_at TEXT NOT NULL,
  UNIQUE (name, in_force)
);

-- The ledger: every block (a tile of the finest level) of a source, and whether it is done.
CREATE TABLE roadfix_blocks (
  source_id INTEGER NOT NULL REFERENCES roadfix_sources(id),
  tile_row INTEGER NOT NULL,
  tile_column INTEGER NOT NULL,
  done INTEGER NOT NULL CHECK (done IN (0, 1)),
  PRIMARY KEY (source_id, tile_row, tile_column)
) WITHOUT ROWID;

-- What each source says: 8-bit PNG, 0..254 = probability k / 254, 255 = unobserved. No row where it observed nothing.
CREATE TABLE roadfix_evidence (
  id INTEGER PRIMARY KEY,
  source_id INTEGER NOT NULL REFERENCES roadfix_sources(id),
  tile_column INTEGER NOT NULL,
  tile_row INTEGER NOT NULL,
  tile_data BLOB NOT NULL,
  UNIQUE (tile_column, tile_row, source_id)
);

-- Sources in force that lie beside the others: where their roads fit those better.
CREATE TABLE roadfix_shifts (
  source_id INTEGER NOT NULL PRIMARY KEY REFERENCES roadfix_sources(id),
  east_m REAL NOT NULL,
  north_m REAL NOT NULL,
  correlation REAL NOT NULL,
  correlation_in_place REAL NOT NULL,
  sigma_m REAL NOT NULL
);

-- Tiles of road_probability that do not yet follow from the evidence in force.
CREATE TABLE roadfix_pending (
  zoom_level INTEGER NOT NULL,
  tile_row INTEGER NOT NULL,
  tile_column INTEGER NOT NULL,
  PRIMARY KEY (zoom_level, tile_row, tile_column)
) WITHOUT ROWID;

INSERT INTO gpkg_extensions VALUES
  ('gpkg_2d_gridded_coverage_ancillary', NULL, 'gpkg_2d_gridded_coverage', 'http://docs.opengeospatial.org/is/17-066r1/17-066r1.html', 'read-write'),
  ('gpkg_2d_gridded_tile_ancillary', NULL, 'gpkg_2d_gridded_coverage', 'http://docs.opengeospatial.org/is/17-066r1/17-066r1.html', 'read-write'),
  ('road_probability', 'tile_data', 'gpkg_2d_gridded_coverage', 'http://docs.opengeospatial.org/is/17-066r1/17-066r1.html', 'read-write'),
  ('roadfix_meta', NULL, 'roadfix_map', 'Key and value: schema_version, epsg, cell_m, version (a hash of the finest tiles), shifts_outdated, error_of_removed_m. See schema/map-format.md of Roadfix.', 'read-write'),
  ('roadfix_sources', NULL, 'roadfix_map', 'Ingested sources with their provenance. See schema/map-format.md of Roadfix.', 'read-write'),
  ('roadfix_blocks', NULL, 'roadfix_map', 'Ledger of the blocks of each source. See schema/map-format.md of Roadfix.', 'read-write'),
  ('roadfix_evidence', NULL, 'roadfix_map', 'Road probability as each source has it, 8-bit PNG tiles. See schema/map-format.md of Roadfix.', 'read-write'),
  ('roadfix_shifts', NULL, 'roadfix_map', 'Sources that lie beside the others. See schema/map-format.md of Roadfix.', 'read-write'),
  ('roadfix_pending', NULL, 'roadfix_map', 'Tiles that wait to be fused from the evidence. See schema/map-format.md of Roadfix.', 'read-write');
