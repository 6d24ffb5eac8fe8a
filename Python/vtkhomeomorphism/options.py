# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Options common to several commands."""

import functools
import math
from types import SimpleNamespace

import click

from .arrays import SYSTEMS
from .files import PICTURES, USAGE, VECTORS, Failure, Input, format_of, set_quiet
from .images import read, read_size
from .landmarks import is_landmark_file
from .mapping import Settings


class Number(click.ParamType):
    """A finite number, at least `least`, or greater if `above`."""

    name = "number"

    def __init__(self, least=0.0, above=False, most=math.inf, whole=False):
        self.least, self.above, self.most, self.whole = least, above, most, whole

    def convert(self, value, param, context):
        if not isinstance(value, str):
            # A default.
            return value
        try:
            number = (int if self.whole else float)(value)
        except ValueError:
            number = math.nan
        if not (self.least <= number <= self.most and math.isfinite(number)) or (self.above and number == self.least):
            limit = f" to {self.most:g}" if self.most < math.inf else ""
            kind = "a whole number" if self.whole else "a number"
            self.fail(f'"{value}" is not {kind} {"above" if self.above else "from"} {self.least:g}{limit}')
        return number


def quiet(command):
    return click.option(
        "-q", "--quiet", is_flag=True, expose_value=False, help="Print errors only.",
        callback=lambda context, param, value: set_quiet(value),
    )(command)


def add(*options):
    """A decorator that adds options in the order of the help text."""

    def decorate(command):
        for option in reversed(options):
            command = option(command)
        return command

    return decorate


def pair_files(names, others=0):
    """The arguments SOURCE [TARGET] ..., and the options for reading the pair. The command takes `inputs`, with the
    files of the pair, the other files, and the options."""
    options = add(
        click.argument("files", nargs=-1, metavar=names),
        click.option("--target-array", default="Target", metavar="NAME", show_default=True,
                     help="Point array with the target's positions, where one file has both meshes."),
        click.option("--target-uv", is_flag=True,
                     help="Take an OBJ file's texture coordinates (vt, without seams) as the target."),
        click.option("--input-format", default="", metavar="EXTENSION",
                     help="Format of standard input (-), json by default."),
        click.option("--working-size", default="", metavar="WIDTHxHEIGHT",
                     help="Of xmorph's meshes that do not fill their pictures: the size of its working picture "
                          "(resulting_size in a session's file)."),
        click.option("--scan", default=(), multiple=True, metavar="FILE",
                     help="Of landmarks in an image's pixels: the image, whose rectangle is the source's domain. Given "
                          "again, the target's image."),
        click.option("--without", default="", metavar="NAMES", help="Landmarks to leave out, separated by commas."),
    )

    def decorate(command):
        @functools.wraps(command)
        def wrapped(files, target_array, target_uv, input_format, working_size, scan, without, **rest):
            if others and len(files) == 2 and format_of(files[0]) in PICTURES + VECTORS and is_landmark_file(files[1]):
                files = files[::-1]
            if not 1 + others <= len(files) <= 2 + others:
                raise click.UsageError(f"The files are {names}; found {len(files)}")
            inputs = SimpleNamespace(
                pair=files[: len(files) - others], others=files[len(files) - others :], names=names,
                target_array=target_array, target_uv=target_uv, input_format=input_format,
                working_size=read_size(working_size), scan=scan, without=without, crs=None,
            )
            inputs.grids = lambda marks: scan_grids(inputs)
            if list(files).count("-") > 1:
                raise Failure("Only one of the files can come from standard input.", USAGE)
            return command(inputs=inputs, **rest)

        return options(wrapped)

    return decorate


def scan_grids(inputs):
    """The pixels of the images of --scan, None where not given."""
    grids = [None, None]
    for side, name in enumerate(inputs.scan[:2]):
        with Input(name) as file:
            grids[side] = read(file).grid
    return grids


def read_pair(inputs):
    """The pair of the inputs of a command. Reports missing or misplaced files."""
    from . import pair

    try:
        return pair.read(inputs.pair, inputs)
    except Failure as failure:
        if failure.status == USAGE and inputs.others:
            last = inputs.names.split()[-1]
            raise Failure(
                f"{failure} (The files are {inputs.names}: {inputs.others[-1]} was taken for {last}.)", USAGE
            ) from None
        raise


def map_settings(default, mask=True):
    """Options of the map; the command takes `settings`."""
    options = [
        click.option("-s", "--system", type=click.Choice(list(SYSTEMS), case_sensitive=False), default=None,
                     help=f"Coordinate system: smooth (twice continuously differentiable except at vertices), cubic (continuously "
                          f"differentiable at vertices too, least bending; meshes in planes), contour "
                          f"(the published construction) or linear (piecewise linear). Default: {default}."),
        click.option("--incenter", is_flag=True, help="Start the contours of Contour at the incenter."),
        click.option("--linear-where-discordant", is_flag=True,
                     help="Map discordant triangles by Linear (Contour only) instead of refusing them."),
        click.option("--tolerance", type=Number(), default=0.0, metavar="NUMBER",
                     help="Greatest distance from the domain of a point that is mapped like the nearest point of the domain, "
                          "relative to the domain's diagonal (default: rounding only)."),
    ]
    if mask:
        options.append(click.option("--mask-invalid", is_flag=True,
                                    help="Mask invalid triangles instead of refusing the meshes."))

    def decorate(command):
        @functools.wraps(command)
        def wrapped(system, incenter, linear_where_discordant, tolerance, mask_invalid=False, **rest):
            settings = Settings(system or "", incenter, linear_where_discordant, mask_invalid, tolerance)
            return command(settings=settings, **rest)

        return add(*options)(wrapped)

    return decorate


def output(help, default=""):
    """The options --output, --force and, with a default, --output-format."""
    options = [
        click.option("-o", "--output", required=True, metavar="FILE", help=help),
        click.option("-f", "--force", is_flag=True, help="Replace files that exist."),
    ]
    if default:
        options.append(click.option("--output-format", default=default, metavar="EXTENSION", show_default=True,
                                    help="Format of standard output (-)."))
    return add(*options)


inverse = click.option("-i", "--inverse", is_flag=True, help="Map from the target's domain to the source's.")
