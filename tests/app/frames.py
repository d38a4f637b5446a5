"""The frames of a run (docs/reference/view.md), as far as tests look at them: their heads."""

import struct


class Frame:
    """The head of a frame file; the file must be whole."""

    def __init__(self, path):
        data = path.read_bytes()
        magic, dimension, self.order, self.index, self.count, self.time, poses, scalars = \
            struct.unpack_from("<4s2xBBIIdII", data)
        if magic != b"TWVF":
            raise ValueError(f"{path} is no frame")
        place = 32 + 16 * dimension + 8 * scalars  # after the box and the ranges of the scalars
        size = 3 if dimension == 2 else 7
        self.poses = [struct.unpack_from(f"<{size}d", data, place + 8 * size * p) for p in range(poses)]
        place += 8 * size * poses
        payload, = struct.unpack_from("<I", data, place)
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
