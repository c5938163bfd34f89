# SPDX-License-Identifier: BSD-3-Clause
"""Batches as they are trained on: mirrored, re-lit, with other textures and floors, seen from twice as far, with colour or depth left out."""
import numpy as np
import torch
from torch.nn import functional as F

from data import COLOR, DEPTH, FRONT, HEIGHT, HEIGHT_STEPS_PER_M, KIND, MIN_HEIGHT_PX, RANGE, SURE, U0, U1, V0, V1

NEAR_M = 0.4  # depth whose inverse is the channel's largest value
FAR_SHARE = 0.4  # of the batches' pictures


def on(device, values):
    return torch.as_tensor(np.asarray(values, np.float32)).to(device, non_blocking=True)


def far_away(pictures, boxes, limits_m):
    """(n, 4, ...) views -> (n, ...): four at half their size in one, everything twice as far (mosaic, Bochkovskiy et al. 2020, with the depth to match).

    The channel of depth holds its inverse's root (rgbdChannels()); what is then beyond the sensor's range, limits_m (n), has none.
    """
    count, _, channels, height, width = pictures.shape
    half = torch.empty((count, 4, channels, height // 2, width // 2), device=pictures.device)
    half[:, :, COLOR] = F.avg_pool2d(pictures[:, :, COLOR].flatten(0, 1), 2).view(count, 4, 3, height // 2, width // 2)
    half[:, :, DEPTH] = pictures[:, :, DEPTH, ::2, ::2]
    half[:, :, DEPTH.start] *= 0.5 ** 0.5
    least = on(pictures.device, (NEAR_M / limits_m) ** 0.5).view(-1, 1, 1, 1)
    half[:, :, DEPTH] *= (half[:, :, DEPTH.start] > least).unsqueeze(2)
    out = half.view(count, 2, 2, channels, height // 2, width // 2).permute(0, 3, 1, 4, 2, 5).reshape(count, channels, height, width)
    boxes = boxes.clone()
    boxes[..., U0:SURE] /= 2
    for k in range(4):
        boxes[:, k, :, [U0, U1]] += k % 2 * (width // 2)
        boxes[:, k, :, [V0, V1]] += k // 2 * (height // 2)
    boxes[..., RANGE] *= 2
    boxes[..., SURE] *= boxes[..., V1] - boxes[..., V0] >= MIN_HEIGHT_PX
    return out, boxes.flatten(1, 2)


def trimmed(boxes):
    """Without the columns of rows that no picture of the batch needs."""
    known = boxes[..., KIND] >= 0
    most = max(1, int(known.sum(1).max()))
    order = known.to(torch.uint8).sort(dim=1, descending=True, stable=True).indices[:, :most]
    return boxes.gather(1, order.unsqueeze(2).expand(-1, -1, boxes.shape[2]))


def drawn(views, count, random):
    """A batch of `count` pictures, about FAR_SHARE of them of four views each."""
    far = int(random.binomial(count, FAR_SHARE))
    numbers = random.integers(0, len(views), (count - far) + 4 * far)
    pictures, boxes = views.batch(numbers)
    near = count - far
    if not far:
        return pictures, trimmed(boxes)
    fours, their = far_away(pictures[near:].view(far, 4, *pictures.shape[1:]), boxes[near:].view(far, 4, *boxes.shape[1:]),
                            random.uniform(3, 8, far))
    own = torch.full((near, *their.shape[1:]), -1.0)
    own[:, :boxes.shape[1]] = boxes[:near]
    return torch.cat([pictures[:near], fours]), trimmed(torch.cat([own, their]))


def shrunk(pictures, boxes, factor):
    """Every `factor`-th pixel, so that no depth is made up between near and far."""
    if factor == 1:
        return pictures, boxes
    boxes = boxes.clone()
    boxes[..., U0:SURE] /= factor
    return pictures[:, :, ::factor, ::factor].contiguous(), boxes


def mirrored(pictures, boxes, which):
    """Left for right where `which` (B) says so."""
    width = pictures.shape[-1]
    pictures = torch.where(which.view(-1, 1, 1, 1), pictures.flip(-1), pictures)
    other = boxes.clone()
    other[..., U0], other[..., U1], other[..., FRONT] = width - boxes[..., U1], width - boxes[..., U0], -boxes[..., FRONT]
    return pictures, torch.where(which.view(-1, 1, 1), other, boxes)


def textured(colors, random):
    """(n, 3, H, W) seen through a filter of random weights each (Xu et al. 2021), mixed with what they were: edges stay where they are, colours and
    textures do not. What is rendered and what is real differ most in these."""
    count, size = len(colors), int(random.choice([1, 3, 3, 5]))
    weights = on(colors.device, random.normal(0, (3 * size * size) ** -0.5, (3 * count, 3, size, size)))
    around = F.pad(colors, [size // 2] * 4, mode="replicate").flatten(0, 1).unsqueeze(0)
    other = F.conv2d(around, weights, groups=count).view_as(colors)
    mean, spread = other.mean((2, 3), keepdim=True), other.std((2, 3), keepdim=True)
    other = (other - mean) / (spread + 1e-3) * colors.std((2, 3), keepdim=True) + colors.mean((2, 3), keepdim=True)
    kept = on(colors.device, random.random(count)).view(-1, 1, 1, 1)
    return (kept * colors + (1 - kept) * other).clamp(0, 1)


def shaded(colors, random):
    """Lighter here and darker there."""
    light = on(colors.device, random.uniform(0.5, 1.5, (len(colors), 1, 3, 4)))
    return (colors * F.interpolate(light, size=colors.shape[2:], mode="bilinear", align_corners=True)).clamp(0, 1)


def lowered(pictures, which, random):
    """Heights as where a table or a seat is the lowest level surface in view, and so taken for the floor."""
    heights = pictures[:, HEIGHT]
    steps = on(pictures.device, which * random.uniform(0.2, 0.9, len(pictures)) * HEIGHT_STEPS_PER_M / 255).view(-1, 1, 1)
    out = pictures.clone()
    out[:, HEIGHT] = torch.where(heights > 0, (heights - steps).clamp(min=1 / 255), heights)
    return out


def augmented(pictures, boxes, random, textures=0.0, floors=0.0):
    """Mirrored, re-lit, and without colour or depth in some; the boxes where the pictures are. `textures`, `floors`: shares that get others."""
    count, device = len(pictures), pictures.device
    boxes = boxes.to(device)
    each = lambda values: on(device, values).view(count, -1, 1, 1)
    pictures, boxes = mirrored(pictures, boxes, on(device, random.random(count)) < 0.5)
    if floors:
        pictures = lowered(pictures, random.random(count) < floors, random)
    which = torch.from_numpy((random.random(count) < textures).nonzero()[0]).to(device)
    if len(which):
        pictures[which, COLOR] = shaded(textured(pictures[which, COLOR], random), random)
    colors, depths = pictures[:, COLOR], pictures[:, DEPTH]
    fate = random.random(count)
    grey = each((fate >= 0.15) & (fate < 0.35))
    colors = colors + grey * (colors.mean(1, keepdim=True) - colors)
    gain = each(random.uniform(0.7, 1.4, (count, 1)) * random.uniform(0.85, 1.15, (count, 3)))
    colors = (colors * gain + each(random.uniform(-0.08, 0.08, count))).clamp(0, 1) ** each(random.uniform(0.7, 1.4, count))
    noise = each((random.random(count) < 0.3) * random.uniform(0, 0.05, count))
    colors = (colors + noise * torch.randn_like(colors)).clamp(0, 1) * each(fate >= 0.15)
    blind = fate > 0.9
    level_unknown = ~blind & (random.random(count) < 0.3)  # height and slope, as where no level surface is seen
    kept = np.stack([~blind, ~blind & ~level_unknown, ~blind & ~level_unknown], 1)
    return torch.cat([colors, depths * each(kept)], 1), boxes
