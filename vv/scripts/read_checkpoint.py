#!/usr/bin/env python3
"""Read a checkpoint (.whp, format version 1) into numpy arrays; only numpy is needed.

    python3 read_checkpoint.py RUN/checkpoint-000123.whp

prints what the file holds. In a program:

    from read_checkpoint import read_checkpoint
    header, arrays = read_checkpoint("RUN/checkpoint-000123.whp")
    print(header["step"], float(header["time"]), arrays["v.x"].mean())

`time` is text, so that it is the same double everywhere. A damaged file raises `ValueError` or
`zlib.error`: the header has a CRC-32, each section the checksum of its zlib stream. The BLAKE3
hashes in the table are compared as well if the package `blake3` is installed; without it, a flipped
bit that does not alter the values passes.
"""

import json
import struct
import sys
import zlib

try:
    import numpy as np
except ImportError:
    if __name__ != "__main__":
        raise
    print("read_checkpoint.py needs numpy: python3 -m pip install numpy", file=sys.stderr)
    sys.exit(2)

try:
    from blake3 import blake3
except ImportError:
    blake3 = None

TYPES = {"f64": "<f8", "u8": "u1", "u16": "<u2", "u32": "<u4", "u64": "<u8"}
TYPES |= {"i16": "<i2", "i32": "<i4", "bytes": "u1"}


def read_checkpoint(path):
    """Header and arrays by name of the checkpoint at `path`."""
    with open(path, "rb") as file:
        raw = file.read()
    if raw[:8] != b"\x89WHP\r\n\x1a\n" or raw[8:12] != b"\x01\0\0\0" or len(raw) < 20:
        raise ValueError(f"{path}: not a checkpoint of version 1")
    length, crc = struct.unpack_from("<II", raw, 12)
    if zlib.crc32(raw[8:16] + raw[20 : 20 + length]) != crc:
        raise ValueError(f"{path}: header damaged")
    header, arrays = json.loads(raw[20 : 20 + length]), {}
    if len(raw) != 20 + length + sum(section["length"] for section in header["sections"]):
        raise ValueError(f"{path}: cut off, or bytes in excess")
    for section in header["sections"]:
        start = 20 + length + section["offset"]
        stored = raw[start : start + section["length"]]
        if blake3 and blake3(stored).hexdigest() != section["blake3"]:
            raise ValueError(f"{path}: section {section['name']} damaged")
        kind = np.dtype(TYPES[section["element"]])
        planes = np.frombuffer(zlib.decompress(stored), np.uint8).reshape(kind.itemsize, -1)
        values = np.ascontiguousarray(planes.T).view(kind)
        arrays[section["name"]] = values.reshape(section["shape"])
    return header, arrays


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    header, arrays = read_checkpoint(sys.argv[1])
    print(f"{header['program']}, scene {header['scene']}, step {header['step']}, t = {header['time']}")
    for name, values in arrays.items():
        spread = f"{values.min()} to {values.max()}" if values.size else "empty"
        print(f"{name}: {values.dtype} {values.shape}, {spread}")


if __name__ == "__main__":
    main()
