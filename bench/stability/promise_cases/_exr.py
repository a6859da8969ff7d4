# SPDX-License-Identifier: BSD-3-Clause
"""Reads the float channels of OpenEXR images as written by Tessera: scan lines, flat or deep, zip or zips."""
import struct
import zlib


def unpacked(data, size):
    """Undoes the preprocessing of the zip compressions: byte differences, with even and odd bytes separated."""
    if len(data) == size:
        return data
    packed = bytearray(zlib.decompress(data))
    for i in range(1, len(packed)):
        packed[i] = (packed[i - 1] + packed[i] - 128) & 255
    half = (len(packed) + 1) // 2
    whole = bytearray(len(packed))
    whole[0::2], whole[1::2] = packed[:half], packed[half:]
    return bytes(whole)


def header(data):
    """({name: value bytes}, end position)."""
    at, attributes = 8, {}
    while data[at]:
        name, kind, rest = data[at:].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        size = struct.unpack_from("<i", data, at)[0]
        attributes[name.decode()] = data[at + 4:at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def read(path):
    """(width, height, {channel: a list of each pixel's samples, row by row}); a flat image has one sample per pixel."""
    data = path.read_bytes()
    attributes, at = header(data)
    x_0, y_0, x_1, y_1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height, compression = x_1 - x_0 + 1, y_1 - y_0 + 1, attributes["compression"][0]
    names, channels = [], attributes["channels"]
    while channels[0]:
        name, rest = channels.split(b"\0", 1)
        if struct.unpack_from("<i", rest)[0] != 2:
            raise ValueError(f"{path}: channel {name.decode()} is not of floats")
        names.append(name.decode())
        channels = rest[16:]
    rows_a_chunk = {0: 1, 2: 1, 3: 16}[compression]
    is_deep = attributes.get("type") == b"deepscanline"
    samples = {name: [None] * (width * height) for name in names}
    for (chunk,) in struct.iter_unpack("<Q", data[at:at + 8 * (-(-height // rows_a_chunk))]):
        row = struct.unpack_from("<i", data, chunk)[0] - y_0
        rows = min(rows_a_chunk, height - row)
        if is_deep:
            table, packed, size = struct.unpack_from("<3Q", data, chunk + 4)
            body = chunk + 28
            ends = struct.unpack(f"<{width}i", unpacked(data[body:body + table], 4 * width))
            body, counts = body + table, [b - a for a, b in zip((0, *ends), ends)]
        else:
            packed, body, counts = struct.unpack_from("<i", data, chunk + 4)[0], chunk + 8, [1] * width
            size = 4 * width * rows * len(names)
        values, place = unpacked(data[body:body + packed], size), 0
        for y in range(row, row + rows):
            for name in names:
                for x, count in enumerate(counts):
                    samples[name][width * y + x] = struct.unpack_from(f"<{count}f", values, place)
                    place += 4 * count
    return width, height, samples
