"""Whether the service takes what is the same of a whole flight, tried before it."""
import base64
import sys

from service import Refused
from steps import CAMERA_FIELDS, LENS_FIELDS, with_kind
from track import as_query, begin_track, end_track

#: A PNG of one black pixel. The service looks at what describes a picture only where there is one.
PIXEL = base64.b64decode("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNgAAAAAgABSK+kcQAAAABJRU5ErkJggg==")
WHAT_PICTURES_ARE = (*CAMERA_FIELDS, "kind", "cell_m")
AGL_M = 100.0  # of any flight


def try_out(service, request, frame_fields):
    """Begins the track, asks it for a step with the fields of --frame, and removes it. Throws what begin_track() does,
    and ValueError where each step would be refused for such a field."""
    track_id = begin_track(service, request)["id"]
    try:
        _try_step(service, track_id, frame_fields)
    finally:
        end_track(service, track_id)


def _try_step(service, track_id, frame_fields):
    fields = {"sequence": 1, "time_us": 1, "forward_m": 0, "right_m": 0, "turn_deg": 0, **_picture_fields(frame_fields)}
    try:
        service.ask_object((), "POST", f"/v1/tracks/{track_id}/steps?{as_query(fields)}", PIXEL, "image/png")
    except Refused as refusal:
        field = refusal.problem.get("field")  # there is none where only the pixel is wrong
        if field in frame_fields:
            raise ValueError(f"--frame: {refusal}") from None
        if refusal.code == "missing-parameter":
            print("--frame does not say what all pictures show, so their lines or files have to: "
                  f"{refusal.problem.get('detail')}", file=sys.stderr)


def _picture_fields(frame_fields):
    """With those that lines may tell."""
    fields = with_kind(frame_fields)
    if not any(name in fields for name in WHAT_PICTURES_ARE):
        fields = {**fields, "kind": "frame"}
    if any(name in fields for name in LENS_FIELDS):
        fields = {"agl_m": AGL_M, **fields}
    return fields
