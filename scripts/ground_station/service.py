"""HTTP with the service: what it refuses, and patience while it is away or busy."""
import base64
import contextlib
import email.utils
import http.client
import json
import socket
import sys
import threading
import time
import urllib.parse

ANSWER_TIME_S = 90.0  # a search may wait its turn for 30 s and take as long
SHORTEST_S = 0.2      # an attempt
MISSED_S = 1.5        # without an answer before that is said
BUSY = (408, 429, 502, 503, 504)
NOT_ROADFIX = "not-roadfix"


class Silent(Exception):
    """The service did not take a request within the client's patience; it may have taken it without being heard."""


class Refused(Exception):
    """The service's problem (RFC 9457): `status`, `code`, and what to do."""

    def __init__(self, status, problem):
        super().__init__(f"{status} {problem.get('code', '?')}: {problem.get('detail', '?')}")
        self.status = status
        self.problem = problem
        self.code = problem.get("code")

    @property
    def leaves_the_track(self):
        """As it was. Else whatever is in between may have refused what the service took."""
        return 400 <= self.status < 500 and self.code not in (None, NOT_ROADFIX)


def _not_roadfix(status, what):
    return Refused(status, {"code": NOT_ROADFIX, "detail": f"something other than Roadfix answered; {what}"})


class Service:
    """A connection that is kept. `url` may hold user:password, for a proxy that asks for them. `date_s`: when it
    answered last, in seconds since 1970 by its own clock; None where it does not say."""

    def __init__(self, url, patience_s=60.0):
        self._url = urllib.parse.urlsplit(url)
        if self._url.scheme not in ("http", "https") or not self._url.hostname:
            raise ValueError(f"'{url}' is no address of a service: write http://HOST:PORT")
        self._patience_s = patience_s
        self._connection = None
        self._is_missed = False
        self.date_s = None

    def page_of(self, track_id):
        """The operator's page that follows a track. Without the password: links are passed on."""
        host = self._url.netloc.rpartition("@")[2]
        return f"{self._url.scheme}://{host}{self._url.path.rstrip('/')}/#track={track_id}"

    def close(self):
        if self._connection is not None:
            self._connection.close()
        self._connection = None

    def ask(self, method, path, body=None, content_type=None, answer_type="application/json"):
        """The bytes of the answer, whose type begins with `answer_type`; None for 204. Sends again while the service is
        away or busy."""
        give_up = time.monotonic() + self._patience_s
        pause_s = 0.05
        while True:
            wait_s = pause_s
            try:
                self._connect(give_up - time.monotonic())
                answer, content = self._send(method, path, body, content_type)
                if answer.status not in BUSY:
                    self._say_that_it_answers()
                    return self._checked(answer, content, answer_type)
                reason = str(Refused(answer.status, self._problem(content)))
                wait_s = max(wait_s, self._retry_after_s(answer))
            except (OSError, http.client.HTTPException) as error:
                self.close()
                reason = str(error) or type(error).__name__
            left_s = give_up - time.monotonic()
            if wait_s > left_s:
                raise Silent(f"no answer of {self._url.hostname} within {self._patience_s:g} s ({reason})")
            if self._patience_s - left_s > MISSED_S:
                self._say_that_it_is_missed(reason, left_s)
            time.sleep(wait_s)
            pause_s = min(2.0 * pause_s, 2.0)

    def ask_object(self, members, *request):
        """The JSON object of the answer, which has these members."""
        content = self.ask(*request) or b""
        try:
            answer = json.loads(content)
        except (ValueError, RecursionError):
            answer = None
        if not isinstance(answer, dict) or any(name not in answer for name in members):
            raise _not_roadfix(200, f"an answer without {' and '.join(members)}")
        return answer

    def _say_that_it_is_missed(self, reason, left_s):
        """Once until it answers."""
        if not self._is_missed:
            print(f"no answer of {self._url.hostname} yet ({reason}): trying for {left_s:.0f} s more", file=sys.stderr)
        self._is_missed = True

    def _say_that_it_answers(self):
        if self._is_missed:
            print(f"{self._url.hostname} answers again", file=sys.stderr)
        self._is_missed = False

    def _connect(self, left_s):
        """For one attempt. A cut link says nothing: half of the time that is left remains for others. A step that the
        service is at meanwhile is not lost, since it is processed once."""
        if self._connection is None:
            secure = self._url.scheme == "https"
            kind = http.client.HTTPSConnection if secure else http.client.HTTPConnection
            self._connection = kind(self._url.hostname, self._url.port)
        self._connection.timeout = max(SHORTEST_S, min(ANSWER_TIME_S, 0.5 * left_s))
        if self._connection.sock is None:
            self._connection.connect()
        self._connection.sock.settimeout(self._connection.timeout)

    @contextlib.contextmanager
    def _in_time(self):
        """The time-out of a socket begins anew with each byte: what comes in drops is cut off."""
        was_cut_off = threading.Event()

        def cut_off(connected=self._connection.sock):
            was_cut_off.set()
            with contextlib.suppress(OSError):
                connected.shutdown(socket.SHUT_RDWR)

        timer = threading.Timer(self._connection.timeout, cut_off)
        timer.start()
        try:
            yield
        except (OSError, http.client.HTTPException):
            if not was_cut_off.is_set():
                raise
        finally:
            timer.cancel()
        if was_cut_off.is_set():
            raise TimeoutError("timed out")

    def _send(self, method, path, body, content_type):
        headers = {"Content-Type": content_type} if content_type else {}
        if self._url.username is not None:
            pair = f"{urllib.parse.unquote(self._url.username)}:{urllib.parse.unquote(self._url.password or '')}"
            headers["Authorization"] = "Basic " + base64.b64encode(pair.encode()).decode()
        with self._in_time():
            self._connection.request(method, self._url.path.rstrip("/") + path, body, headers)
            answer = self._connection.getresponse()
            self.date_s = self._date_s(answer)
            return answer, answer.read()

    def _checked(self, answer, content, answer_type):
        """Whatever is in between may answer, too: what asks to log in, or to pay, is no position."""
        if answer.status >= 400:
            raise Refused(answer.status, self._problem(content))
        if answer.status == 204:
            return None
        found = answer.headers.get("Content-Type", "")
        if answer.status in (200, 201) and found.startswith(answer_type):
            return content
        elsewhere = answer.headers.get("Location") if 300 <= answer.status < 400 else None
        raise _not_roadfix(answer.status,
                           f"redirected to {elsewhere}" if elsewhere else f"an answer of type '{found}'")

    @staticmethod
    def _problem(content):
        try:
            problem = json.loads(content)
        except (ValueError, RecursionError):
            problem = None
        return problem if isinstance(problem, dict) else {"detail": content[:200].decode(errors="replace")}

    @staticmethod
    def _date_s(answer):
        try:
            return email.utils.parsedate_to_datetime(answer.headers["Date"]).timestamp()
        except (TypeError, ValueError, OverflowError):
            return None

    @staticmethod
    def _retry_after_s(answer):
        value = answer.headers.get("Retry-After", "")
        return float(value) if value.isdigit() else 0.0
