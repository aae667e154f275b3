"""Files that lights use, drawn by chance: IES profiles, images to project, images of skies."""
import io

import numpy as np
from PIL import Image


def ies_profile(c):
    """LM-63 of 2002, type C: a lamp that shines down, more or less evenly around, into one quarter, half or all planes."""
    vertical = np.linspace(0, c.choice([90, 180]), c.randint(7, 37))
    last = c.choice([0, 90, 180, 360])
    horizontal = np.linspace(0, last, 1 if last == 0 else c.randint(3, 13))
    narrow, side = c.log(0.5, 30), c.uniform(0, 0.6)
    planes = []
    for turn in np.radians(horizontal):
        around = 1 + side * np.cos(2 * turn)
        beam = 1000 * around * np.maximum(np.cos(np.radians(vertical) / 2), 0) ** (2 * narrow)
        planes.append(beam + c.uniform(0, 20))
    planes[-1] = planes[0] if last == 360 else planes[-1]
    row = lambda values: " ".join(f"{value:.4g}" for value in values)
    return "\r\n".join([
        "IESNA:LM-63-2002", "[TEST] drawn by chance", "[MANUFAC] none", "TILT=NONE",
        f"1 {c.choice([-1, 1000, 4000])} 1 {len(vertical)} {len(horizontal)} 1 2 0 0 0", "1 1 100",
        row(vertical), row(horizontal), *map(row, planes), ""]).encode("ascii")


def png(pixels):
    file = io.BytesIO()
    Image.fromarray((255 * np.clip(pixels, 0, 1)).astype(np.uint8)).save(file, "PNG")
    return file.getvalue()


def gobo_image(c):
    """Bars, spokes or holes, with hard or soft edges, gray or in colors."""
    size = c.choice([32, 100, 256])
    y, x = np.mgrid[0:size, 0:size] / (size - 1) * 2 - 1
    kind, count = c.choice(["bars", "spokes", "holes"]), c.randint(2, 9)
    if kind == "bars":
        wave = np.sin(np.pi * count * x)
    elif kind == "spokes":
        wave = np.sin(count * np.arctan2(y, x))
    else:
        wave = np.sin(np.pi * count * x) * np.sin(np.pi * count * y)
    mask = np.clip(0.5 + wave * c.log(0.5, 20), 0, 1) * (x * x + y * y < 1)
    return png(mask[..., None] * c.color(0.4, 0.95) if c.happens(0.5) else mask)


def rgbe(pixels):
    """A Radiance .hdr, its pixels not compressed."""
    brightest = np.maximum(pixels.max(-1), 1e-30)
    mantissa, exponent = np.frexp(brightest)
    packed = np.concatenate([pixels * (mantissa * 256 / brightest)[..., None], exponent[..., None] + 128], -1)
    height, width = pixels.shape[:2]
    return f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode() + packed.astype(np.uint8).tobytes()


def sky_image(c):
    """Blue above, brown below, clouds between, and mostly a sun of a degree or more."""
    height = c.choice([32, 64, 128])
    v, u = (np.mgrid[0:height, 0:2 * height] + 0.5) / height * np.pi
    up = np.cos(v)[..., None]
    image = np.where(up > 0, np.array([0.6, 0.8, 1]) + (1 - up) * 0.5, np.array([0.25, 0.2, 0.15]))
    image *= 1 + 0.5 * (np.sin(c.randint(2, 9) * u) * np.sin(c.randint(2, 9) * v))[..., None]
    if c.happens(0.7):
        at, high = c.uniform(0, 2 * np.pi), np.pi / 2 - c.uniform(0.1, 1.2)
        cosine = np.cos(v) * np.cos(high) + np.sin(v) * np.sin(high) * np.cos(u - at)
        disc = cosine > np.cos(max(np.radians(c.log(1, 8)), 1.1 * np.pi / height))
        image += (c.log(30, 3000) * disc)[..., None] * np.array([1, 0.9, 0.7])
    return rgbe(image)
