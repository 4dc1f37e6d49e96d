"""A small residual U-Net with strip context. Input N x 3 x H x W (H, W multiples of 16), output logits N x 1 x H/2 x W/2.

The first convolution already halves the resolution and skips are added, not joined: what is left runs at the output's
resolution or coarser, where a processor's time buys the most.
"""
import torch
from torch import nn
from torch.nn import functional as F


def conv(inputs, outputs, kernel=3, stride=1, dilation=1):
    kernel = (kernel, kernel) if isinstance(kernel, int) else kernel
    padding = tuple(k // 2 * dilation for k in kernel)
    return nn.Sequential(
        nn.Conv2d(inputs, outputs, kernel, stride, padding, dilation, bias=False),
        nn.BatchNorm2d(outputs),
        nn.ReLU(inplace=True))


class Residual(nn.Module):
    def __init__(self, channels, dilation=1):
        super().__init__()
        self.first = conv(channels, channels, dilation=dilation)
        self.second = nn.Sequential(nn.Conv2d(channels, channels, 3, 1, 1, bias=False), nn.BatchNorm2d(channels))

    def forward(self, x):
        return F.relu(x + self.second(self.first(x)))


class StripContext(nn.Module):
    """Looks along rows and columns: roads are long and thin, and gaps under trees or debris are bridged along them."""

    def __init__(self, channels, length=9):
        super().__init__()
        few = channels // 4
        self.reduce = conv(channels, few, 1)
        self.along = conv(few, few, (1, length))
        self.across = conv(few, few, (length, 1))
        self.mix = conv(2 * few, channels, 1)

    def forward(self, x):
        y = self.reduce(x)
        return x + self.mix(torch.cat([self.along(y), self.across(y)], 1))


SMALL = (24, 48, 80, 112)  # channels of the four levels


class RoadNet(nn.Module):
    def __init__(self, widths=SMALL):
        super().__init__()
        self.widths = tuple(widths)
        w1, w2, w3, w4 = widths
        self.down1 = nn.Sequential(conv(3, w1, 5, stride=2), Residual(w1))
        self.down2 = nn.Sequential(conv(w1, w2, stride=2), Residual(w2))
        self.down3 = nn.Sequential(conv(w2, w3, stride=2), Residual(w3))
        self.down4 = nn.Sequential(conv(w3, w4, stride=2), Residual(w4, dilation=2), StripContext(w4), Residual(w4, dilation=4))
        self.lift3, self.up3 = conv(w4, w3, 1), nn.Sequential(StripContext(w3), Residual(w3))
        self.lift2, self.up2 = conv(w3, w2, 1), Residual(w2)
        self.lift1, self.up1 = conv(w2, w1, 1), Residual(w1)
        self.head = nn.Conv2d(w1, 1, 1)
        nn.init.constant_(self.head.bias, -2.0)  # roads cover about a tenth

    def forward(self, x):
        x1 = self.down1(x)
        x2 = self.down2(x1)
        x3 = self.down3(x2)
        y = self.up3(x3 + twice(self.lift3(self.down4(x3))))
        y = self.up2(x2 + twice(self.lift2(y)))
        y = self.up1(x1 + twice(self.lift1(y)))
        return self.head(y)


class Ensemble(nn.Module):
    """Mean of the logits of networks that were taught differently and therefore err differently."""

    def __init__(self, members):
        super().__init__()
        self.members = nn.ModuleList(members)

    def forward(self, x):
        return sum(member(x) for member in self.members) / len(self.members)


def twice(x):
    return F.interpolate(x, scale_factor=2.0, mode="nearest")
