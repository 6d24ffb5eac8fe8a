# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Input and output files, including standard input and output. Outputs are written completely or not at all."""

import contextlib
import errno
import os
import shutil
import signal

import sys
import tempfile

REFUSED, USAGE, FILE = 1, 2, 3
"""Exit statuses: the data are refused, the command line is wrong, a file cannot be read or written."""

PICTURES = ("png", "jpg", "jpeg", "tif", "tiff", "ppm", "pgm", "pnm", "bmp", "webp")
TABLES = ("csv", "txt", "xyz", "tsv")
VECTORS = ("gpkg", "geojson", "shp", "fgb")

_quiet = False


class Failure(Exception):
    """Ends a command with a message and an exit status."""

    def __init__(self, message, status=REFUSED):
        super().__init__(message)
        self.status = status


def set_quiet(quiet):
    global _quiet
    _quiet = _quiet or quiet


def inform(message):
    """Prints information or a warning to standard error."""
    if not _quiet:
        print("dhm: " + message, file=sys.stderr)


def progress(items, text):
    """The items, with a progress bar on a terminal if tqdm is installed."""
    if _quiet or not sys.stderr.isatty():
        return items
    try:
        import tqdm
    except ImportError:
        return items
    return tqdm.tqdm(items, desc=text, leave=False)


def quote(text, length=80):
    """A text shortened to one line, for messages."""
    text = " ".join(str(text).split())
    text = "".join(c if c.isprintable() else "?" for c in text)
    return text if len(text) <= length else text[:length] + " ..."


def count(number, noun, plural=None):
    return f"{number} {noun if number == 1 else plural or noun + 's'}"


def format_of(name):
    """The extension of a file name, in lower case and without the dot."""
    return os.path.splitext(name)[1][1:].lower()


def import_extra(module, package, purpose):
    """Imports an optional library. Raises Failure with the name of its package."""
    import importlib

    try:
        return importlib.import_module(module)
    except ImportError:
        raise Failure(
            f"{purpose} needs {module}: install Debian's package {package}, "
            f"or run pip install {module.split('.')[0]}.",
            FILE,
        ) from None


_folders = set()


def _clean_up_and_stop(number, frame):
    for folder in _folders:
        shutil.rmtree(folder, ignore_errors=True)
    signal.signal(number, signal.SIG_DFL)
    os.kill(os.getpid(), number)


@contextlib.contextmanager
def scratch_folder(parent=None):
    """A temporary folder that is removed even if the process is interrupted."""
    signals = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    before = {number: signal.signal(number, _clean_up_and_stop) for number in signals}
    folder = tempfile.mkdtemp(prefix=".dhm-unfinished-", dir=parent)
    _folders.add(folder)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        _folders.discard(folder)
        for number, handler in before.items():
            signal.signal(number, handler)


class Input:
    """A file to read; `-` is standard input, of the given format, kept in a temporary file while open."""

    def __init__(self, name, stdin_format="", option=""):
        if not name:
            raise Failure("The name of an input file is empty.", USAGE)
        self.standard = name == "-"
        self.name = "standard input" if self.standard else name
        self.format = stdin_format if self.standard else format_of(name)
        self.option = option
        self._stack = contextlib.ExitStack()

    def __enter__(self):
        if not self.standard:
            try:
                with open(self.name, "rb"):
                    pass
            except IsADirectoryError:
                raise Failure(f"Cannot read {self.name}: it is a folder.", FILE) from None
            except OSError as error:
                raise Failure(f"Cannot read {self.name}: {error.strerror}.", FILE) from None
            self.path = self.name
            return self
        folder = self._stack.enter_context(scratch_folder())
        self.path = os.path.join(folder, "input." + self.format)
        try:
            with open(self.path, "wb") as file:
                shutil.copyfileobj(sys.stdin.buffer, file)
        except OSError as error:
            raise Failure(f"Cannot keep standard input: {error.strerror}.", FILE) from None
        return self

    def __exit__(self, *exception):
        self._stack.close()

    def fail(self, message):
        """Raises the failure to read this file."""
        hint = f" It was read as .{self.format} ({self.option} names another format)." if self.standard else ""
        raise Failure(f"{self.name}: {message}{hint}", FILE) from None


def replace_path(message, input):
    """The message of a library, with the name of the file as the user gave it."""
    return quote(str(message).replace(input.path, input.name), 300)


class Output:
    """A file to write, as a context: `path` is a temporary file that takes the output's name when the context
    ends without an exception, together with the files beside it. `-` is standard output."""

    def __init__(self, name, stdout_format="", force=False, formats=(), what="data"):
        if not name:
            raise Failure("The name of the output is empty.", USAGE)
        self.standard = name == "-"
        self.name = "standard output" if self.standard else name
        self.format = stdout_format if self.standard else format_of(name)
        self.force = force
        if not self.format and os.path.exists(name) and not os.path.isfile(name):
            # A pipe or a device.
            self.format = stdout_format
        if formats and self.format not in formats:
            found = f"has the extension .{self.format}" if self.format else "has no extension"
            raise Failure(
                f"Cannot write {what} to {self.name}: the name {found}; "
                f"the formats are {', '.join('.' + known for known in formats)}.",
                USAGE,
            )
        self.target = os.path.realpath(name)
        self.special = self.standard or (os.path.exists(name) and not os.path.isfile(name))
        if os.path.isdir(self.target) and not self.standard:
            raise Failure(f"Cannot write {name}: it is a folder.", FILE)
        if not self.special:
            self._require_new()
            try:
                os.listdir(os.path.dirname(self.target))
            except OSError as error:
                raise Failure(f"Cannot write {name}: {error.strerror}.", FILE) from None
            if not os.access(os.path.dirname(self.target), os.W_OK):
                raise Failure(f"Cannot write {name}: Permission denied.", FILE)

    def _require_new(self):
        if os.path.exists(self.target) and not self.force:
            raise Failure(f"{self.name} exists. Use --force to replace it.", FILE)

    def __enter__(self):
        self._stack = contextlib.ExitStack()
        try:
            folder = self._stack.enter_context(
                scratch_folder(None if self.special else os.path.dirname(self.target))
            )
        except OSError as error:
            raise self._failure(error) from None
        base = "output." + self.format if self.special else os.path.basename(self.target)
        self.path = os.path.join(folder, base)
        return self

    def __exit__(self, kind, exception, traceback):
        with self._stack:
            try:
                if kind is None:
                    self._commit()
                elif isinstance(exception, OSError):
                    raise self._failure(exception) from None
            except OSError as error:
                raise self._failure(error) from None

    def _failure(self, error):
        if self.standard:
            # Python flushes what is left when it closes standard output, and would end with another status.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return Failure(f"Cannot write {self.name}: {error.strerror or quote(error)}.", FILE)

    def _commit(self):
        if self.special:
            with open(self.path, "rb") as file:
                if self.standard:
                    shutil.copyfileobj(file, sys.stdout.buffer)
                    sys.stdout.buffer.flush()
                else:
                    with open(self.name, "wb") as device:
                        shutil.copyfileobj(file, device)
            return
        if not os.path.exists(self.path):
            raise OSError(errno.EIO, "nothing was written")
        folder = os.path.dirname(self.path)
        # Rename accompanying files first, so that the output exists only if it is complete.
        for name in sorted(os.listdir(folder), key=lambda name: name == os.path.basename(self.path)):
            goal = os.path.join(os.path.dirname(self.target), name)
            if self.force:
                os.replace(os.path.join(folder, name), goal)
                continue
            try:
                os.link(os.path.join(folder, name), goal)
            except FileExistsError:
                raise Failure(f"{goal} exists. Use --force to replace it.", FILE) from None
            except OSError:
                # A file system without hard links.
                self._require_new()
                os.replace(os.path.join(folder, name), goal)

    def write_bytes(self, data):
        with open(self.path, "wb") as file:
            file.write(data)

    def write_text(self, text):
        self.write_bytes(text.encode("utf-8", "surrogateescape"))
