"""Pictures drawn by code for the example scenes: a twig of leaves for foliage, and PNG files to hold it."""
import math
import struct
import zlib


def png(size, pixel, channels=4):
    """A square PNG; pixel(x, y) gives 0..1 for each channel (1 or 4), at places of 0..1 from the upper left corner."""
    rows = bytearray()
    for j in range(size):
        rows.append(0)
        for i in range(size):
            rows.extend(round(255 * min(max(c, 0), 1)) for c in pixel((i + 0.5) / size, (j + 0.5) / size))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", size, size, 8, {1: 0, 4: 6}[channels], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b"")


def twig(size=256):
    """A twig that grows from the middle of the lower edge and branches, with pointed leaves on both sides of it."""
    stems, leaves = [], []

    def grow(x, y, angle, length, leaf, count, branches):
        stems.append((x, y, angle, length))
        for i in range(1, count + 1):
            share = i / count
            px, py = x + share * length * math.cos(angle), y - share * length * math.sin(angle)
            for side in (-1, 1) if i < count else (0,):
                turned = angle + side * math.radians(62 - 22 * share)
                if branches and i % 2 == 0 and i < count - 1:
                    grow(px, py, turned, length * (0.66 - 0.36 * share), leaf * 0.9, 4, False)
                else:
                    leaves.append((px, py, turned, leaf * (1 - 0.25 * share)))

    grow(0.5, 0.99, math.radians(90), 0.82, 0.155, 8, True)

    def pixel(x, y):
        color = (0.8, 0.8, 0.7, 0)
        for ox, oy, angle, length in stems:
            along = (x - ox) * math.cos(angle) - (y - oy) * math.sin(angle)
            across = (x - ox) * math.sin(angle) + (y - oy) * math.cos(angle)
            if 0 < along < length and abs(across) < 0.005:
                color = (0.5, 0.4, 0.3, 1)
        for shade, (ox, oy, angle, length) in enumerate(leaves):
            along = ((x - ox) * math.cos(angle) - (y - oy) * math.sin(angle)) / length
            across = ((x - ox) * math.sin(angle) + (y - oy) * math.cos(angle)) / length
            if 0 < along < 1 and abs(across) < 0.27 * math.sin(math.pi * along ** 0.75) * (1 - 0.4 * along):
                light = 0.74 + 0.11 * (shade * 7 % 5) / 4 + 0.15 * (abs(across) < 0.03)
                color = (light, light, 0.85 * light, 1)
        return tuple(round(20 * c) / 20 for c in color[:3]) + color[3:]  # few colors, a small file

    return png(size, pixel)


def breakup(size=192):
    """A gobo of soft-edged blots with light between them, in rings around the middle."""
    blots = [(0.5 + r * math.cos(a), 0.5 + r * math.sin(a), s) for r, count, s in ((0.14, 5, 0.062), (0.28, 9, 0.070), (0.41, 13, 0.066))
             for a in [2 * math.pi * (k + 0.37 * r * 10) / count for k in range(count)]]

    def pixel(x, y):
        edge = min(max((0.49 - math.hypot(x - 0.5, y - 0.5)) * 60, 0), 1)
        lit = max(min(max((s - math.hypot(x - bx, y - by)) * 60, 0), 1) for bx, by, s in blots)
        return (edge * lit,)

    return png(size, pixel, 1)


def spokes(size=192):
    """A gobo of nine bright spokes that leave the middle dark."""
    def pixel(x, y):
        away, turn = math.hypot(x - 0.5, y - 0.5), math.atan2(y - 0.5, x - 0.5)
        sides = min(max((0.32 - abs((turn * 9 / (2 * math.pi)) % 1 - 0.5)) * away * 40, 0), 1)
        return (sides * min(max((0.48 - away) * 60, 0), 1) * min(max((away - 0.1) * 60, 0), 1),)

    return png(size, pixel, 1)
