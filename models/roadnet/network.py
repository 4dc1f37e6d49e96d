"""A small U-Net with strip context. Input N x 3 x H x W (H, W multiples of 16), output logits N x 1 x H/2 x W/2."""
import torch
from torch import nn
from torch.nn import functional as F


def conv(inputs, outputs, kernel=3, stride=1, dilation=1, groups=1):
    kernel = (kernel, kernel) if isinstance(kernel, int) else kernel
    padding = tuple(k // 2 * dilation for k in kernel)
    return nn.Sequential(
        nn.Conv2d(inputs, outputs, kernel, stride, padding, dilation, groups, bias=False),
        nn.BatchNorm2d(outputs),
        nn.ReLU(inplace=True))


class StripContext(nn.Module):
    """Looks along rows and columns: roads are long and thin, and gaps under trees or debris are bridged along them."""

    def __init__(self, channels, length=9):
        super().__init__()
        self.along = conv(channels, channels, (1, length), groups=channels)
        self.across = conv(channels, channels, (length, 1), groups=channels)
        self.mix = conv(channels, channels, 1)

    def forward(self, x):
        return x + self.mix(self.along(x) + self.across(x))


class RoadNet(nn.Module):
    def __init__(self, widths=(16, 32, 64, 96, 128)):
        super().__init__()
        w0, w1, w2, w3, w4 = widths
        self.stem = conv(3, w0)
        self.down1 = nn.Sequential(conv(w0, w1, stride=2), conv(w1, w1))
        self.down2 = nn.Sequential(conv(w1, w2, stride=2), conv(w2, w2))
        self.down3 = nn.Sequential(conv(w2, w3, stride=2), conv(w3, w3))
        self.down4 = nn.Sequential(conv(w3, w4, stride=2), conv(w4, w4, dilation=2), StripContext(w4), conv(w4, w4, dilation=4))
        self.up3 = nn.Sequential(conv(w4 + w3, w3), StripContext(w3), conv(w3, w3))
        self.up2 = nn.Sequential(conv(w3 + w2, w2), conv(w2, w2))
        self.up1 = nn.Sequential(conv(w2 + w1, w1), conv(w1, w1))
        self.head = nn.Conv2d(w1, 1, 1)
        nn.init.constant_(self.head.bias, -2.0)  # roads cover about a tenth

    def forward(self, x):
        x1 = self.down1(self.stem(x))
        x2 = self.down2(x1)
        x3 = self.down3(x2)
        x4 = self.down4(x3)
        y = self.up3(torch.cat([twice(x4), x3], 1))
        y = self.up2(torch.cat([twice(y), x2], 1))
        y = self.up1(torch.cat([twice(y), x1], 1))
        return self.head(y)


def twice(x):
    return F.interpolate(x, scale_factor=2.0, mode="nearest")
