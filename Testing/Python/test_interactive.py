# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs Examples/Interactive/landmarks.py in a separate process and sends it mouse events, with a virtual display if
there is none. As a script, this file is that process:

    test_interactive.py [PICTURE.png]     prints frames per second of elapsed time and of processor time
"""

import os
import pathlib
import shutil
import subprocess
import sys
import time

import numpy


def run(picture=None):
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "Examples" / "Interactive"))
    import landmarks
    from vtkmodules.vtkIOImage import vtkPNGWriter
    from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

    session = landmarks.Session(*landmarks.generated())
    session.window.Render()
    session.interactor.Initialize()
    for widget in session.widgets:
        widget.On()

    def event(name, x, y):
        session.interactor.SetEventInformation(int(x), int(y), 0, 0)
        session.interactor.InvokeEvent(name + "Event")

    def positions():
        return [landmarks.points_of(figure).copy() for figure in session.figures]

    for side, goal in ((1, (60, 30)), (0, (-50, 20))):
        before = positions()
        active = int(numpy.hypot(*(before[side][:, :2] - [200, 150]).T).argmin())
        x, y = numpy.rint(session.to_display(side, before[side][active]))
        lines = landmarks.points_of(session.maps[1].GetOutputDataObject(0)).copy()
        event("MouseMove", x, y)
        event("LeftButtonPress", x, y)
        wall, processor, frames = time.perf_counter(), time.process_time(), 30
        for k in range(1, frames + 1):
            event("MouseMove", x + goal[0] * k / frames, y + goal[1] * k / frames)
        wall, processor = time.perf_counter() - wall, time.process_time() - processor
        event("LeftButtonRelease", x + goal[0], y + goal[1])
        after = positions()
        # This landmark has moved, on this side only, and everything has followed.
        assert numpy.flatnonzero((after[side] != before[side]).any(axis=1)).tolist() == [active]
        assert (after[1 - side] == before[1 - side]).all()
        shown = session.to_display(side, after[side][active])
        assert numpy.abs(numpy.subtract(shown, [x + goal[0], y + goal[1]])).max() <= 2
        for pair, points in zip(session.pair, after):
            assert (landmarks.points_of(pair)[:300] == points).all()
        assert (landmarks.points_of(session.maps[1].GetOutputDataObject(0)) != lines).any()
        assert session.suspicious[active] and len(session.folded) > 0
        print(f"{frames / wall:.1f} frames a second, {frames / processor:.1f} for each second of all processors; "
              f"{len(session.folded)} triangles of the reused Delaunay triangulation fold")
        if side and picture:
            grab, writer = vtkWindowToImageFilter(), vtkPNGWriter()
            grab.SetInput(session.window)
            writer.SetInputConnection(grab.GetOutputPort())
            writer.SetFileName(picture)
            writer.Write()
    # Onto another landmark: the last pair stays.
    kept = landmarks.points_of(session.pair[1]).copy()
    session.figures[1].GetPoints().SetPoint(0, session.figures[1].GetPoint(1))
    session.figures[1].GetPoints().Modified()
    session.figures[1].Modified()
    session.update()
    assert (landmarks.points_of(session.pair[1]) == kept).all() and "0 fold, " in session.text.GetInput()


def test_dragging_landmarks():
    import pytest

    command = [sys.executable, os.path.abspath(__file__)]
    if not os.environ.get("DISPLAY"):
        if not shutil.which("xvfb-run"):
            pytest.skip("there is no display, and no xvfb-run")
        command = ["xvfb-run", "-a", *command]
    ran = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=500)
    assert ran.returncode == 0, ran.stdout.decode()


if __name__ == "__main__":
    run(*sys.argv[1:])
