# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Input and output files, including standard input and output. An output is written completely or not at all."""

import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import uuid

import click

REFUSED, USAGE, FILE = 1, 2, 3
"""Exit statuses: the data is refused, the command line is wrong, a file cannot be read or written."""

PICTURES = ("png", "jpg", "jpeg", "tif", "tiff", "ppm", "pgm", "pnm", "bmp", "webp")
TABLES = ("csv", "txt", "xyz", "tsv")
VECTORS = ("gpkg", "geojson", "shp", "fgb")

_quiet = False
_printed = set()


class Failure(click.ClickException):
    """Ends a command with a message and an exit status."""

    def __init__(self, message, status=REFUSED):
        super().__init__(message)
        self.exit_code = status


def set_quiet(quiet):
    global _quiet
    _quiet = _quiet or quiet


def inform(message):
    """Prints information or a warning to standard error."""
    if not _quiet:
        print("dhm: " + message, file=sys.stderr)


def inform_once(message):
    """The same, unless it was printed before by this command."""
    if message not in _printed:
        _printed.add(message)
        inform(message)


def forget_messages():
    """Prepares for another command in this process."""
    _printed.clear()


def progress(items, text):
    """The items, with a progress bar on a terminal if tqdm is installed."""
    try:
        import tqdm
    except ImportError:
        return items
    return tqdm.tqdm(items, desc=text, leave=False, disable=_quiet or None)


def quote(text, length=80):
    """A text shortened to one line, for messages."""
    text = "".join(c if c.isprintable() else "?" for c in " ".join(str(text).split()))
    return text if len(text) <= length else text[:length] + " ..."


def quote_message(message, file):
    """A message of a library, in which the input or output has the name that the user gave."""
    return quote(str(message).replace(file.path, file.name), 300)


def count(number, noun):
    return f"{number} {noun}{'s' * (number != 1)}"


def join(items):
    """The first ten items as text."""
    return ", ".join(map(str, items[:10])) + (", ..." if len(items) > 10 else "")


def format_of(name):
    """The extension of a file name, in lower case and without the dot."""
    return os.path.splitext(name)[1][1:].lower()


def dotted(formats):
    return ", ".join("." + name for name in formats)


@contextlib.contextmanager
def scratch_folder(parent=None):
    """A temporary folder. Another process removes it at the end of this context, or when this process ends in any way,
    even by a signal."""
    folder = os.path.join(parent or tempfile.gettempdir(), f".dhm-unfinished-{uuid.uuid4().hex}")
    remove = "import shutil, sys; sys.stdin.read(); shutil.rmtree(sys.argv[1], True)"
    with subprocess.Popen([sys.executable, "-ISc", remove, folder], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL, start_new_session=True):
        os.mkdir(folder, 0o700)
        yield folder


class Input:
    """A file to read, as a context. `-` is standard input, of the given format, which is stored in a temporary file."""

    def __init__(self, name, standard_format=""):
        self.standard, self.path = name == "-", name
        self.name = "standard input" if self.standard else name
        self.format = standard_format if self.standard else format_of(name)

    def __enter__(self):
        self._stack = contextlib.ExitStack()
        try:
            if self.standard:
                self.path = os.path.join(self._stack.enter_context(scratch_folder()), "input." + self.format)
                with open(self.path, "wb") as file:
                    shutil.copyfileobj(sys.stdin.buffer, file)
            open(self.path, "rb").close()
        except OSError as error:
            reason = "it is a folder" if isinstance(error, IsADirectoryError) else error.strerror
            raise Failure(f"Cannot read {self.name}: {reason}.", FILE) from None
        return self

    def __exit__(self, *exception):
        self._stack.close()

    def fail(self, message):
        """Raises a Failure about this file."""
        hint = f" It was read as .{self.format} (--input-format selects another format)." if self.standard else ""
        raise Failure(f"{self.name}: {message}{hint}", FILE) from None

    def fail_by(self, error):
        """Raises a Failure about this file, with the message of a library."""
        self.fail(f"it cannot be read as .{self.format}: {quote_message(error, self) or type(error).__name__}")


class Output:
    """A file to write; `-` is standard output."""

    def __init__(self, name, standard_format="", force=False, formats=(), what="data"):
        self.standard, self.force = name == "-", force
        self.name = "standard output" if self.standard else name
        self.special = self.standard or os.path.exists(name) and not os.path.isfile(name)
        self.format = standard_format if self.standard else format_of(name) or self.special and standard_format
        if self.format not in formats:
            found = f"extension .{self.format}" if self.format else "no extension"
            raise Failure(f"Cannot write {what} to {self.name}, which has {found}; use {dotted(formats)}.", USAGE)
        if os.path.isdir(name):
            raise Failure(f"Cannot write {name}: it is a folder.", FILE)
        self.target = name if self.special else os.path.realpath(name)
        self.folder = None if self.special else os.path.dirname(self.target)
        if not self.special:
            self._require_new(self.target)
            with self._named_failures():
                # Fail before the computation if the folder is not writable.
                tempfile.TemporaryFile(dir=self.folder).close()

    def _require_new(self, path):
        if os.path.exists(path) and not self.force:
            raise Failure(f"{path if path != self.target else self.name} exists. Use --force to replace it.", FILE)

    @contextlib.contextmanager
    def _named_failures(self):
        try:
            yield
        except OSError as error:
            if self.standard:
                discard_standard_output()
            raise Failure(f"Cannot write {self.name}: {error.strerror or quote(error)}.", FILE) from None

    @contextlib.contextmanager
    def writing(self):
        """A context in which `path` is a temporary file. If it ends without an exception, the file gets the name of the
        output, and files beside it are moved with it."""
        with self._named_failures(), scratch_folder(self.folder) as folder:
            self.path = os.path.join(folder, "output." + self.format if self.special else os.path.basename(self.target))
            yield
            # Move files beside the output first, so that the output exists only if it is complete.
            paths = sorted((os.path.join(place, name) for place, _, names in os.walk(folder) for name in names),
                           key=lambda path: (path == self.path, path))
            for path in paths:
                # Some libraries do not report a full disk; writing more bytes then fails.
                with open(path, "r+b") as file:
                    size = file.seek(0, os.SEEK_END)
                    file.write(bytes(1 << 16))
                    file.flush()
                    file.truncate(size)
            if self.special:
                goal = contextlib.nullcontext(sys.stdout.buffer) if self.standard else open(self.target, "wb")
                with open(self.path, "rb") as file, goal as goal:
                    shutil.copyfileobj(file, goal)
                    goal.flush()
                return
            goals = [os.path.join(self.folder, os.path.relpath(path, folder)) for path in paths]
            for goal in goals:
                self._require_new(goal)
            for path, goal in zip(paths, goals):
                os.makedirs(os.path.dirname(goal), exist_ok=True)
                os.replace(path, goal)

    def write_bytes(self, data):
        with open(self.path, "wb") as file:
            file.write(data)


def discard_standard_output():
    """Redirects standard output to the null device: otherwise Python would flush the rest when it closes standard
    output, fail, and end with another exit status."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
