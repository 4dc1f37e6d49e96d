"""Places where a vehicle was, and how far from them it may be."""
import math

FASTEST_M_S = 50.0
WIDEST_M = 2e7  # of a prior: all of the Earth
KNOWN_M = 150.0  # a known start is no wider
DEGREE_M = 111_700.0  # at most
PRIOR = ("lat", "lon", "radius_m", "bbox", "heading_deg", "heading_range_deg", "known_start")


def told_place(request):
    """What POST /v1/tracks is told of the place, as a known one. None where it is told nothing, or what it refuses."""
    try:
        if "radius_m" in request:
            lat, lon, within_m = (float(request[name]) for name in ("lat", "lon", "radius_m"))
        else:
            west, south, east, north = request["bbox"]
            width = (east - west) % 360.0
            lat, lon = (south + north) / 2.0, (west + width / 2.0 + 180.0) % 360.0 - 180.0
            within_m = math.hypot(width, north - south) / 2.0 * DEGREE_M
    except (KeyError, TypeError, ValueError):
        return None
    return {"lat": lat, "lon": lon, "within_m": within_m, "flown_m": 0.0}


def claimed_place(answer):
    pose = answer["pose"]
    return {"lat": pose["lat"], "lon": pose["lon"], "within_m": 100.0 + 5.0 * max(answer["sigma_m"]), "flown_m": 0.0}


def length_m(moved):
    return math.hypot(moved["forward_m"], moved["right_m"]) if moved else 0.0


def left(known, flown_m):
    """A known place, None where there is none, farther away."""
    return {**known, "flown_m": known["flown_m"] + flown_m} if known else None


def without_prior(request):
    return {name: value for name, value in request.items() if name not in PRIOR}


def around(known, request):
    """The members of POST /v1/tracks for a vehicle that is as far from a known place as it may have flown: what was told
    of the start does not hold any more. A known start is one as long as it is narrow enough."""
    members = without_prior(request)
    if known:
        radius_m = min(known["within_m"] + known["flown_m"], WIDEST_M)
        members.update(lat=known["lat"], lon=known["lon"], radius_m=radius_m)
        if request.get("known_start") and radius_m <= KNOWN_M:
            members["known_start"] = True
    return members
