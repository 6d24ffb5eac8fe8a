# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the command dhm as a process, in a separate folder for each test, and checks that it leaves no files behind."""

import collections
import io
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile

import pytest
from vtkhomeomorphism import __main__ as program, files

DONE, REFUSED, USAGE, FILE = range(4)
Result = collections.namedtuple("Result", "status out err")
COMMAND = [sys.executable, "-m", "vtkhomeomorphism"]


class Dhm:
    def __init__(self, folder, temporary):
        self.folder, self.temporary = folder, temporary
        self.environment = dict(os.environ, TMPDIR=str(temporary))
        self.usual_environment = dict(self.environment)

    def __call__(self, *arguments, status=DONE, input=b"", stdout=subprocess.PIPE, limit=None):
        """Runs it, checks its exit status and that it left no temporary file. Where that makes no difference it runs in
        this process, which saves the start of another."""

        arguments = [str(argument) for argument in arguments]
        plain = limit is None and stdout == subprocess.PIPE and "/dev/stdout" not in arguments
        if plain and self.environment == self.usual_environment:
            result = self.run_here(arguments, input)
        else:
            result = self.run_process(arguments, input, stdout, limit)
        what = f"dhm {' '.join(map(str, arguments))}: {result.err}"
        assert result.status in (status if isinstance(status, set) else {status}), what
        self.assert_tidy(what)
        assert not re.search("[\0-\x08\x0b-\x1f]", result.err), what
        assert not result.err or result.err.startswith("dhm: "), what
        assert "Traceback" not in result.err, what
        return result

    def run_here(self, arguments, input):
        """As main() runs it in a process of its own."""
        saved = sys.argv, sys.stdin, sys.stdout, sys.stderr, os.getcwd(), tempfile.tempdir
        streams = [io.TextIOWrapper(io.BytesIO(data), "utf-8", write_through=True) for data in (input, b"", b"")]
        try:
            sys.argv, (sys.stdin, sys.stdout, sys.stderr) = ["dhm", *arguments], streams
            tempfile.tempdir = str(self.temporary)
            os.chdir(self.folder)
            files._quiet = False
            status = program.main()
        finally:
            sys.argv, sys.stdin, sys.stdout, sys.stderr, folder, tempfile.tempdir = saved
            os.chdir(folder)
            signal.signal(signal.SIGINT, signal.default_int_handler)
        return Result(status, streams[1].buffer.getvalue(), streams[2].buffer.getvalue().decode())

    def run_process(self, arguments, input, stdout, limit):
        def limit_files():
            if limit is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

        ran = subprocess.run(
            [*COMMAND, *arguments], cwd=self.folder, env=self.environment, input=input, stdout=stdout,
            stderr=subprocess.PIPE, timeout=300, preexec_fn=limit_files,
        )
        return Result(ran.returncode, ran.stdout, ran.stderr.decode())

    def start(self, *arguments, **options):
        return subprocess.Popen([*COMMAND, *map(str, arguments)], cwd=self.folder, env=self.environment, **options)

    def refuse(self, status, *arguments, says=(), **options):
        """Runs it, and expects a message with these words, and nothing new in the folder."""
        before = self.list_files()
        result = self(*arguments, status=status, **options)
        for words in [says] if isinstance(says, str) else says:
            assert words in result.err, (words, result.err)
        assert self.list_files() == before
        return result

    def list_files(self):
        return {p: p.stat().st_mtime_ns for p in self.folder.rglob("*") if p.is_file()}

    def assert_tidy(self, what=""):
        left = [p.name for p in self.temporary.iterdir()]
        left += [p.name for p in self.folder.rglob("*unfinished*")]
        assert left == [], what

    def path(self, name):
        return self.folder / name


@pytest.fixture
def dhm(tmp_path):
    folder, temporary = tmp_path / "work", tmp_path / "temporary"
    folder.mkdir(), temporary.mkdir()
    return Dhm(folder, temporary)
