"""The picture in perspective that `tailwater check` leaves: walls, water, and places that are wrong."""

import sys
from pathlib import Path

import matplotlib

from . import plots, scene
from .command_line import Parser
from .errors import DataError, IoError
from .fields import read_polydata, to_frame
from .pictures_3d import bounds_of, show_image
from .surface import water_surface
from .whole_file import write_whole


def point(text):
    x, y, z = map(float, text.split(","))
    return x, y, z


def main(arguments):
    parser = Parser("tailwater.start_picture", description=__doc__)
    parser.add_argument("--walls", type=Path, required=True, help="VTP file of faces")
    parser.add_argument("--water", type=Path, required=True, help="VTP file of particles")
    parser.add_argument("--spacing", type=float, required=True, help="m")
    parser.add_argument("--title", required=True)
    parser.add_argument("--image", type=Path, required=True, help="PNG file to write")
    parser.add_argument("--mark", type=point, action="append", default=[], metavar="X,Y,Z", help="a place to be marked")
    options = parser.parse_args(arguments)
    try:
        walls, particles = read_polydata(options.walls), read_polydata(options.water)
        water = to_frame(0.0, particles) if particles.GetNumberOfPoints() else None
        bounds = bounds_of([water] if water else [], [walls])
        surface = water_surface(water, options.spacing) if water else None
        image = scene.Scene(bounds).draw(surface, walls, options.mark)
        with matplotlib.rc_context(plots.STYLE):
            figure, _ = show_image(image, plots.plain(options.title))
            write_whole(options.image, lambda part: figure.savefig(part, dpi=plots.DPI, format="png",
                                                                   metadata={"Software": "tailwater preview"}))
    except (DataError, IoError, OSError) as error:
        print(error, file=sys.stderr)
        return 4
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
