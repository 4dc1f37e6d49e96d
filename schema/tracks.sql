-- State of the tracks being served. One step is one transaction: what was answered is in here.
-- Times are microseconds since 1970 by the server's clock; those of the vehicle stand in the answers and states.

CREATE TABLE IF NOT EXISTS tracks (
  id          TEXT PRIMARY KEY NOT NULL,
  client      TEXT NOT NULL,           -- address that created it
  request     TEXT NOT NULL,           -- the JSON it was created with
  map         TEXT NOT NULL,
  map_version TEXT NOT NULL,
  created_us  INTEGER NOT NULL,
  touched_us  INTEGER NOT NULL,        -- created, or the last step
  ended       TEXT NOT NULL DEFAULT '',-- '' while it flies, else 'finished' or 'expired'
  end_number  INTEGER,                 -- counts the ends, since dates may go back; NULL while it flies
  state       BLOB                     -- core/track/tracker_bytes; NULL before the first step and after the end
) WITHOUT ROWID;

CREATE TABLE IF NOT EXISTS steps (
  track    TEXT NOT NULL,
  sequence INTEGER NOT NULL,
  digest   INTEGER NOT NULL,           -- of the request, to tell a repeated step from another of that number
  answer   TEXT NOT NULL,
  PRIMARY KEY (track, sequence)
) WITHOUT ROWID;
