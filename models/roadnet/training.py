"""The training loop: deterministic crops, AdamW, averaged weights, checkpoints from which a later run goes on as if there had
been no stop."""
import math
import time
from pathlib import Path

import torch
from torch.utils.data import DataLoader, Sampler

from .losses import distillation_loss, road_loss, taught_in_a_random_orientation
from .metrics import evaluate_pairs
from .network import RoadNet, read_network
from .predict import TorchNetwork


class Consecutive(Sampler):
    """Crop numbers from `first` on, so that a resumed run goes on with fresh ones."""

    def __init__(self, first, last):
        super().__init__(None)
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
    with torch.no_grad():
        for target, source in zip(averaged.state_dict().values(), model.state_dict().values()):
            if target.dtype.is_floating_point:
                target.mul_(keep).add_(source, alpha=1 - keep)
            else:
                target.copy_(source)


def save(path, **state):
    partial = Path(str(path) + ".part")
    torch.save(state, partial)
    partial.replace(path)


def require_same_run(state, checkpoint, wanted):
    for name, value in wanted.items():
        if state[name] != value:
            raise SystemExit(f"{checkpoint} is of a run with {name} {state[name]:g}, not {value:g}: name another folder with --out, "
                             "or begin anew with --restart")


def train(crops, options):
    torch.manual_seed(options.seed)
    device = torch.device(options.device)
    start = read_network([options.begin_with]) if options.begin_with else RoadNet()
    model, averaged = start.to(device, memory_format=torch.channels_last), RoadNet().to(device)
    averaged.load_state_dict(model.state_dict())
    teacher = read_network(options.teacher).to(device, memory_format=torch.channels_last) if options.teacher else None
    for parameter in averaged.parameters():
        parameter.requires_grad_(False)
    optimizer = torch.optim.AdamW(model.parameters(), lr=options.rate, weight_decay=1e-3)
    first = 0
    checkpoint = Path(options.out) / "checkpoint.pt"
    if checkpoint.exists() and not options.restart:
        state = torch.load(checkpoint, map_location=device)
        require_same_run(state, checkpoint, {"gsd_m": crops.gsd_m, "seed": options.seed})
        model.load_state_dict(state["model"])
        averaged.load_state_dict(state["averaged"])
        optimizer.load_state_dict(state["optimizer"])
        first = state["step"]
        print(f"resume from {checkpoint} at step {first}", flush=True)
    turns = torch.Generator()
    batches = Consecutive(first * options.batch, options.steps * options.batch)
    loader = DataLoader(crops, options.batch, sampler=batches, num_workers=options.workers)
    started, running = time.time(), None
    over = False
    for step, (image, clean, label, weight) in zip(range(first, options.steps), loader):
        model.train()
        for group in optimizer.param_groups:
            group["lr"] = learning_rate(step, share_done(step, started, options), options.rate, options.cool)
        turns.manual_seed(options.seed + step)
        picture = image.to(device, memory_format=torch.channels_last)
        with torch.autocast(device.type, torch.bfloat16, enabled=options.bf16):
            logits = model(picture).float()
            with torch.no_grad():
                taught = taught_in_a_random_orientation(teacher, clean.to(device), turns).float() if teacher else None
        loss = road_loss(logits, label.to(device), weight.to(device))
        if teacher:
            loss = (1 - options.trust) * loss + options.trust * distillation_loss(logits, taught, picture)
        optimizer.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(model.parameters(), 5.0)
        optimizer.step()
        average_into(averaged, model, step)
        value = loss.item()
        if not math.isfinite(value):
            raise RuntimeError(f"the loss is {value} at step {step}: lower --rate")
        running = value if running is None else 0.98 * running + 0.02 * value
        done = step + 1
        over = share_done(done, started, options) >= 1.0
        if done % options.report == 0 or over:
            pace = (time.time() - started) / (done - first)
            print(f"step {done}/{options.steps}  loss {running:.4f}  {pace:.2f} s a step  "
                  f"{pace * (options.steps - done) / 60:.0f} min left", flush=True)
        if done % options.save_every == 0 or over:
            save(checkpoint, model=model.state_dict(), averaged=averaged.state_dict(), optimizer=optimizer.state_dict(),
                 step=done, gsd_m=crops.gsd_m, seed=options.seed)
        if done % options.validate_every == 0 or over:
            for name, figures in evaluate_pairs(TorchNetwork(averaged, device), crops.held_out, crops.gsd_m).items():
                print(f"  held out {name}: {figures}", flush=True)
        if over:
            break
    return averaged
