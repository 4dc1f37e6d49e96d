#!/usr/bin/python3
"""Makes the tiny networks of neural_detector_test.cpp (their weights are repeated there as the oracle)."""
from pathlib import Path

import torch
from torch import nn

HERE = Path(__file__).resolve().parent


def save(name, layer):
    torch.onnx.export(layer, torch.zeros(1, 3, 16, 16), str(HERE / name), opset_version=11)


def main():
    # Not symmetric in any way, so that turns, mirrors, and the order of channels are noticed.
    tiny = nn.Conv2d(3, 1, 3, stride=2, padding=1)
    with torch.no_grad():
        for channel in range(3):
            for row in range(3):
                for col in range(3):
                    tiny.weight[0, channel, row, col] = (channel + 1) * (3 * row + col - 3) / 60
        tiny.bias.fill_(0.25)
    save("tiny.onnx", tiny)
    save("two_channels.onnx", nn.Conv2d(3, 2, 1, stride=2))
    save("full_size.onnx", nn.Conv2d(3, 1, 1))


if __name__ == "__main__":
    main()
