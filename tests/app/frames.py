"""The frames of a run (docs/reference/view.md), as far as tests look at them: their heads."""

import struct


class Frame:
    """The head of a frame file; the file must be whole."""

    def __init__(self, path):
        data = path.read_bytes()
        magic, self.format, self.dimension, self.order, self.index, self.count, self.time, poses, scalars = \
            struct.unpack_from("<4sHBBIIdII", data)
        if magic != b"TWVF":
            raise ValueError(f"{path} is no frame")
        place = 32
        self.low, self.high = (struct.unpack_from(f"<{self.dimension}d", data, place + k * 8 * self.dimension)
                               for k in (0, 1))
        place += 16 * self.dimension
        self.ranges = [struct.unpack_from("<2f", data, place + 8 * s) for s in range(scalars)]
        place += 8 * scalars
        size = 3 if self.dimension == 2 else 7
        self.poses = [struct.unpack_from(f"<{size}d", data, place + 8 * size * p) for p in range(poses)]
        place += 8 * size * poses
        payload, self.raw_bytes = struct.unpack_from("<II", data, place)
        if len(data) != place + 8 + payload:
            raise ValueError(f"{path} is not whole")
        self.bytes = len(data)


def read_frames(run):
    """All frames of a run, in order; they are numbered without a gap."""
    paths = sorted((run / "view").glob("*.frame"))
    frames = [Frame(path) for path in paths]
    if [frame.index for frame in frames] != list(range(len(frames))):
        raise ValueError(f"frames are missing in {run}")
    return frames
