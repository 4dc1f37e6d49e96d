"""A flight that the service follows, told where the vehicle's own estimator believes to be."""
import json
import math
import os
import pathlib
import time
import urllib.parse

from service import Refused

TRACK_IS_GONE = ("track-ended", "track-not-found", "map-replaced")
PRIOR = ("lat", "lon", "radius_m", "bbox")
#: What was known longer ago is of another flight.
FORGOTTEN_S = 600.0
FASTEST_M_S = 50.0
WIDEST_M = 10_000.0  # beyond it the last place says too little to begin a track around it


def movement(before, now):
    """Forward, right (metres, in the body frame of `before`) and turn (degrees, clockwise) between two places
    (north_m, east_m, yaw_deg), as a step has them."""
    north_m, east_m, yaw = now[0] - before[0], now[1] - before[1], math.radians(before[2])
    return {"forward_m": north_m * math.cos(yaw) + east_m * math.sin(yaw),
            "right_m": east_m * math.cos(yaw) - north_m * math.sin(yaw),
            "turn_deg": (now[2] - before[2] + 180.0) % 360.0 - 180.0}


def farther(known, moved):
    """A known place, left by a movement."""
    if not known or not moved:
        return known
    return {**known, "flown_m": known["flown_m"] + math.hypot(moved["forward_m"], moved["right_m"])}


def as_query(fields):
    def text(value):
        if isinstance(value, (list, tuple)):
            return ",".join(map(text, value))
        return value if isinstance(value, str) else json.dumps(value)
    return urllib.parse.urlencode({name: text(value) for name, value in fields.items()})


class Track:
    """A flight that the service follows. `request`: the members of POST /v1/tracks. With `state_file` a client that
    was restarted goes on with the track that it had, unless that was long ago."""

    def __init__(self, service, request, state_file=None):
        self._service = service
        self._request = dict(request)
        self._file = pathlib.Path(state_file) if state_file else None
        self._state = self._read_state() if self._file and self._file.exists() else {}
        self._keep(self._state)  # a file that cannot be written is told of before the flight

    def _read_state(self):
        try:
            state = json.loads(self._file.read_text())
        except ValueError:
            state = None
        if not isinstance(state, dict) or state.get("map", self._request["map"]) != self._request["map"]:
            raise ValueError(f"{self._file} is not of a track over the map '{self._request['map']}': remove it, or name "
                             "another file")
        return state if 0.0 <= time.time() - state.get("taken_s", -math.inf) < FORGOTTEN_S else {}

    @property
    def id(self):
        return self._state.get("id")

    def step(self, place, fields, image=None, origin=None, packet_format=None, send=None):
        """The answer to a step. `place`: (north_m, east_m, yaw_deg); where `origin` is another one than before, places
        are too, and the movement between is not known. `fields`: time_us and other fields of a step; `send` is called
        with the message for the autopilot in `packet_format`, if there is one."""
        if not self.id:
            self._begin(origin)
        elif origin != self._state["origin"]:
            self._begin_near_the_last_place(origin)
        try:
            return self._step(place, fields, image, packet_format, send)
        except Refused as refusal:
            if refusal.code not in TRACK_IS_GONE:
                raise
        # The same map may have another version, or the service was away for longer than it keeps a silent track.
        self._begin_near_the_last_place(origin)
        return self._step(place, fields, image, packet_format, send)

    def _begin(self, origin, known=None, prior=None):
        request = self._request
        if prior:
            request = {**{name: value for name, value in request.items() if name not in PRIOR}, **prior}
        track = json.loads(self._service.ask("POST", "/v1/tracks", json.dumps(request).encode(), "application/json"))
        self._keep({"map": request["map"], "id": track["id"], "sequence": 0, "origin": origin, "known": known,
                    "taken_s": time.time()})

    def _begin_near_the_last_place(self, origin):
        """Around the place that was known last, as far as the vehicle may have flown since."""
        known = self._state.get("known")
        if known:
            since_s = max(0.0, time.time() - self._state["taken_s"])
            known = {**known, "flown_m": known["flown_m"] + FASTEST_M_S * since_s}
            radius_m = 100.0 + 5.0 * known["sigma_m"] + known["flown_m"]
            if radius_m <= WIDEST_M:
                self._begin(origin, known, {"lat": known["lat"], "lon": known["lon"], "radius_m": radius_m})
                return
        self._begin(origin)

    def _moved_to(self, place):
        return movement(self._state["place"], place) if "place" in self._state else {}

    def _step(self, place, fields, image, packet_format, send):
        before = self._state
        moved = self._moved_to(place)
        numbered = {**fields, "sequence": before["sequence"] + 1, **moved}
        # Before it is sent: where the answer is lost, or this client ends, the service may have taken it all the same.
        self._keep({**before, "sequence": numbered["sequence"], "place": list(place),
                    "known": farther(before["known"], moved), "taken_s": time.time()})
        try:
            if packet_format:  # first, since the vehicle waits for it; a step that is sent again is not taken twice
                packet = self._post({**numbered, "format": packet_format}, image)
                if packet is not None and send:
                    send(packet)
            answer = json.loads(self._post({**numbered, "format": "json"}, image))
        except Refused:
            self._keep(before)
            raise
        if answer["status"] == "converged":
            pose = answer["pose"]
            known = {"lat": pose["lat"], "lon": pose["lon"], "sigma_m": max(answer["sigma_m"]), "flown_m": 0.0}
            self._keep({**self._state, "known": known})
        return answer

    def _post(self, fields, image):
        path = f"/v1/tracks/{self.id}/steps"
        if image is None:
            return self._service.ask("POST", path, json.dumps(fields).encode(), "application/json")
        kind = "image/png" if image.startswith(b"\x89PNG") else "image/jpeg"
        return self._service.ask("POST", f"{path}?{as_query(fields)}", image, kind)

    def _keep(self, state):
        self._state = state
        if self._file:
            written = self._file.with_name(self._file.name + ".part")
            written.write_text(json.dumps(self._state))
            os.replace(written, self._file)
