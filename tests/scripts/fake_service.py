"""A service that fails in every way, for the tests of the ground station's client."""
import contextlib
import http.server
import json
import struct
import sys
import threading
import time
import urllib.parse
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "scripts" / "ground_station"
sys.path.insert(0, str(PROGRAM))

from crc import crc  # noqa: E402

#: What the program says of this service's map before a flight.
BEFORE = r"\S+Z the map 'm' has version 7f3a\n"

CONVERGED = (200, {"status": "converged", "pose": {"lat": 7.0, "lon": 8.0}, "sigma_m": [4.0, 2.0]})

#: What something in between answers.
BETWEEN = {"pay": (200, b"<html>Please pay</html>", "text/html"), "hello": (200, b'{"status": "ok"}')}


def step_of(path, body):
    """The fields of a step, however it was sent."""
    if body.startswith(b"{"):
        return json.loads(body)
    return dict(urllib.parse.parse_qsl(urllib.parse.urlsplit(path).query))


def packet_of(packet_format, told_s):
    """In the messages that say it, how long the service took."""
    if packet_format == "global_position_sensor":
        payload = struct.pack("<QI29x", 0, round(1e6 * told_s))
    elif packet_format == "command_int":
        payload = struct.pack("<ff27x", 0.0, told_s)
    else:
        return b"a position"
    checked = bytes([len(payload), *bytes(8)]) + payload
    return b"\xfd" + checked + crc(checked + bytes([158])).to_bytes(2, "little")


class FakeService:
    """Answers with what `script` says, a step at a time: a status, "hang up" before or "lose" after the request was
    taken, "pay" or "hello" where something in between answers, "still at it" where it takes the one before that it had
    not told of; then 200. A step takes `delay_s` when it comes first, and messages say that it took `told_s`. A track
    may be silent for an hour, and has been for `silent_s`; it is `gone` with a problem, or `never_begun` with one. What
    is asked about it is answered with what `script_about` says before that. `readiness` None: no answer."""

    TIME_OF_SILENCE_S = 3600.0

    def __init__(self, script=(), delay_s=0.0, told_s=None):
        self.script = list(script)
        self.script_about = []
        self.requests = []
        self.last = {}    # answer to the step that was taken
        self.before = {}  # step that came
        self.ended = []   # tracks
        self.came = set()
        self.silent_s = 0.0
        self.left_s = None  # of the time of silence; None: what follows from silent_s
        self.set_s = 0.0    # by which the clock was set since the last step
        self.gone = None
        self.never_begun = None
        self.map = (200, {"name": "m", "status": "ready", "version": "7f3a", "bbox": [38.2, 37.7, 38.3, 37.8]})
        self.readiness = {"status": "ready", "tracks": "ready"}
        fake = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def log_message(self, *_):
                pass

            def answer(self, status, content, content_type="application/json"):
                self.send_response(status)
                self.send_header("Content-Type", content_type)
                if 300 <= status < 400:
                    self.send_header("Location", "http://portal/")
                self.send_header("Content-Length", str(len(content)))
                if status == 503:
                    self.send_header("Retry-After", "1")
                self.end_headers()
                with contextlib.suppress(ConnectionError):  # a client that waits no longer
                    self.wfile.write(content)

            def do_GET(self):
                if self.path.startswith("/v1/maps/"):
                    status, content = fake.map
                    self.answer(status, json.dumps(content).encode())
                    return
                if self.path == "/readyz":
                    if fake.readiness is None:
                        self.close_connection = True
                        return
                    self.answer(200, json.dumps(fake.readiness).encode())
                    return
                said = fake.script_about.pop(0) if fake.script_about else fake.gone
                if isinstance(said, str) and said in BETWEEN:
                    self.answer(*BETWEEN[said])
                    return
                if said:
                    self.answer(said[0], json.dumps(said[1]).encode())
                    return
                last = {"last": {"status": "searching", **fake.last}} if fake.last else {}
                self.answer(200, json.dumps({**fake.track(fake.silent_s), **last}).encode())

            def do_DELETE(self):
                fake.ended.append(self.path)
                if fake.gone:
                    self.answer(fake.gone[0], json.dumps(fake.gone[1]).encode())
                    return
                self.answer(204, b"")

            def do_POST(self):
                body = self.rfile.read(int(self.headers["Content-Length"]))
                if self.path == "/v1/tracks":
                    fake.requests.append((self.path, body, dict(self.headers)))
                    fake.last = {}
                    if fake.never_begun:
                        self.answer(fake.never_begun[0], json.dumps(fake.never_begun[1]).encode())
                        return
                    self.answer(201, json.dumps(fake.track(0.0)).encode())
                    return
                step = step_of(self.path, body)
                if (self.path, body) not in fake.came:
                    fake.came.add((self.path, body))
                    time.sleep(delay_s)
                said = fake.script.pop(0) if fake.script else 200
                before, fake.before = fake.before, {name: int(step[name]) for name in ("sequence", "time_us")}
                if said == "hang up":
                    self.close_connection = True
                    return
                fake.requests.append((self.path, body, dict(self.headers)))
                if said == "still at it":
                    fake.last = before
                    said = (409, {"code": "step-differs"})
                status, answer = said if isinstance(said, tuple) else (said, {"code": "busy", "detail": "later"})
                if status in (200, "lose"):
                    told = answer if isinstance(said, tuple) else {"status": "searching"}
                    fake.last = {**told, **fake.before}
                if status == "lose":
                    self.close_connection = True
                elif status == 200 and step.get("format", "json") != "json":
                    self.answer(200, packet_of(step["format"], delay_s if told_s is None else told_s),
                                "application/x-" + step["format"])
                elif isinstance(said, str) and said in BETWEEN:
                    self.answer(*BETWEEN[said])
                elif status == 200:
                    self.answer(200, json.dumps(fake.last).encode())
                else:
                    self.answer(status, json.dumps(answer).encode())

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.server.serve_forever, args=(0.02,), daemon=True).start()
        self.url = f"http://127.0.0.1:{self.server.server_address[1]}"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.server.shutdown()
        self.server.server_close()

    def track(self, silent_s):
        left_s = self.TIME_OF_SILENCE_S - silent_s if self.left_s is None else self.left_s
        touched_us = round(1e6 * (time.time() - silent_s - self.set_s))
        return {"id": "T", "touched_us": touched_us, "silent_s": silent_s, "expires_in_s": left_s}

    def steps(self):
        return [step_of(path, body) for path, body, _ in self.requests if "/steps" in path]

    def begun(self):
        """What each track was begun with."""
        return [json.loads(body) for path, body, _ in self.requests if path == "/v1/tracks"]
