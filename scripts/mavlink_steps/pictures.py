"""Pictures that appear in a folder."""
import math
import os
import pathlib
import sys
import time
from typing import NamedTuple

from lateness import Lateness

ENDINGS = {".jpg": b"\xff\xd9", ".jpeg": b"\xff\xd9", ".png": b"IEND\xaeB`\x82"}
QUIET_S = 1.0    # a file that ends otherwise, as some cameras' do, is taken once nothing was written for so long
READ_S = 10.0    # a file that is written anew sooner may be read for the line of the picture before
LOOKS = 500      # in each call at files that were taken: a camera leaves tens of thousands
MISSED_S = 10.0  # without a picture, or without anything in one


class Version(NamedTuple):
    """Of a file that may be written anew, and when it was, by time.monotonic(). `in_doubt`: the clock was set then."""
    date_ns: int
    size: int
    written: float
    in_doubt: bool

    @property
    def has_coarse_date(self):
        """In whole seconds, as FAT and copies over some links keep it, instead of fractions."""
        return self.date_ns % 1_000_000_000 == 0

    def is_of(self, status):
        return (self.date_ns, self.size) == (status.st_mtime_ns, status.st_size)


class NewPictures:
    """Those that are written after this was made, anew or under new names. `clock`: a WallClock, by which files have
    their dates. `every_s`: as Lateness has it. `have_come`: whether any had at the last call, be they left out."""

    def __init__(self, folder, clock, every_s=None):
        self._folder = pathlib.Path(folder)
        self._clock = clock
        self._others = set()   # names of what is no picture
        self._started = {}     # versions that are not complete, by their names
        self._finished = {}    # versions that were taken
        self._empty = set()    # names that were told of
        self._to_look_at = []  # of their names, the next one last
        self._lateness = Lateness(every_s)
        self.have_come = False
        self._fails = False
        for name in self._new(os.listdir(folder)):
            try:
                self._finished[name] = self._version(name, os.stat(self._folder / name))._replace(written=-math.inf)
            except OSError:  # removed meanwhile
                continue

    def __call__(self):
        """Path and time.monotonic() of each that is complete since the last call, the oldest first."""
        self.have_come = False
        try:
            new = self._new(os.listdir(self._folder))
        except OSError as error:
            self._say_that_it_fails(error)
            return []
        self._say_that_it_fails(None)
        complete = []
        for name in new | self._rewritten():
            try:
                version, is_whole = self._look_into(name)
            except OSError:  # renamed or removed meanwhile
                continue
            if is_whole or (version.size > 0 and time.monotonic() - version.written > QUIET_S):
                complete.append((version.written, self._folder / name, version))
            elif version.size == 0:
                self._say_that_it_stays_empty(name, version)
        self.have_come = bool(complete)
        return [(path, written) for written, path, version in sorted(complete) if self._take(path, version)]

    def _new(self, names):
        """Those of pictures that were not taken."""
        new = {name for name in names if name not in self._finished and name not in self._others}
        others = {name for name in new if os.path.splitext(name)[1].lower() not in ENDINGS}
        self._others |= others
        return new - others

    def _rewritten(self):
        """Those that were written since they were taken, as far as they are looked at now."""
        rewritten = set()
        if not self._to_look_at:
            self._to_look_at = sorted(self._finished, reverse=True)
        folder = str(self._folder)  # to join paths takes longer than to look at a file
        for name in self._to_look_at[-LOOKS:]:
            try:
                if not self._finished[name].is_of(os.stat(f"{folder}/{name}")):
                    rewritten.add(name)
            except OSError:  # removed
                continue
        del self._to_look_at[-LOOKS:]
        return rewritten

    def _look_into(self, name):
        """As it is, and whether it has the end of a picture."""
        ending = ENDINGS[os.path.splitext(name)[1].lower()]
        with open(self._folder / name, "rb") as file:
            file.seek(max(0, file.seek(0, os.SEEK_END) - len(ending)))
            is_whole = file.read() == ending
            self._started[name] = self._version(name, os.fstat(file.fileno()))
        return self._started[name], is_whole

    def _version(self, name, status):
        """With the time by the clock as it was set when this version was first seen."""
        seen = self._started.get(name)
        if seen is not None and seen.is_of(status):
            return seen
        return Version(status.st_mtime_ns, status.st_size, self._clock.monotonic(1e-9 * status.st_mtime_ns),
                       self._clock.was_set)

    def _take(self, path, version):
        """Whether it is known of which time and picture it is."""
        before = self._finished.get(path.name)
        self._finished[path.name] = self._started.pop(path.name)
        if version.in_doubt:
            print(f"{path} is left out: the clock was set while it was written", file=sys.stderr)
            return False
        if version.has_coarse_date:
            print(f"{path} is left out: its date is one in whole seconds: write into a folder that keeps fractions of "
                  "them (not FAT), or copy without keeping dates", file=sys.stderr)
            return False
        if before is not None and version.written - before.written < READ_S:
            print(f"{path} is left out: it was taken as it was {version.written - before.written:.1f} s before: give each "
                  "picture a name of its own, and write it without a pause", file=sys.stderr)
            return False
        return not self._lateness.is_late(path, version.written)

    def _say_that_it_stays_empty(self, name, version):
        if name not in self._empty and time.monotonic() - version.written > MISSED_S:
            self._empty.add(name)
            print(f"{self._folder / name} is empty", file=sys.stderr)

    def _say_that_it_fails(self, error):
        """Where it is not as before. None: it does not."""
        if self._fails != (error is not None):
            self._fails = not self._fails
            print(f"no pictures: {error}" if error else f"{self._folder} can be read again", file=sys.stderr)


def _newest_in(folder, is_asked_for):
    """Of its entries that are, and when it was written, or something was added to it, as a date. None where it holds
    none."""
    try:
        with os.scandir(folder) as entries:
            return max(((entry.stat().st_mtime, entry.path) for entry in entries if is_asked_for(entry)), default=None)
    except OSError:
        return None


def _is_other_file(entry):
    """But for tables, as of --csv, which no camera writes."""
    return entry.is_file() and os.path.splitext(entry.name)[1].lower() not in (*ENDINGS, ".csv")


class Silence:
    """Says where no picture comes into a folder though the autopilot speaks."""

    def __init__(self, folder):
        self._folder = folder
        self._last = time.monotonic()
        self._is_told = False

    def look(self, has_picture, heard):
        """`heard`: when the autopilot was, by time.monotonic()."""
        now = time.monotonic()
        if has_picture:
            if self._is_told:
                print("pictures come again", file=sys.stderr)
            self._last, self._is_told = now, False
        elif not self._is_told and now - self._last > MISSED_S and now - heard <= MISSED_S:
            self._is_told = True
            print(f"no picture has come for {now - self._last:.0f} s though the autopilot speaks: {self._question()}",
                  file=sys.stderr)

    def _question(self):
        since = time.time() - (time.monotonic() - self._last)
        for is_asked_for, question in (
                (os.DirEntry.is_dir, "does the camera go on in {}?"),
                (_is_other_file, f"only {', '.join(ENDINGS)} are read, and {{}} is something else")):
            newest = _newest_in(self._folder, is_asked_for)
            if newest is not None and newest[0] > since:
                return question.format(newest[1])
        return "does the camera write into the folder?"
