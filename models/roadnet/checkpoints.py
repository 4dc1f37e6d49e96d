"""Networks as files: checkpoints of training runs, and exported ONNX files."""
import pickle
from pathlib import Path

import torch

from .network import Ensemble, RoadNet
from .unfold import read_onnx


def read_network(checkpoints):
    """The averaged weights of one checkpoint or ONNX file, or of several as the mean of their logits; in evaluation mode."""
    for path in checkpoints:
        require_file(path)
    members = [read_onnx(path) if Path(path).suffix == ".onnx" else averaged(path) for path in checkpoints]
    return Ensemble(members) if len(members) > 1 else members[0]


def require_file(path):
    if not Path(path).is_file():
        raise SystemExit(f"{path}: there is no such file")


def state_of(path):
    """What a checkpoint of models/train.py holds."""
    require_file(path)
    try:
        state = torch.load(path, map_location="cpu")
    except (pickle.UnpicklingError, RuntimeError, EOFError):
        state = None
    if not isinstance(state, dict) or not {"widths", "averaged"} <= state.keys():
        raise SystemExit(f"{path} is no checkpoint of models/train.py")
    return state


def averaged(path):
    state = state_of(path)
    network = RoadNet(state["widths"])
    network.load_state_dict(state["averaged"])
    return network.eval()


def mean_of_weights(checkpoints):
    """One network of the averaged weights' mean, for checkpoints of which one began with another (Wortsman et al. 2022,
    "Model soups"); in evaluation mode."""
    states = [state_of(path) for path in checkpoints]
    network = RoadNet(states[0]["widths"])
    network.load_state_dict({name: torch.stack([state["averaged"][name].double() for state in states]).mean(0).to(value.dtype)
                             for name, value in states[0]["averaged"].items()})
    return network.eval()
