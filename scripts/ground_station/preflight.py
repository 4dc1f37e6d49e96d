"""What can be told before the first picture, which mostly comes in the air."""
import math
import sys
import urllib.parse

from places import told_place
from service import Service, Silent
from steps import LENS_FIELDS, PICTURE_FIELDS, POSITION_FIELDS

PATIENCE_S = 3.0
LEAST_DEGREE_M = 110_500.0  # of latitude; that of places makes distances too long


def check(url, request, frame_fields):
    """Says what the service has of what POST /v1/tracks would be asked for. Whether it can follow a track now. Throws
    Refused, and ValueError where no flight can come of it."""
    for name in frame_fields:
        if name not in PICTURE_FIELDS + POSITION_FIELDS:
            raise ValueError(f"--frame {name}: no such field of a step; there are {', '.join(PICTURE_FIELDS)}, and of "
                             f"positions {', '.join(POSITION_FIELDS)}")
    service = Service(url, PATIENCE_S)
    unchecked = "nothing"
    try:
        _check_map(request, frame_fields, service)
        unchecked = "nothing more"
        ready = service.ask_object(("status",), "GET", "/readyz")
    except Silent as silent:
        print(f"{unchecked} is checked before the flight: {silent}", file=sys.stderr)
        return False
    finally:
        service.close()
    can_follow = ready.get("tracks", "ready") == "ready"
    if not can_follow:
        print(f"no track can be flown now: {ready.get('tracks_problem')}", file=sys.stderr)
    return can_follow


def _check_map(request, frame_fields, service):
    found = service.ask_object(("status",), "GET", "/v1/maps/" + urllib.parse.quote(request["map"], safe=""))
    if not found.get("bbox"):
        raise ValueError(f"the map '{request['map']}' shows nothing: its status is '{found['status']}'")
    _require_near(request, found["bbox"])
    status = "" if found["status"] == "ready" else f", {found['status']}"
    if "takeoff_alt_m" in frame_fields and "terrain" not in found:
        raise ValueError(f"--frame takeoff_alt_m: the map '{request['map']}' does not know how high its ground is: add "
                         "heights with roadfix terrain, or give agl_m")
    heights = "" if "terrain" in found or not _leaves_height_to_lines(frame_fields) else \
        "; it does not know how high its ground is: lines of pictures need agl_m, alt_m alone will not do"
    print(f"the map '{request['map']}' has version {found.get('version')}{status}{heights}", file=sys.stderr)


def _leaves_height_to_lines(frame_fields):
    """That of a camera, by agl_m or alt_m."""
    return any(name in frame_fields for name in LENS_FIELDS) and "agl_m" not in frame_fields


def _require_near(request, bbox):
    """The place where the track begins."""
    place = told_place(request)
    beside_m = _distance_m(place, bbox) - place["within_m"] if place else 0.0
    if beside_m > 0.0:
        raise ValueError(f"--track: the track would begin at least {beside_m / 1e3:.1f} km beside the map, which shows "
                         f"lat {bbox[1]:.4f} to {bbox[3]:.4f} and lon {bbox[0]:.4f} to {bbox[2]:.4f}")


def _distance_m(place, bbox):
    """At least, from a box."""
    west, south, east, north = bbox
    lat = max(south - place["lat"], place["lat"] - north, 0.0)
    lon = max(0.0, abs(math.remainder(place["lon"] - (west + east) / 2.0, 360.0)) - (east - west) / 2.0)
    shrunk = math.cos(math.radians(min(90.0, max(abs(south), abs(north), abs(place["lat"])))))
    return LEAST_DEGREE_M * max(lat, lon * shrunk)
