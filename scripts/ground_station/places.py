"""Places where a vehicle was, and how far from them it may be."""
import math

FASTEST_M_S = 50.0
WIDEST_M = 2e7  # of a prior: all of the Earth
DEGREE_M = 111_700.0  # at most
PRIOR = ("lat", "lon", "radius_m", "bbox", "heading_deg", "heading_range_deg")


def told_place(request):
    """What POST /v1/tracks is told of the place, as a known one. None where it is told nothing."""
    if "radius_m" in request:
        lat, lon, within_m = request["lat"], request["lon"], request["radius_m"]
    elif "bbox" in request:
        west, south, east, north = request["bbox"]
        width = (east - west) % 360.0
        lat, lon = (south + north) / 2.0, (west + width / 2.0 + 180.0) % 360.0 - 180.0
        within_m = math.hypot(width, north - south) / 2.0 * DEGREE_M
    else:
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


def around(known):
    """The members of POST /v1/tracks that tell of a known place."""
    if not known:
        return {}
    return {"lat": known["lat"], "lon": known["lon"], "radius_m": min(known["within_m"] + known["flown_m"], WIDEST_M)}
