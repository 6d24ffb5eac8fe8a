# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause

"""Inserts faults into a copy of the sources and runs the tests that must find them: see Testing/mutants."""

import argparse
import fnmatch
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import time
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
COPY = ROOT / "build" / "mutants" / "source"
BUILD = ROOT / "build" / "mutants" / "build"
TIME_LIMIT = 600  # seconds; a test that a fault lets hang has found it
MEMORY_LIMIT = 8 << 30  # bytes; nor may a fault take all memory of the machine


class Fault:
    """A fault: a text of a file, what replaces it, and the tests that must fail then."""

    def __init__(self, group, entry):
        self.name = f"{group}/{entry['name']}"
        self.file = entry["file"]
        self.original = entry["original"].strip("\n")
        self.replacement = entry["replacement"].strip("\n")
        self.program, self.tests = entry["tests"].split()

    def misfit(self):
        """Why the fault cannot be planted, or None."""
        path = ROOT / self.file
        if not path.is_file():
            return f"{self.file} does not exist"
        count = path.read_text().count(self.original)
        if count != 1:
            return f"{self.file} has the original text {count} times instead of once"
        if self.original == self.replacement:
            return "the replacement equals the original"
        return None

    def plant(self):
        self.text = (COPY / self.file).read_text()
        (COPY / self.file).write_text(self.text.replace(self.original, self.replacement))

    def remove(self):
        (COPY / self.file).write_text(self.text)


def read_faults():
    faults = []
    for path in sorted(pathlib.Path(__file__).parent.glob("*.toml")):
        faults += [Fault(path.stem, entry) for entry in tomllib.loads(path.read_text())["fault"]]
    return faults


def copy_sources():
    """Brings the copy up to date. Files that have not changed keep their times, so that little is built."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT,
                            check=True, capture_output=True, text=True).stdout.split("\0")
    names = {name for name in listed if name and (ROOT / name).is_file()}
    for name in names:
        source, copy = ROOT / name, COPY / name
        if not copy.is_file() or copy.read_bytes() != source.read_bytes():
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, copy)
            os.utime(copy)
    for copy in [path for path in COPY.rglob("*") if path.is_file()]:
        if str(copy.relative_to(COPY)) not in names:
            copy.unlink()


def configure():
    command = ["cmake", "-G", "Ninja", "-S", str(COPY), "-B", str(BUILD), "--log-level=ERROR",
               "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG", "-DDHM_WRAP_PYTHON=OFF"]
    if shutil.which("ccache"):
        command += ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"]
    subprocess.run(command, check=True)


def build(program):
    """Whether the program was built, and what the compiler printed."""
    result = subprocess.run(["cmake", "--build", str(BUILD), "--target", program], capture_output=True, text=True)
    return result.returncode == 0, result.stdout + result.stderr


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_LIMIT, MEMORY_LIMIT))


def run_tests(program, tests):
    """The name of the first test that fails ("crash" or "time limit" if there is none), or None."""
    command = [str(BUILD / "bin" / program), f"--gtest_filter={tests}", "--gtest_fail_fast"]
    if not os.environ.get("DISPLAY"):
        command = ["xvfb-run", "-a"] + command
    # A session of its own, so that xvfb-run's child ends with it.
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                               preexec_fn=limit_memory, start_new_session=True)
    try:
        output, _ = process.communicate(timeout=TIME_LIMIT)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return "time limit"
    if "[==========] 0 tests" in output or "[==========]" not in output:
        sys.exit(f"{program} has no tests {tests}.")
    if process.returncode == 0:
        return None
    failed = [line.split()[3].rstrip(",") for line in output.splitlines() if line.startswith("[  FAILED  ] ")]
    return failed[0] if failed else "crash"


def test_without_faults(faults):
    """Everything must pass before a fault is planted."""
    for program in sorted({fault.program for fault in faults}):
        built, text = build(program)
        if not built:
            sys.exit(text)
        tests = ":".join(sorted({fault.tests for fault in faults if fault.program == program}))
        failed = run_tests(program, tests)
        if failed:
            sys.exit(f"{program} fails without a fault: {failed}.")


def main():
    parser = argparse.ArgumentParser(prog="Testing/mutants", description=__doc__)
    parser.add_argument("--check", action="store_true", help="only look whether each fault fits the sources")
    parser.add_argument("--list", action="store_true", help="print the names of the faults")
    parser.add_argument("fault", nargs="*", default=["*"], help="names or patterns")
    arguments = parser.parse_args()

    faults = [fault for fault in read_faults() if any(fnmatch.fnmatch(fault.name, one) for one in arguments.fault)]
    if not faults:
        sys.exit("There is no such fault.")
    misfits = [f"{fault.name}: {fault.misfit()}" for fault in faults if fault.misfit()]
    if misfits:
        sys.exit("\n".join(misfits))
    if arguments.list or arguments.check:
        print("\n".join(fault.name for fault in faults) if arguments.list else f"{len(faults)} faults fit.")
        return

    copy_sources()
    configure()
    test_without_faults(faults)
    survivors = []
    for number, fault in enumerate(faults, 1):
        start = time.monotonic()
        fault.plant()
        try:
            built, text = build(fault.program)
            if not built:
                sys.exit(f"{fault.name} cannot be compiled:\n{text}")
            found = run_tests(fault.program, fault.tests)
        finally:
            fault.remove()
        if not found:
            survivors.append(fault.name)
        print(f"{number:3d}/{len(faults)} {fault.name}: {f'found by {found}' if found else 'NOT FOUND'}"
              f" ({time.monotonic() - start:.0f} s)", flush=True)
    print(f"{len(faults) - len(survivors)} of {len(faults)} faults were found.")
    if survivors:
        sys.exit("Not found: " + ", ".join(survivors))


main()
