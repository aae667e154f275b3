"""Reads the OpenEXR files that tyndall writes: one part of scan lines, ZIP or no compression, 16 and 32 bit floats."""
import array
import itertools
import pathlib
import re
import struct
import zlib

HALF, FLOAT = 1, 2


def _text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _header(data):
    """Attributes by name as their bytes, and where they end."""
    assert data[:4] == b"\x76\x2f\x31\x01" and data[4] == 2, "not a plain OpenEXR file"
    attributes, at = {}, 8
    while data[at]:
        name, at = _text(data, at)
        _, at = _text(data, at)
        size = struct.unpack_from("<i", data, at)[0]
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def _channels(data):
    """Names and types, as they follow each other in every line."""
    result, at = [], 0
    while data[at]:
        name, at = _text(data, at)
        result.append((name, struct.unpack_from("<i", data, at)[0]))
        at += 16
    return result


def _run_lengths(packed):
    """Undoes RLE: n below 0 and -n bytes, or n and a byte that comes n + 1 times."""
    result, at = bytearray(), 0
    while at < len(packed):
        count = int.from_bytes(packed[at:at + 1], signed=True)
        result += packed[at + 1:at + 1 - count] if count < 0 else packed[at + 1:at + 2] * (count + 1)
        at += 1 + max(-count, 1)
    return result


def _unpacked(packed, size, unpack):
    """Undoes ZIP or RLE, the differences of bytes and their order."""
    if len(packed) == size:
        return packed
    coded = unpack(packed)
    values = bytes(value & 255 for value in itertools.accumulate(coded, lambda sum, byte: sum + byte - 128))
    result, half = bytearray(size), (size + 1) // 2
    result[0::2], result[1::2] = values[:half], values[half:]
    return bytes(result)


def read_channels(path):
    """Every channel by name: its values as floats, line by line."""
    data = pathlib.Path(path).read_bytes()
    attributes, at = _header(data)
    low_x, low_y, high_x, high_y = struct.unpack("<4i", attributes["dataWindow"])
    width, height = high_x - low_x + 1, high_y - low_y + 1
    lines, unpack = {b"\x00": (1, bytes), b"\x01": (1, _run_lengths), b"\x03": (16, zlib.decompress)}[attributes["compression"]]
    channels = _channels(attributes["channels"])
    result = {name: array.array("f") for name, _ in channels}
    line_size = sum(width * (2 if kind == HALF else 4) for _, kind in channels)
    for place in struct.unpack_from(f"<{(height + lines - 1) // lines}Q", data, at):
        y, size = struct.unpack_from("<ii", data, place)
        count = min(lines, high_y + 1 - y)
        block, at = _unpacked(data[place + 8:place + 8 + size], line_size * count, unpack), 0
        for _ in range(count):
            for name, kind in channels:
                result[name].extend(struct.unpack_from(f"<{width}{'e' if kind == HALF else 'f'}", block, at))
                at += width * (2 if kind == HALF else 4)
    return result


def without_name(data):
    """Header and stored pixels of a file's bytes, without the name of the output in its command, and without the hash of
    all this: can be compared."""
    attributes, at = _header(data)
    attributes.pop("tyndall:check")
    attributes["tyndall:command"] = re.sub(rb" -o \S+", b"", attributes["tyndall:command"])
    return tuple(sorted(attributes.items())), data[struct.unpack_from("<Q", data, at)[0]:]


def added(*terms):
    """The sum of channels in 32 bit floats, from left to right."""
    total = terms[0]
    for term in terms[1:]:
        total = array.array("f", map(float.__add__, total, term))
    return total
