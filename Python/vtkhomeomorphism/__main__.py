# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""The command dhm: maps files from one triangulated domain to another."""

import importlib
import os
import signal
import sys

import click

from . import __version__, options
from .files import FILE, USAGE, Failure, quote

COMMANDS = {
    "check": "Report whether two meshes define a map, and the properties of the map.",
    "map": "Map tables, vector data, meshes and VTK's files from the source's domain to the target's.",
    "warp": "Warp an image or a raster from the source's domain to the target's.",
    "morph": "Make intermediate frames of images or data between the source and the target.",
    "figure": "Draw a grid or the contours on the source, and mapped to the target.",
    "coordinates": "Attach triangular coordinates (e, p, c) in a mesh to the points of data.",
    "triangulate": "Make a pair of meshes from landmarks, outlines and constraint lines.",
    "refine": "Make a finer pair whose piecewise linear map approximates the Smooth map, for PROJ and others.",
    "convert": "Write a pair in another format.",
}


class Commands(click.Group):
    """A group whose commands are modules, imported on use."""

    def list_commands(self, context):
        return list(COMMANDS)

    def get_command(self, context, name):
        if name not in COMMANDS:
            context.fail(f'There is no command "{quote(name)}"; the commands are {", ".join(COMMANDS)}')
        return importlib.import_module(f".commands.{name}", __package__).command

    def format_commands(self, context, formatter):
        with formatter.section("Commands"):
            formatter.write_dl(COMMANDS.items())


@click.group(
    cls=Commands,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="""
    A pair of meshes is one file that has both (PROJ's triangulation files, or a mesh with the target's positions as a
    point array) or two files, SOURCE and TARGET. Meshes: .json .vtp .vtk .vtu .obj .off .ply .stl, xmorph's .mesh.
    Landmarks are a pair, too: .csv (source x, y, target x, y), .points of QGIS, IIIF georeference annotations, BigWarp.
    - is standard input or output.

    \b
    Exit status: 0 done (check: valid), 1 the data are refused (check: not valid),
                 2 wrong usage, 3 a file cannot be read or written.
    Examples:
      dhm check shift.json
      dhm map shift.json points.csv -o shifted.csv
      dhm map shift.json parcels.gpkg -o shifted.gpkg --crs EPSG:3067
      dhm warp scan.tif control.points --crs EPSG:3857 -o rectified.tif
      dhm warp here.obj there.obj photo.png -o warped.png
      dhm map --inverse before.vtp after.vtp measured.vtp -o back.vtp

    dhm COMMAND --help shows the options of a command.
    """,
)
@click.version_option(__version__, prog_name="dhm", message="dhm %(version)s")
@options.quiet
def dhm():
    """Maps data between the domains of two triangulations with the same triangles, one to one and smoothly, with an
    exact inverse."""


def fail(message, status):
    print("dhm: " + message, file=sys.stderr)
    return status


def main():
    from .vtkfiles import capture_messages

    # Interrupts end long computations at once.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    capture_messages()
    # GDAL's errors are raised and need not be printed.
    os.environ.setdefault("CPL_LOG", os.devnull)
    # Libraries that cannot write tell so when their objects are deleted, too.
    sys.unraisablehook = lambda what: None
    try:
        dhm.main(prog_name="dhm", standalone_mode=False)
        sys.stdout.flush()
        return 0
    except Failure as failure:
        return fail(str(failure), failure.status)
    except click.ClickException as error:
        context = getattr(error, "ctx", None)
        command = context.command_path if context else "dhm"
        return fail(f"{error.format_message().rstrip('.')}. See {command} --help.", USAGE)
    except MemoryError:
        return fail("There is not enough memory.", FILE)
    except OSError as error:
        # Standard output is full or closed by its reader.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return fail(f"Cannot write to standard output: {error.strerror or quote(error)}.", FILE)


if __name__ == "__main__":
    sys.exit(main())
