# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Options common to several commands."""

import functools
import math
import re
from types import SimpleNamespace

import click

from . import pair
from .arrays import BENDINGS, SYSTEMS
from .files import PICTURES, USAGE, VECTORS, Failure, Output, format_of, set_quiet
from .images import LARGEST, read
from .landmarks import is_landmark_file


class Number(click.FloatRange):
    """A finite number in a range."""

    def convert(self, value, param, context):
        number = super().convert(value, param, context)
        if not math.isfinite(number):
            self.fail(f"{value} is not a finite number", param, context)
        return number


class Size(click.ParamType):
    """A size in pixels."""

    name = "size"

    def convert(self, value, param, context):
        size = re.fullmatch(r"([1-9]\d{0,4})x([1-9]\d{0,4})", value)
        if not size or int(size[1]) * int(size[2]) > LARGEST:
            self.fail(f"{value} is not WIDTHxHEIGHT in pixels, such as 640x480, at most 2^32 in all", param, context)
        return int(size[1]), int(size[2])


POSITIVE = Number(min=0, min_open=True)


def add(*options):
    """A decorator that adds options in the order of the help text."""
    return lambda command: functools.reduce(lambda result, option: option(result), reversed(options), command)


def replacing(new, convert, *options):
    """A decorator that adds options. The command gets the result of `convert`, as `new`, instead of their values."""

    def decorate(command):
        @functools.wraps(command)
        def wrapped(**given):
            return command(**{new: convert(**{name: given.pop(name) for name in names})}, **given)

        known = len(getattr(command, "__click_params__", ()))
        result = add(*options)(wrapped)
        names = [parameter.name for parameter in result.__click_params__[known:]]
        return result

    return decorate


quiet = click.option("-q", "--quiet", is_flag=True, expose_value=False, help="Print errors only.",
                     callback=lambda context, param, value: set_quiet(value))
force = click.option("-f", "--force", is_flag=True, help="Replace existing files.")
inverse = click.option("-i", "--inverse", is_flag=True, help="Map from the target's domain to the source's.")
mask_option = click.option("--mask-invalid", is_flag=True,
                           help="Leave out invalid triangles instead of refusing the pair.")
format_option = click.option("--input-format", default="", metavar="EXTENSION",
                             help="Format of standard input (-); default: json (pairs), csv (data), png (images).")
crs = click.option("--crs", metavar="CRS", help="Coordinate reference system of the result, such as EPSG:3067 "
                   "(default: that of the pair, otherwise that of the data).")
background = click.option("--background", default="", metavar="COLOR", help="Color outside: transparent, a name or "
                          "#rrggbb (default: transparent or no data; white in formats without transparency).")


def output(help, default, formats, what):
    """The options --output, --force and --output-format; the command gets `output`, an Output."""
    return replacing(
        "output", lambda output, force, output_format: Output(output, output_format, force, formats, what),
        click.option("-o", "--output", required=True, metavar="FILE", help=help), force,
        click.option("--output-format", default=default, metavar="EXTENSION", help="Format of standard output (-)."))


def pair_files(names):
    """The arguments SOURCE [TARGET] ..., and the options for reading the pair. The command gets `inputs`, with the
    files of the pair, the other file if there is one, and the options."""
    others = int(names.startswith("SOURCE [TARGET] "))

    def read_inputs(files, scan, **given):
        are_others = [format_of(name) in PICTURES + VECTORS and not is_landmark_file(name) for name in files]
        if others and are_others[:1] == [True] and not any(are_others[1:]):
            files = files[1:] + files[:1]
        if not 1 + others <= len(files) <= 2 + others:
            raise click.UsageError(f"The files are {names}; found {len(files)}")
        if files.count("-") > 1:
            raise Failure("Only one of the files can come from standard input.", USAGE)
        end = len(files) - others
        grids = ([read(name).grid for name in scan] + [None, None])[:2]
        return SimpleNamespace(pair=files[:end], other="".join(files[end:]), names=names, crs=None, grids=grids,
                               format=given.pop("input_format"), **given)

    return replacing(
        "inputs", read_inputs,
        click.argument("files", nargs=-1, metavar=names),
        click.option("--target-array", default="Target", metavar="NAME",
                     help="Point array with the target's positions if one file has both meshes."),
        click.option("--working-size", type=Size(), metavar="WIDTHxHEIGHT",
                     help="The size of xmorph's working image, for meshes that do not cover their images."),
        click.option("--scan", default=(), multiple=True, metavar="FILE",
                     help="The image to whose pixels the landmarks refer. Its rectangle is the domain. Give the option "
                     "twice for source and target."),
        click.option("--without", default="", metavar="NAMES", help="Landmarks to leave out, separated by commas: "
                     "ids, or line numbers in a file without ids."),
        format_option,
    )


def read_pair(inputs):
    """The pair of the inputs of a command. If files are of the wrong kinds, the message states how they were used."""
    try:
        return pair.read(inputs.pair, inputs)
    except Failure as failure:
        if failure.exit_code != USAGE or not inputs.other:
            raise
        hint = f"(The files are {inputs.names}: {inputs.other} was used as {inputs.names.split()[-1]}.)"
        raise Failure(f"{failure} {hint}", USAGE) from None


def map_settings(default):
    """Options of the map, those of arrays.configure."""
    return add(
        click.option("-s", "--system", type=click.Choice(list(SYSTEMS), case_sensitive=False),
                     help="Coordinate system: linear (piecewise), contour (as published), smooth (differentiable "
                          f"except at vertices) or cubic (also at vertices; planar meshes). Default: {default}."),
        click.option("--bending", "cubic_bending", type=click.Choice(list(BENDINGS)), default="least",
                     help="Cubic: the map of least bending, or a local map, which depends only on nearby vertices."),
        click.option("--max-deviation", "maximum_deviation", type=POSITIVE, metavar="DISTANCE",
                     help="Cubic and Smooth: largest distance from the images in Linear, in units of the target."),
        click.option("--fairness", "fairness_refinement", type=click.IntRange(0, 4), default=0, metavar="LEVELS",
                     help="Cubic: number of times that triangles are divided into four, for less bending."),
        click.option("--linear-where-discordant", "discordant_by_linear", is_flag=True,
                     help="Contour: map discordant triangles by Linear instead of refusing the pair."),
        click.option("--tolerance", type=Number(min=0), default=0.0, metavar="NUMBER",
                     help="Map points outside like the nearest point of the domain, up to this distance relative to "
                     "the domain's diagonal."),
        mask_option,
    )
