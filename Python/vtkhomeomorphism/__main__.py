# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""The command dhm, which maps files from one triangulated domain to another."""

import gc
import os
import signal
import sys

import click

from . import __version__, options
from .commands import check, convert, coordinates, figure, map, morph, refine, triangulate, warp
from .files import FILE, USAGE, discard_standard_output, forget_messages, quote
from .vtkfiles import capture_messages


@click.group(
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100, "show_default": True},
    epilog="""
    A pair of meshes is one file with both meshes (a PROJ triangulation file, or a mesh with the target's positions as a
    point array) or two files, SOURCE and TARGET. Formats: .json .vtp .vtk .vtu .obj .off .ply .stl, xmorph's .mesh.
    A file of landmarks also defines a pair: .csv (source_x, source_y, target_x, target_y), QGIS .points, IIIF
    georeference annotations (.json), BigWarp (.csv). The name - stands for standard input or output.

    \b
    Exit status: 0 success (check: valid pair), 1 data refused (check: invalid pair),
                 2 usage error, 3 file cannot be read or written.
    Examples:
      dhm check shift.json
      dhm map shift.json points.csv -o shifted.csv
      dhm map shift.json parcels.gpkg -o shifted.gpkg --crs EPSG:3067
      dhm warp scan.tif control.points --crs EPSG:3857 -o rectified.tif
      dhm warp here.obj there.obj photo.png -o warped.png
      dhm morph landmarks.csv --source-image a.png --target-image b.png -o frame-%03d.png
      dhm map --inverse before.vtp after.vtp measured.vtp -o back.vtp

    dhm COMMAND --help shows the options of a command.
    """,
)
@click.version_option(__version__, prog_name="dhm", message="dhm %(version)s")
@options.quiet
def dhm():
    """Map data between the domains of two triangulations with the same triangles, smoothly and one to one."""


for module in (check, convert, coordinates, figure, map, morph, refine, triangulate, warp):
    dhm.add_command(options.quiet(module.command))


def main():
    # Interrupts end long computations immediately.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    capture_messages()
    forget_messages()
    # GDAL's errors are raised as exceptions; do not print them as well.
    os.environ.setdefault("CPL_LOG", os.devnull)
    # In megabytes; GDAL's default is a twentieth of the memory.
    os.environ.setdefault("GDAL_CACHEMAX", "200")
    # Large tables have millions of rows, which each garbage collection would search for cycles.
    gc.set_threshold(1000000)
    # Libraries report failed writes a second time when their objects are deleted.
    sys.unraisablehook = lambda what: None
    try:
        dhm.main(prog_name="dhm", standalone_mode=False)
        sys.stdout.flush()
        return 0
    except click.UsageError as error:
        command = error.ctx.command_path if error.ctx else "dhm"
        message, status = f"{error.format_message().rstrip('.')}. See {command} --help.", USAGE
    except click.ClickException as failure:
        message, status = str(failure), failure.exit_code
    except ImportError as error:
        # An installed library may report a missing dependency only in the text of the message.
        name, message, status = (error.name or "").partition(".")[0], f"A library is missing: {quote(error)}", FILE
        if name:
            message = (f"{name} is needed: install Debian's package python3-{name.lower()}, or run pip install "
                       f"{'pillow' if name == 'PIL' else name}.")
    except MemoryError:
        message, status = "There is not enough memory.", FILE
    except OSError as error:
        # Standard output is full, or was closed by its reader.
        discard_standard_output()
        message, status = f"Cannot write to standard output: {error.strerror or quote(error)}.", FILE
    print("dhm: " + message, file=sys.stderr)
    return status


if __name__ == "__main__":
    sys.exit(main())
