"""The training loop: deterministic crops, AdamW, averaged weights, checkpoints from which a later run goes on as if there had
been no stop."""
import math
import time
from pathlib import Path

import torch
from torch.utils.data import DataLoader, Sampler

from .alignment import alignment_loss, random_footprint
from .checkpoints import read_network
from .losses import distillation_loss, in_a_random_orientation, road_loss, share_of_road
from .metrics import evaluate_pairs
from .network import RoadNet
from .normalise import network_input
from .predict import TorchNetwork
from .unfold import settle


SETTLED_WITH = 64  # crops


class Consecutive(Sampler):
    """Crop numbers from `first` on, so that a resumed run goes on with fresh ones."""

    def __init__(self, first, last):
        self.first, self.last = first, last

    def __iter__(self):
        return iter(range(self.first, self.last))

    def __len__(self):
        return self.last - self.first


def learning_rate(step, done, peak, cool):
    """Short warm-up, constant, then a straight line to zero over the last `cool` share; `done` in [0, 1]."""
    warm = min(1.0, (step + 1) / 50)
    return peak * warm * min(1.0, max(0.02, (1.0 - done) / max(1e-6, cool)))


def share_done(step, started, options):
    """Of the steps, or of the minutes where those run out first."""
    by_time = (time.time() - started) / 60 / options.minutes if options.minutes > 0 else 0.0
    return min(1.0, max(step / options.steps, by_time))


def average_into(averaged, model, step, decay=0.998):
    keep = min(decay, (step + 1) / (step + 10))
    pairs = [list(group) for group in zip(*((t, s) for t, s in zip(averaged.state_dict().values(), model.state_dict().values())
                                            if t.dtype.is_floating_point))]
    with torch.no_grad():
        torch._foreach_mul_(pairs[0], keep)
        torch._foreach_add_(pairs[0], pairs[1], alpha=1 - keep)


def save(path, **state):
    partial = Path(str(path) + ".part")
    torch.save(state, partial)
    partial.replace(path)


def identity_of(options, crops):
    """What a run learns from and how: all but how long it takes, where it runs, and what it reports and saves when."""
    how = ("seed", "batch", "size", "rate", "cool", "ramp", "trust", "align")
    sets = [{name: value for name, value in vars(each).items() if name not in ("terms", "attribution")} for each in crops.sets]
    return {"gsd_m": crops.gsd_m, "widths": tuple(options.widths), **{name: getattr(options, name) for name in how},
            "begin_with": str(options.begin_with), "teacher": list(map(str, options.teacher)),
            "sets": [each["name"] for each in sets], **{f"set {number}": each for number, each in enumerate(sets, 1)}}


def require_same_run(state, checkpoint, wanted):
    for name, value in wanted.items():
        if state.get(name) != value:
            raise SystemExit(f"{checkpoint} is of a run with {name} {state.get(name)}, not {value}: name another folder with --out, "
                             "or begin anew with --restart")


def told(logits, label, weight, taught, picture, trust):
    """The loss of the labels and, where there is one, of the teacher."""
    loss = road_loss(logits, label / 255, weight.float())
    if taught is None:
        return loss
    return (1 - trust) * loss + trust * distillation_loss(logits, taught, picture)


class Run:
    """A network in training, its average and its optimizer, and how they are kept in a checkpoint."""

    def __init__(self, options, crops):
        self.device = torch.device(options.device)
        self.precision = torch.autocast(self.device.type, torch.bfloat16, enabled=options.bf16)
        self.identity = identity_of(options, crops)
        self.checkpoint = Path(options.out) / "checkpoint.pt"
        start = read_network([options.begin_with]) if options.begin_with else RoadNet(options.widths)
        if start.widths != self.identity["widths"]:
            raise SystemExit(f"{options.begin_with} has the widths {start.widths}: give the same with --widths")
        if options.begin_with and options.begin_with.suffix == ".onnx":
            settle(start, torch.cat([network_input(*map(torch.from_numpy, (picture[None], seen[None])))
                                     for picture, seen, *_ in map(crops.__getitem__, range(SETTLED_WITH))]))
        self.model = start.to(self.device, memory_format=torch.channels_last)
        self.averaged = RoadNet(options.widths).to(self.device).requires_grad_(False)
        self.averaged.load_state_dict(self.model.state_dict())
        self.teacher = read_network(options.teacher).to(self.device, memory_format=torch.channels_last) if options.teacher else None
        self.optimizer = torch.optim.AdamW(self.model.parameters(), lr=options.rate, weight_decay=1e-3)
        self.step = 0
        if self.checkpoint.exists() and not options.restart:
            self.resume()

    def resume(self):
        state = torch.load(self.checkpoint, map_location=self.device)
        require_same_run(state, self.checkpoint, self.identity)
        for name in ("model", "averaged", "optimizer"):
            getattr(self, name).load_state_dict(state[name])
        self.step = state["step"]
        print(f"resume from {self.checkpoint} at step {self.step}", flush=True)

    def save(self):
        states = {name: getattr(self, name).state_dict() for name in ("model", "averaged", "optimizer")}
        save(self.checkpoint, **states, step=self.step, **self.identity)

    def loss(self, crops, options):
        """Of the labels and, where there are such, of the teacher and of frames."""
        changed, seen, clean, clean_seen, label, weight, *frames = (part.to(self.device, non_blocking=True) for part in crops)
        generator = torch.Generator().manual_seed(options.seed + self.step)
        taught = None
        if self.teacher:
            with torch.no_grad():
                taught = self.in_any_orientation(self.teacher, network_input(clean, clean_seen), generator)
        picture = network_input(changed, seen).contiguous(memory_format=torch.channels_last)
        with self.precision:
            logits = self.model(picture).float()
        loss = told(logits, label, weight, taught, picture, options.trust)
        if not frames:
            return loss
        footprint = random_footprint(logits.shape[-1], generator)
        changed, visible, weight, label = (part[footprint.pixels()] for part in (*frames, label))
        picture = network_input(changed, visible)
        found = self.in_any_orientation(self.model, picture, generator)
        taught = None if taught is None else taught[footprint.cells()]
        loss = (loss + told(found, label, weight, taught, picture, options.trust)) / 2
        return loss + options.align * alignment_loss(found, visible, logits, seen, footprint, share_of_road(label, weight))

    def in_any_orientation(self, network, picture, generator):
        with self.precision:
            return in_a_random_orientation(network, picture, generator).float()

    def learn(self, crops, rate, options):
        self.model.train()
        for group in self.optimizer.param_groups:
            group["lr"] = rate
        loss = self.loss(crops, options)
        self.optimizer.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.model.parameters(), 5.0)
        self.optimizer.step()
        average_into(self.averaged, self.model, self.step)
        self.step += 1
        return loss.detach()


def train(crops, options):
    torch.manual_seed(options.seed)
    torch.backends.cudnn.benchmark = True  # every step has the same shape
    run = Run(options, crops)
    first, started, running = run.step, time.time(), None
    numbers = Consecutive(first * options.batch, options.steps * options.batch)
    for batch in DataLoader(crops, options.batch, sampler=numbers, num_workers=options.workers, pin_memory=run.device.type == "cuda"):
        loss = run.learn(batch, learning_rate(run.step, share_done(run.step, started, options), options.rate, options.cool), options)
        running = loss if running is None else 0.98 * running + 0.02 * loss
        over = share_done(run.step, started, options) >= 1.0
        if run.step % options.report == 0 or over:
            if not math.isfinite(running.item()):
                raise RuntimeError(f"the loss is {running.item()} at step {run.step}: lower --rate")
            pace = (time.time() - started) / (run.step - first)
            print(f"step {run.step}/{options.steps}  loss {running.item():.4f}  {pace:.3f} s a step  "
                  f"{pace * (options.steps - run.step) / 60:.0f} min left", flush=True)
        if run.step % options.save_every == 0 or over:
            run.save()
        if crops.held_out and (run.step % options.validate_every == 0 or over):
            for name, figures in evaluate_pairs(TorchNetwork(run.averaged, run.device), crops.held_out, crops.gsd_m).items():
                print(f"  held out {name}: {figures}", flush=True)
        if over:
            break
    return run.averaged
