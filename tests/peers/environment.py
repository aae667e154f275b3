"""The lat-long map of the scene `environment`: a sky, a darker ground and a glow some 15 degrees wide, smooth enough for
every renderer's way between texels. First row straight up, middle column towards -Z, to the right of it +X."""
import math

import numpy as np

WIDTH, HEIGHT = 256, 128
GLOW = np.array([0.6, 0.5, -0.62]) / math.sqrt(0.6 ** 2 + 0.5 ** 2 + 0.62 ** 2)
SHARPNESS = 40  # of the glow: exp(SHARPNESS (cosine - 1))


def direction(u, v):
    """Of the place (u, v) in the map, 0 to 1 from its upper left corner."""
    theta, phi = math.pi * v, 2 * math.pi * (u - 0.5)
    return np.stack([np.sin(theta) * np.sin(phi), np.cos(theta), -np.sin(theta) * np.cos(phi)], -1)


def texels():
    """[y, x, rgb], nit: what is left of it in the shared exponents of a Radiance file."""
    u, v = np.meshgrid((np.arange(WIDTH) + 0.5) / WIDTH, (np.arange(HEIGHT) + 0.5) / HEIGHT)
    d = direction(u, v)
    up = (0.5 + 0.5 * np.tanh(4 * d[..., 1]))[..., None]
    glow = np.exp(SHARPNESS * (d @ GLOW - 1))[..., None]
    return shared_exponents(up * [0.3, 0.5, 0.9] + (1 - up) * [0.15, 0.12, 0.1] + glow * [30, 24, 15])[1]


def shared_exponents(color):
    """(bytes of a Radiance picture, the numbers they stand for)."""
    _, exponent = np.frexp(color.max(-1, keepdims=True))
    mantissa = np.floor(np.ldexp(color, 8 - exponent)).astype(np.uint8)
    return np.concatenate([mantissa, (exponent + 128).astype(np.uint8)], -1), np.ldexp(mantissa.astype(float), exponent - 8)


def write(path):
    with open(path, "wb") as file:
        file.write(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {HEIGHT} +X {WIDTH}\n".encode())
        file.write(shared_exponents(texels())[0].tobytes())


def radiance(image, d):
    """Of directions, bilinear between the middles of texels."""
    x = (np.arctan2(d[..., 0], -d[..., 2]) / (2 * math.pi) + 0.5) * WIDTH - 0.5
    y = np.clip(np.arccos(np.clip(d[..., 1], -1, 1)) / math.pi * HEIGHT - 0.5, 0, HEIGHT - 1)
    left, top = np.floor(x).astype(int), np.minimum(np.floor(y).astype(int), HEIGHT - 2)
    s, t = (x - left)[..., None], (y - top)[..., None]
    rows = [image[top + k, left % WIDTH] * (1 - s) + image[top + k, (left + 1) % WIDTH] * s for k in (0, 1)]
    return rows[0] * (1 - t) + rows[1] * t
