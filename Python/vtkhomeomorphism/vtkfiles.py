# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""VTK's readers and writers. Damaged files crash some of VTK's readers or block them for minutes, so a child process
reads each file first: `python -m vtkhomeomorphism.vtkfiles FILE FORMAT SECONDS` reads a file and reports success."""

import os
import re
import resource
import signal
import subprocess
import sys

import numpy
import vtkmodules.vtkIOLegacy as legacy
import vtkmodules.vtkIOXML as xml
from vtkmodules.numpy_interface.dataset_adapter import CompositeDataSet
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkDataSet, vtkMultiBlockDataSet
from vtkmodules.vtkIOGeometry import vtkSTLReader

from .files import FILE, USAGE, Failure, quote

FORMATS = ("vtp", "vtu", "vts", "vtr", "vti", "vtm", "vtmb", "vtpd", "vtpc", "vtk", "stl")
SECONDS, SECONDS_A_MEGABYTE = 10, 2  # limits of the processor time for reading

def capture_messages():
    """Captures VTK's errors and warnings instead of printing them."""
    vtkOutputWindow.SetInstance(vtkStringOutputWindow())
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)


def take_messages():
    """The messages captured since the last call, without VTK's prefixes (positions in the source)."""
    window = vtkOutputWindow.GetInstance()
    text = window.GetOutput() if isinstance(window, vtkStringOutputWindow) else ""
    capture_messages()
    messages = re.findall(r" line \d+\n(?:\S+ \(\w+\): )?(.*?)\n\n", text, re.DOTALL)
    return "\n".join(dict.fromkeys(m.strip() for m in messages if "returned failure for request" not in m))


def _read(path, format):
    """Data and errors. Warnings are treated as errors, because many readers only warn of missing data."""
    take_messages()
    if format == "vtk":
        reader = legacy.vtkGenericDataObjectReader()
        for kind in ("Scalars", "Vectors", "Normals", "Tensors", "ColorScalars", "TCoords", "Fields"):
            getattr(reader, f"ReadAll{kind}On")()
    else:
        reader = vtkSTLReader() if format == "stl" else xml.vtkXMLGenericDataObjectReader()
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutputDataObject(0)
    failed = data is None or reader.GetErrorCode() != 0
    return data, take_messages() or ("it cannot be read." if failed else _find_bad_cell(data))


def leaves_of(data):
    """The data sets of a tree, or the data set itself."""
    if isinstance(data, vtkCompositeDataSet):
        return [leaf.VTKObject for leaf in CompositeDataSet(data)]
    return [data] if isinstance(data, vtkDataSet) else []


def _find_bad_cell(data):
    """A defect of the point ids of cells, which VTK's readers do not check, and which would be used out of bounds."""
    for leaf in leaves_of(data):
        last = leaf.GetNumberOfPoints() - 1
        for name in ("Verts", "Lines", "Polys", "Strips", "Cells"):
            cells = getattr(leaf, "Get" + name, lambda: None)()
            if cells is None or cells.GetNumberOfCells() == 0:
                continue
            if not cells.IsValid():
                return "the offsets of its cells are invalid."
            ids, offsets = (vtk_to_numpy(a) for a in (cells.GetConnectivityArray(), cells.GetOffsetsArray()))
            sizes, bad = numpy.diff(offsets), numpy.flatnonzero((ids < 0) | (ids > last))
            if len(bad):
                cell = numpy.searchsorted(offsets, bad[0], "right") - 1
                return f"cell {cell} of its {name.lower()} has the point {ids[bad[0]]}, but points go from 0 to {last}."
            if name in ("Polys", "Strips") and sizes.min() < 3:
                return f"cell {sizes.argmin()} of its {name.lower()} has {sizes.min()} points."
    return ""


def read(input):
    """The data object in a file in one of FORMATS. Raises Failure."""
    limit = int(SECONDS + SECONDS_A_MEGABYTE * os.path.getsize(input.path) / 1e6)
    command = [sys.executable, "-m", __spec__.name, input.path, input.format, str(limit)]
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join(filter(None, sys.path)))
    child = subprocess.run(command, env=environment, capture_output=True)
    if child.returncode not in (0, 1):
        what = f"takes longer than {limit} seconds" if child.returncode == -signal.SIGXCPU else "crashes"
        input.fail(f"VTK's reader {what}: the file is damaged or truncated.")
    if child.returncode == 1:
        input.fail_by(child.stdout.decode("utf-8", "replace"))
    return _read(input.path, input.format)[0]


def write(data, output):
    """Writes a data object to a .vtk file, or to the XML file of its type. It is first written to memory, because on
    full disks some writers of VTK 9.1 crash and others do not report an error."""
    writer = xml.vtkXMLDataObjectWriter.NewWriter(data.GetDataObjectType())
    if isinstance(data, vtkMultiBlockDataSet):
        writer = xml.vtkXMLMultiBlockDataWriter()
    right = writer.GetDefaultFileExtension() if writer else "vtk"
    if output.format not in ("vtk", right):
        raise Failure(f"A .{output.format} file cannot contain a {data.GetClassName()}: use a .{right}.", USAGE)
    take_messages()
    if output.format == "vtk":
        writer = legacy.vtkGenericDataObjectWriter()
        writer.SetFileTypeToBinary()
    else:
        names = {attributes.GetArrayName(i) or "" for leaf in leaves_of(data)
                 for attributes in (leaf.GetPointData(), leaf.GetCellData(), leaf.GetFieldData())
                 for i in range(attributes.GetNumberOfArrays())}
        wrong = [name for name in names if set(name) & set("&<>\"'")]
        if wrong:
            raise Failure(f"The name of the array {quote(wrong[0])} has a character that VTK's XML files do not "
                          "support (& < > \" '): rename the array, or write a .vtk.")
        # VTK before 9.4 cannot read appended data with every version of expat.
        writer.SetDataModeToBinary()
    # The blocks are files in a folder beside a .vtm.
    beside = output.format == "vtm"
    if beside and output.special:
        raise Failure(f"{output.name} cannot hold the files of a .vtm: use a .vtk.", USAGE)
    writer.SetFileName(output.path) if beside else writer.WriteToOutputStringOn()
    writer.SetInputDataObject(data)
    writer.Write()
    errors = take_messages()
    if errors or writer.GetErrorCode() != 0:
        raise Failure(f"Cannot write {output.name}: {quote(errors, 300)}", FILE)
    if beside:
        return
    text = writer.GetOutputStdString() if output.format == "vtk" else writer.GetOutputString()
    output.write_bytes(text if isinstance(text, bytes) else text.encode())


if __name__ == "__main__":
    capture_messages()
    sys.stderr = open(os.devnull, "w")
    try:
        resource.setrlimit(resource.RLIMIT_CPU, (int(sys.argv[3]), int(sys.argv[3]) + 5))
        found = _read(*sys.argv[1:3])[1]
    except MemoryError:
        found = "it requires more memory than is available."
    sys.stdout.buffer.write(found.encode("utf-8", "replace"))
    sys.exit(1 if found else 0)
