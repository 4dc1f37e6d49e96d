"""A flight that the service follows, told where the vehicle's own estimator believes to be."""
import json
import math
import sys
import urllib.parse

from estimator import Estimator
from places import FASTEST_M_S, around, claimed_place, left, length_m, told_place, without_prior
from service import ANSWER_TIME_S, Refused, Silent
from silence import (FORGOTTEN_S, is_forgotten_by_date, moment, since, since_by_service, since_in_this_boot,
                     time_of_silence, was_asked_lately)
from state import StateFile
from travel import Travel, movement

#: The last two: another client flew it, or the state file could not be written and is older than the track.
TRACK_IS_GONE = ("track-ended", "track-not-found", "map-replaced", "step-differs", "step-late")
MOVEMENT = ("forward_m", "right_m", "turn_deg")
SET_BACK_US = 2e6  # a clock that was set back by less will soon be where it was
STILL_M = 5.0      # of which a start is told anyway
KEPT_TRACKS = 8    # before this one, for their history: the service follows only so many for a client
STEP = ("sequence", "status")  # of its answer


def as_query(fields):
    def text(value):
        if isinstance(value, (list, tuple)):
            return ",".join(map(text, value))
        return value if isinstance(value, str) else json.dumps(value)
    return urllib.parse.urlencode({name: text(value) for name, value in fields.items()})


class WrongTrack(Exception):
    """What is told of the track, with which none can begin, whenever it is asked for."""


def begin_track(service, request):
    """The service's answer. Throws WrongTrack, Refused, Silent."""
    try:
        return service.ask_object(("id",), "POST", "/v1/tracks", json.dumps(request).encode(), "application/json")
    except Refused as refusal:
        if refusal.status == 400 and refusal.leaves_the_track:
            raise WrongTrack(f"--track: {refusal}") from None
        raise


def end_track(service, track_id):
    try:
        service.ask("DELETE", f"/v1/tracks/{track_id}")
    except (Refused, Silent):  # it has ended by itself, or will
        pass


class Track:
    """A flight that the service follows. `request`: the members of POST /v1/tracks. With `state_file` a client that
    was restarted goes on with the track that it had, unless that was long ago. `begun` is called with the id of each
    track that begins. What it was and is no longer known is said on standard error."""

    def __init__(self, service, request, state_file=None, begun=lambda track_id: None):
        self._service = service
        self._begun = begun
        self._request = dict(request)
        self._file = StateFile(state_file, request["map"])
        self._state = self._file.read()
        write = self._file.keep if was_asked_lately(self._state) else self._file.write
        write(self._state)  # one that cannot be written begins no flight, but ends none
        self._of_another_process = bool(self._state)
        self._estimator = Estimator()
        self._travel = Travel()
        self._asked_places = 0  # of it that the step without an answer spans
        self._start = None  # the place of the first call of step() or pass_by(), and when that was

    @property
    def id(self):
        return self._state.get("id")

    def step(self, place, fields, image=None, origin=None, packet_format=None, send=None):
        """The answer to a step. `place`: (north_m, east_m, yaw_deg), None where it is not known; where `origin` is
        another one than before, places are too, and the movement between is not known. `fields`: time_us and other
        fields of a step, `covariance` that of the movement since the last call of this or of pass_by(); `send` is
        called with the message for the autopilot in `packet_format`, if there is one."""
        place = self._go_to(place, fields.get("covariance"))
        if self._of_another_process:
            self._recall(origin)
        if not self.id:
            self._begin(origin, self._request_at(place))
        elif origin != self._state["origin"]:
            self._take_origin(origin)
        try:
            self._settle()
            return self._step(place, fields, image, packet_format, send)
        except Refused as refusal:
            if not self._is_over(refusal, fields):
                raise
            over = refusal
        # The service may have been at the step without an answer still when it was asked about it.
        if over.code != "step-differs" or not self._settle():
            jumped = over.problem.get("field") in MOVEMENT
            self._begin_near_the_last_place(origin, over, 0.0 if jumped else length_m(self._moved_to(place)))
        return self._step(place, fields, image, packet_format, send)

    def pass_by(self, place, covariance):
        """A place that no step is made of, and the covariance of the movement to it. None where it is not known."""
        self._go_to(place, covariance)

    def _go_to(self, told, covariance):
        """The place, None where it is not known."""
        place = self._estimator.place(told)
        self._travel.add(place, covariance)
        if self._start is None:
            self._start = {"place": place, **moment()}
        if place != told:
            self._forget_place()  # nobody knows from where the estimator will go on
        return place

    def _request_at(self, place):
        """Of the first track, which may begin late, where the service was away: the start is as far behind as the
        vehicle may have flown."""
        begun = self._start["place"]
        flown_m = length_m(movement(begun, place)) if begun and place else FASTEST_M_S * since(self._start)
        known = told_place(self._request) if flown_m > STILL_M else None
        return around(left(known, flown_m), self._request) if known else self._request

    def _take_origin(self, origin):
        """Of a place of which it is not known how the vehicle came there. Where it is not known either where it came
        from, the track goes on."""
        if self._state.get("place"):
            self._begin_near_the_last_place(origin, "the vehicle's frame has another origin")
        else:
            self._forget_place()
            self._state = {**self._state, "origin": origin}

    def _forget_place(self):
        """That of the last step, and of one without an answer: the movement from there is not known."""
        self._state = {**self._state, "place": None}
        if "asked" in self._state:
            self._state["asked"] = {**self._state["asked"], "place": None}

    def _recall(self, origin):
        """The flight of another process: this one goes on with it, or it was long ago, or nobody knows when."""
        since_s, taking_s = since_in_this_boot(self._state), 0.0
        if since_s is None:
            since_s, taking_s = self._since_by_service(), ANSWER_TIME_S
        if since_s is None:
            self._begin(origin, without_prior(self._request),
                        f"anywhere on the map, since it is not known how long ago the last step of {self._file} was; "
                        "to begin where --track says, remove that file before the start")
        elif since_s >= FORGOTTEN_S and not was_asked_lately(self._state):
            print(f"the flight of {self._file} was long ago: a new one begins", file=sys.stderr)
            self._state = {}
        else:
            self._state = {**self._state, **moment(since_s + taking_s)}
        self._of_another_process = False

    def _since_by_service(self):
        """Seconds. None where that is not known, infinite where it was on another day."""
        if not self.id:
            return None
        try:
            track = self._ask_about_track()
        except Refused as refusal:
            if refusal.code not in TRACK_IS_GONE:
                raise
            track = {}
        since_s = since_by_service(self._state, track, self._service.date_s)
        return math.inf if since_s is None and is_forgotten_by_date(self._state, track) else since_s

    def _is_over(self, refusal, fields):
        """Whether the track takes no step like that any more. The same map may have another version, the service may
        have been away for longer than it keeps a silent track, or a clock or the vehicle's frame jumped."""
        if refusal.code == "time-backwards":
            return fields["time_us"] < self._state.get("time_us", math.inf) - SET_BACK_US
        if refusal.code == "parameter-out-of-range":
            return refusal.problem.get("field") in MOVEMENT
        return refusal.code in TRACK_IS_GONE

    def _ask_about_track(self):
        return self._service.ask_object(("id",), "GET", f"/v1/tracks/{self.id}")

    def _settle(self):
        """Whether there is a step without an answer that was taken after all. The next movement is then that since it,
        else since the step before it."""
        asked = self._state.get("asked")
        answer = self._answer_to(asked) if asked else None
        if answer:
            self._moved_on(asked, answer)
        return answer is not None

    def _answer_to(self, asked):
        """To the step that the service took last. None where that is another one."""
        last = self._ask_about_track().get("last", {})
        return last if all(last.get(name) == asked[name] for name in ("sequence", "time_us")) else None

    def _begin(self, origin, request, why=None):
        track = begin_track(self._service, request)
        former = [*self._state.get("former", []), self.id] if self.id else []
        self._keep({"map": request["map"], "id": track["id"], "sequence": 0, "origin": origin,
                    "known": told_place(request), "time_of_silence_s": time_of_silence(track), **moment(),
                    "former": former[-KEPT_TRACKS:]})
        if why:
            print(f"a new track begins: {why}", file=sys.stderr)
        self._begun(track["id"])
        for track_id in former[:-KEPT_TRACKS]:
            end_track(self._service, track_id)

    def _begin_near_the_last_place(self, origin, why, moved_m=0.0):
        """Around the place that was known last, as far as the vehicle may have flown since, however far that is: what
        was told of the start need not hold the vehicle any more. `moved_m`: since the last step."""
        known = left(self._state["known"], max(moved_m, FASTEST_M_S * since(self._state)))
        self._begin(origin, around(known, self._request), why)

    def _moved_to(self, place):
        """{} where that is not known."""
        before = self._state.get("place")
        return movement(before, place) if before and place else {}

    def _flown_m(self, moved, time_us):
        """Since the last step, at most where the movement is not known."""
        if moved:
            return length_m(moved)
        return FASTEST_M_S * max(since(self._state), 1e-6 * (time_us - self._state.get("time_us", time_us)))

    def _step(self, place, fields, image, packet_format, send):
        before = self._state
        moved = self._moved_to(place)
        covariance = self._travel.covariance() if moved else None  # the first step of a track has no movement
        fields = {name: value for name, value in fields.items() if name != "covariance"}
        if covariance is not None:
            fields["covariance"] = covariance
        numbered = {**fields, "sequence": before["sequence"] + 1, **moved}
        asked = {"sequence": numbered["sequence"], "time_us": fields["time_us"], "place": place,
                 "known": left(before["known"], self._flown_m(moved, fields["time_us"])), **moment()}
        # Before it is sent: where the answer is lost, or this client ends, the service may have taken it all the same.
        self._keep({**before, "asked": asked}, synced=False)  # the vehicle waits, so not for the disk
        asked_before, self._asked_places = self._asked_places, len(self._travel)
        taken = False
        try:
            if packet_format:  # first, since the vehicle waits for it
                packet = self._service.ask(*self._request_of({**numbered, "format": packet_format}, image),
                                           "application/x-")
                taken = True
                if packet is not None and send:
                    send(packet)
                answer = self._answer_to(asked)  # so that the picture is sent once
                if not answer:
                    raise Refused(409, {"code": "step-differs", "detail": "another client flies this track, too"})
            else:
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
            state["known"] = claimed_place(answer)
        self._keep(state)

    def _request_of(self, fields, image):
        path = f"/v1/tracks/{self.id}/steps"
        if image is None:
            return "POST", path, json.dumps(fields).encode(), "application/json"
        kind = "image/png" if image.startswith(b"\x89PNG") else "image/jpeg"
        return "POST", f"{path}?{as_query(fields)}", image, kind

    def _keep(self, state, synced=True):
        self._state = state
        self._file.keep(state, synced)
