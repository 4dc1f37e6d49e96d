"""A flight that the service follows, told where the vehicle's own estimator believes to be."""
import json
import math
import time
import urllib.parse

from service import Refused, Silent
from state import StateFile
from travel import Travel, movement

#: The last two: another client flew it, or the state file could not be written and is older than the track.
TRACK_IS_GONE = ("track-ended", "track-not-found", "map-replaced", "step-differs", "step-late")
MOVEMENT = ("forward_m", "right_m", "turn_deg")
PRIOR = ("lat", "lon", "radius_m", "bbox", "heading_deg", "heading_range_deg")
SET_BACK_US = 2e6  # a clock that was set back by less will soon be where it was
KEPT_TRACKS = 8    # before this one, for their history: the service follows only so many for a client
FASTEST_M_S = 50.0
STEP = ("sequence", "status")  # of its answer
WIDEST_M = 2e7  # of a prior: all of the Earth
DEGREE_M = 111_700.0  # at most


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
    was restarted goes on with the track that it had, unless that was long ago. `begun` is called with the id of each
    track that begins."""

    def __init__(self, service, request, state_file=None, begun=lambda track_id: None):
        self._service = service
        self._begun = begun
        self._request = dict(request)
        self._file = StateFile(state_file, request["map"])
        self._state = self._file.read()
        self._file.write(self._state)  # one that cannot be written is told of before the flight
        self._travel = Travel()
        self._asked_places = 0  # of it that the step without an answer spans

    @property
    def id(self):
        return self._state.get("id")

    def step(self, place, fields, image=None, origin=None, packet_format=None, send=None):
        """The answer to a step. `place`: (north_m, east_m, yaw_deg); where `origin` is another one than before, places
        are too, and the movement between is not known. `fields`: time_us and other fields of a step, `covariance` that
        of the movement since the last call of this or of pass_by(); `send` is called with the message for the autopilot
        in `packet_format`, if there is one."""
        self._travel.add(tuple(place), fields.get("covariance"))
        if not self.id:
            self._begin(origin, self._request)
        elif origin != self._state["origin"]:
            self._begin_near_the_last_place(origin)
        try:
            self._settle()
            return self._step(place, fields, image, packet_format, send)
        except Refused as refusal:
            if not self._is_over(refusal, fields):
                raise
            code = refusal.code
        # The service may have been at the step without an answer still when it was asked about it.
        if code != "step-differs" or not self._settle():
            self._begin_near_the_last_place(origin)
        return self._step(place, fields, image, packet_format, send)

    def pass_by(self, place, covariance):
        """A place that no step is made of, and the covariance of the movement to it. None where it is not known."""
        self._travel.add(place, covariance)

    def _is_over(self, refusal, fields):
        """Whether the track takes no step like that any more. The same map may have another version, the service may
        have been away for longer than it keeps a silent track, or a clock or the vehicle's frame jumped."""
        if refusal.code == "time-backwards":
            return fields["time_us"] < self._state.get("time_us", math.inf) - SET_BACK_US
        if refusal.code == "parameter-out-of-range":
            return refusal.problem.get("field") in MOVEMENT
        return refusal.code in TRACK_IS_GONE

    def _settle(self):
        """Whether there is a step without an answer that was taken after all. The next movement is then that since it,
        else since the step before it."""
        asked = self._state.get("asked")
        if not asked:
            return False
        last = self._service.ask_object(("id",), "GET", f"/v1/tracks/{self.id}").get("last", {})
        taken = all(last.get(name) == asked[name] for name in ("sequence", "time_us"))
        if taken:
            self._moved_on(asked, last)
        return taken

    def _begin(self, origin, request, known=None):
        track = self._service.ask_object(("id",), "POST", "/v1/tracks", json.dumps(request).encode(), "application/json")
        former = [*self._state.get("former", []), self.id] if self.id else []
        self._keep({"map": request["map"], "id": track["id"], "sequence": 0, "origin": origin,
                    "known": known or told_place(request), "taken_s": time.time(), "former": former[-KEPT_TRACKS:]})
        self._begun(track["id"])
        for track_id in former[:-KEPT_TRACKS]:
            self._end(track_id)

    def _end(self, track_id):
        try:
            self._service.ask("DELETE", f"/v1/tracks/{track_id}")
        except (Refused, Silent):  # it has ended by itself, or will
            pass

    def _begin_near_the_last_place(self, origin):
        """Around the place that was known last, as far as the vehicle may have flown since, however far that is: what
        was told of the start need not hold the vehicle any more."""
        request = {name: value for name, value in self._request.items() if name not in PRIOR}
        known = self._state.get("known")
        if known:
            since_s = max(0.0, time.time() - self._state["taken_s"])
            known = {**known, "flown_m": known["flown_m"] + FASTEST_M_S * since_s}
            request.update(lat=known["lat"], lon=known["lon"],
                           radius_m=min(known["within_m"] + known["flown_m"], WIDEST_M))
        self._begin(origin, request, known)

    def _moved_to(self, place):
        return movement(self._state["place"], place) if "place" in self._state else {}

    def _step(self, place, fields, image, packet_format, send):
        before = self._state
        moved = self._moved_to(place)
        covariance = self._travel.covariance() if moved else None  # the first step of a track has no movement
        fields = {name: value for name, value in fields.items() if name != "covariance"}
        if covariance is not None:
            fields["covariance"] = covariance
        numbered = {**fields, "sequence": before["sequence"] + 1, **moved}
        asked = {"sequence": numbered["sequence"], "time_us": fields["time_us"], "place": list(place),
                 "known": farther(before["known"], moved), "taken_s": time.time()}
        # Before it is sent: where the answer is lost, or this client ends, the service may have taken it all the same.
        self._keep({**before, "asked": asked})
        asked_before, self._asked_places = self._asked_places, len(self._travel)
        taken = False
        try:
            if packet_format:  # first, since the vehicle waits for it; a step that is sent again is not taken twice
                packet = self._service.ask(*self._request_of({**numbered, "format": packet_format}, image),
                                           "application/x-")
                taken = True
                if packet is not None and send:
                    send(packet)
            answer = self._service.ask_object(STEP, *self._request_of({**numbered, "format": "json"}, image))
        except Refused as refusal:
            if not taken and refusal.leaves_the_track:
                self._asked_places = asked_before
                self._keep(before)
            raise
        self._moved_on(asked, answer)
        return answer

    def _moved_on(self, asked, answer):
        """With a step that the service has taken."""
        self._travel.taken(self._asked_places)
        self._asked_places = 0
        state = {**self._state, **asked}
        del state["asked"]
        if answer["status"] == "converged":
            pose = answer["pose"]
            state["known"] = {"lat": pose["lat"], "lon": pose["lon"],
                              "within_m": 100.0 + 5.0 * max(answer["sigma_m"]), "flown_m": 0.0}
        self._keep(state)

    def _request_of(self, fields, image):
        path = f"/v1/tracks/{self.id}/steps"
        if image is None:
            return "POST", path, json.dumps(fields).encode(), "application/json"
        kind = "image/png" if image.startswith(b"\x89PNG") else "image/jpeg"
        return "POST", f"{path}?{as_query(fields)}", image, kind

    def _keep(self, state):
        self._state = state
        self._file.keep(state)
