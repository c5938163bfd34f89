# SPDX-License-Identifier: BSD-3-Clause
"""Room detector: a one-stage, anchor-free network of plain 3x3 convolutions for six-channel RGB-D pictures."""
import torch
from torch import nn
from torch.nn import functional as F

STRIDES = (8, 16, 32)
EXTRAS = 3  # distance and front


def convolution(inputs, outputs, size=3, stride=1):
    return nn.Sequential(nn.Conv2d(inputs, outputs, size, stride, size // 2, bias=False), nn.BatchNorm2d(outputs), nn.ReLU(inplace=True))


class Residual(nn.Module):
    """Two convolutions beside the identity (He et al. 2016)."""

    def __init__(self, channels):
        super().__init__()
        self.first = convolution(channels, channels)
        self.second = nn.Sequential(nn.Conv2d(channels, channels, 3, 1, 1, bias=False), nn.BatchNorm2d(channels))

    def forward(self, x):
        return F.relu(x + self.second(self.first(x)))


class RoomDetector(nn.Module):
    """(B, 6, H, W) in [0, 1], H and W multiples of 16 -> (B, cells, classes + 7).

    Cells of strides 8, 16, 32, row by row. A cell has logits of the classes, then the distances of the box's left, top, right and
    bottom sides from the cell's centre in strides, as logarithms (after FCOS, Tian et al. 2019), then the logarithm of the distance of
    the object's middle in m, and cosine and sine of the angle about the vertical from the direction to the camera to the object's front.
    """

    def __init__(self, classes, channels=6):
        super().__init__()
        self.classes = classes
        self.stem = nn.Sequential(convolution(channels, 16, stride=2), convolution(16, 32, stride=2), Residual(32))
        self.third = nn.Sequential(convolution(32, 64, stride=2), Residual(64))
        self.fourth = nn.Sequential(convolution(64, 96, stride=2), Residual(96))
        self.fifth = nn.Sequential(convolution(96, 160, stride=2), Residual(160))
        width = 64
        self.lateral = nn.ModuleList(convolution(c, width, 1) for c in (64, 96, 160))
        self.smooth = nn.ModuleList(convolution(width, width) for _ in STRIDES)
        self.tower = nn.Sequential(convolution(width, width), convolution(width, width))
        self.output = nn.ModuleList(nn.Conv2d(width, classes + 4 + EXTRAS, 3, 1, 1) for _ in STRIDES)
        for layer in self.output:
            nn.init.normal_(layer.weight, std=0.01)
            nn.init.constant_(layer.bias, 0.0)
            nn.init.constant_(layer.bias[:classes], -4.6)  # a prior of 1 % (Lin et al. 2017)
            nn.init.constant_(layer.bias[classes:classes + 5], 0.7)

    def forward(self, x):
        third = self.third(self.stem(x))
        fourth = self.fourth(third)
        fifth = self.fifth(fourth)
        levels = [lateral(f) for lateral, f in zip(self.lateral, (third, fourth, fifth))]
        levels[1] = levels[1] + twice(levels[2], levels[1])
        levels[0] = levels[0] + twice(levels[1], levels[0])
        rows = []
        for level, smooth, output in zip(levels, self.smooth, self.output):
            rows.append(output(self.tower(smooth(level))).flatten(2))
        return torch.cat(rows, 2).transpose(1, 2)


def twice(coarse, fine):
    """The coarse level at the fine one's size, which may lack its last row or column."""
    return F.interpolate(coarse, scale_factor=2.0, mode="nearest")[:, :, :fine.shape[2], :fine.shape[3]]


def cells(height, width):
    """(cells, 3): centre u, v in px of the input and stride, in the order of the network's output."""
    rows = []
    for stride in STRIDES:
        v, u = torch.meshgrid(torch.arange(-(-height // stride)), torch.arange(-(-width // stride)), indexing="ij")
        rows.append(torch.stack([(u.flatten() + 0.5) * stride, (v.flatten() + 0.5) * stride,
                                 torch.full((u.numel(),), float(stride))], 1))
    return torch.cat(rows)


def split(output, classes):
    """Logits of the classes, logarithms of the sides, and the extras."""
    return output[..., :classes], output[..., classes:classes + 4], output[..., classes + 4:]


def boxes_of(output, grid, classes):
    """(..., cells, 4) corners u0, v0, u1, v1 in px of the input."""
    sides = torch.exp(split(output, classes)[1].clamp(-6, 5)) * grid[:, 2:3]
    return torch.cat([grid[:, :2] - sides[..., :2], grid[:, :2] + sides[..., 2:]], -1)


def folded(model):
    """The same function without batch norms: OpenCV 4.6 refuses what the exporter makes of equal ones."""
    model.eval()
    for module in list(model.modules()):
        if isinstance(module, nn.Sequential):
            for i in range(len(module) - 1):
                if isinstance(module[i], nn.Conv2d) and isinstance(module[i + 1], nn.BatchNorm2d):
                    module[i] = torch.nn.utils.fusion.fuse_conv_bn_eval(module[i], module[i + 1])
                    module[i + 1] = nn.Identity()
    strip = lambda s: nn.Sequential(*(m for m in s if not isinstance(m, nn.Identity)))
    for parent in list(model.modules()):
        for name, child in list(parent.named_children()):
            if isinstance(child, nn.Sequential):
                setattr(parent, name, strip(child))
    return model
