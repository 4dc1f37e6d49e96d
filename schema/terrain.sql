-- The heights of a map's ground, made when a map gets them. Described in map-format.md.
-- One row: the cells that the tiles are part of, and where the heights came from.
CREATE TABLE roadfix_terrain_source (
  cell_m REAL NOT NULL,
  min_x REAL NOT NULL,
  min_y REAL NOT NULL,
  max_x REAL NOT NULL,
  max_y REAL NOT NULL,
  location TEXT NOT NULL,
  date TEXT NOT NULL,
  licence TEXT NOT NULL,
  attribution TEXT NOT NULL,
  added_at TEXT NOT NULL
);

-- 16-bit PNG, 0..65534 = height of -1000 m + 0.2 m * k above the sea, 65535 = unknown. No row where all is unknown.
CREATE TABLE roadfix_terrain (
  id INTEGER PRIMARY KEY,
  tile_column INTEGER NOT NULL,
  tile_row INTEGER NOT NULL,
  tile_data BLOB NOT NULL,
  UNIQUE (tile_column, tile_row)
);

INSERT INTO gpkg_extensions VALUES
  ('roadfix_terrain_source', NULL, 'roadfix_map', 'Cells of the heights of the ground and where they came from. See schema/map-format.md of Roadfix.', 'read-write'),
  ('roadfix_terrain', NULL, 'roadfix_map', 'Heights of the ground, 16-bit PNG tiles. See schema/map-format.md of Roadfix.', 'read-write');
