# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""The program dhm, run as a process on files: what it computes against numpy's own computations of the
same things, and what it says and leaves behind where something is wrong.

The environment variable DHM is the path of the program. The path of the folder of real data is
DHM_SHARED_DATA, or ../shared/data seen from the repository; without it, its tests are skipped."""

import base64
import collections
import csv
import io
import json
import os
import pathlib
import pty
import re
import resource
import select
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import unittest
import xml.etree.ElementTree
import zlib

import numpy

PROGRAM = os.path.abspath(os.environ.get("DHM", "dhm"))
ROOT = pathlib.Path(__file__).resolve().parents[2]
SHARED_DATA = pathlib.Path(os.environ.get("DHM_SHARED_DATA", ROOT.parent / "shared" / "data"))
FINLAND = SHARED_DATA / "fi_nls_ykj_etrs35fin.json"
XMORPH = pathlib.Path("/usr/share/xmorph/example")

YES, REFUSED, WRONG_USAGE, FILE_TROUBLE = range(4)

Pair = collections.namedtuple("Pair", "source target triangles")
Result = collections.namedtuple("Result", "status out err")


# --- Meshes and what numpy makes of them


def make_grid(columns, rows, width=1.0, height=1.0):
    """Points of a grid over a rectangle, row by row, and its triangles, counterclockwise."""
    x, y = numpy.meshgrid(numpy.linspace(0, width, columns + 1), numpy.linspace(0, height, rows + 1))
    points = numpy.column_stack((x.ravel(), y.ravel()))
    triangles = []
    for row in range(rows):
        for column in range(columns):
            a = row * (columns + 1) + column
            b, d = a + 1, a + columns + 1
            triangles += [(a, b, d + 1), (a, d + 1, d)]
    return points, numpy.array(triangles)


def make_pair(columns=5, rows=4, move=0.3, seed=1, width=1.0, height=1.0):
    """A grid, and the same with its inner points moved by less than a cell's half."""
    source, triangles = make_grid(columns, rows, width, height)
    cell = numpy.array([width / columns, height / rows])
    inner = ((source > 0) & (source < [width, height])).all(axis=1)
    step = numpy.random.default_rng(seed).uniform(-move, move, source.shape) * cell
    return Pair(source, source + step * inner[:, None], triangles)


def make_annulus(corners=12, turn=0.2):
    """A ring of triangles; in the target, its inner circle is turned."""
    def ring(radius, angle):
        t = 2 * numpy.pi * numpy.arange(corners) / corners + angle
        return radius * numpy.column_stack((numpy.cos(t), numpy.sin(t)))
    triangles = []
    for k in range(corners):
        n = (k + 1) % corners
        triangles += [(k, corners + k, corners + n), (k, corners + n, n)]
    return Pair(numpy.vstack((ring(1, 0), ring(2, 0))), numpy.vstack((ring(1, turn), ring(2, 0))),
                numpy.array(triangles))


def doubled_areas(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]


def barycentric(points, mesh, triangles):
    """For each point, a triangle that it is in, and its barycentric coordinates there."""
    a, b, c = (mesh[triangles[:, k]] for k in range(3))
    found = numpy.full(len(points), -1)
    weights = numpy.full((len(points), 3), -numpy.inf)
    for k in range(len(triangles)):
        matrix = numpy.column_stack((b[k] - a[k], c[k] - a[k]))
        uv = numpy.linalg.solve(matrix, (points - a[k]).T).T
        own = numpy.column_stack((1 - uv.sum(axis=1), uv))
        better = own.min(axis=1) > weights.min(axis=1)
        found[better], weights[better] = k, own[better]
    return found, weights


def interpolate(points, pair):
    """The piecewise linear map."""
    found, weights = barycentric(points, pair.source, pair.triangles)
    return (weights[:, :, None] * pair.target[pair.triangles[found]]).sum(axis=1)


def inside_points(pair, count, seed=2):
    """Random points in random triangles of the source."""
    random = numpy.random.default_rng(seed)
    weights = random.dirichlet((1, 1, 1), count)
    corners = pair.source[pair.triangles[random.integers(len(pair.triangles), size=count)]]
    return (weights[:, :, None] * corners).sum(axis=1)


def edges_of(triangles):
    """How many triangles each edge has."""
    return collections.Counter(
        tuple(sorted((t[k], t[(k + 1) % 3]))) for t in numpy.asarray(triangles).tolist()
        for k in range(3))


# --- Files

COLUMNS = ["source_x", "source_y", "target_x", "target_y"]


def write_json(path, pair, **more):
    document = {
        "file_type": "triangulation_file", "format_version": "1.0", **more,
        "transformed_components": ["horizontal"],
        "vertices_columns": COLUMNS,
        "triangles_columns": ["idx_vertex1", "idx_vertex2", "idx_vertex3"],
        "vertices": numpy.hstack((pair.source, pair.target)).tolist(),
        "triangles": pair.triangles.tolist()}
    path.write_text(json.dumps(document, indent=1))


def read_json(path):
    document = json.loads(path.read_text())
    assert document["vertices_columns"] == COLUMNS
    vertices = numpy.array(document["vertices"])
    return Pair(vertices[:, :2], vertices[:, 2:], numpy.array(document["triangles"])), document


def rows(array):
    return "".join(" ".join(repr(x) for x in row) + "\n" for row in numpy.asarray(array).tolist())


def in_space(points):
    return numpy.column_stack((points, numpy.zeros(len(points)))) if points.shape[1] == 2 else points


def write_off(path, points, triangles):
    path.write_text(f"OFF\n{len(points)} {len(triangles)} 0\n" + rows(in_space(points)) +
                    "".join(f"3 {a} {b} {c}\n" for a, b, c in triangles))


def write_obj(path, points, triangles):
    path.write_text("# a comment\n" + "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in
                                              in_space(points).tolist()) +
                    "".join(f"f {a + 1} {b + 1}/1 {c + 1}/1/1\n" for a, b, c in triangles))


def write_ply(path, points, triangles, encoding="ascii", number="double"):
    header = (f"ply\nformat {encoding} 1.0\ncomment made by hand\nelement vertex {len(points)}\n"
              f"property {number} x\nproperty uchar quality\nproperty {number} y\n"
              f"property {number} z\nelement face {len(triangles)}\n"
              "property list uchar int vertex_indices\nend_header\n")
    points = in_space(points).tolist()
    if encoding == "ascii":
        body = ("".join(f"{x!r} 7 {y!r} {z!r}\n" for x, y, z in points) +
                "".join(f"3 {a} {b} {c}\n" for a, b, c in triangles)).encode()
    else:
        order = "<" if "little" in encoding else ">"
        code = "d" if number == "double" else "f"
        body = (b"".join(struct.pack(f"{order}{code}B{code}{code}", x, 7, y, z) for x, y, z in points) +
                b"".join(struct.pack(f"{order}B3i", 3, *t) for t in triangles.tolist()))
    path.write_bytes(header.encode() + body)


def write_stl(path, points, triangles, binary):
    corners = in_space(points)[triangles].tolist()
    if binary:
        path.write_bytes(b"solid binary".ljust(80) + struct.pack("<I", len(corners)) + b"".join(
            struct.pack("<12fH", 0, 0, 1, *a, *b, *c, 0) for a, b, c in corners))
        return
    path.write_text("solid made by hand\n" + "".join(
        "  facet normal 0 0 1\n    outer loop\n" +
        "".join(f"      vertex {x!r} {y!r} {z!r}\n" for x, y, z in t) +
        "    endloop\n  endfacet\n" for t in corners) + "endsolid made by hand\n")


def write_vtk(path, points, triangles, grid=False, target=None):
    """A legacy file as text, of polygons or an unstructured grid."""
    text = "# vtk DataFile Version 3.0\nby hand\nASCII\n"
    text += f"DATASET {'UNSTRUCTURED_GRID' if grid else 'POLYDATA'}\n"
    text += f"POINTS {len(points)} double\n" + rows(in_space(points))
    text += f"{'CELLS' if grid else 'POLYGONS'} {len(triangles)} {4 * len(triangles)}\n"
    text += "".join(f"3 {a} {b} {c}\n" for a, b, c in triangles)
    if grid:
        text += f"CELL_TYPES {len(triangles)}\n" + "5\n" * len(triangles)
    if target is not None:
        text += f"POINT_DATA {len(points)}\nVECTORS Moved double\n" + rows(in_space(target))
    path.write_text(text)


def write_vtu(path, points, triangles):
    def array(name, kind, values, components=1):
        return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" '
                f'format="ascii">{" ".join(repr(x) for x in numpy.ravel(values).tolist())}</DataArray>\n')
    path.write_text(
        '<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="0.1">\n<UnstructuredGrid>\n'
        f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(triangles)}">\n<Points>\n' +
        array("Points", "Float64", in_space(points), 3) + "</Points>\n<Cells>\n" +
        array("connectivity", "Int64", triangles) +
        array("offsets", "Int64", 3 * numpy.arange(1, len(triangles) + 1)) +
        array("types", "UInt8", numpy.full(len(triangles), 5)) +
        "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n")


def write_mesh(path, columns, points):
    """Xmorph's: rows from the top, y downwards."""
    path.write_text(f"M2\n{columns} {len(points) // columns}\n" +
                    "".join(f"{x!r} {y!r} 0\n" for x, y in points.tolist()))


def write_csv(path, points, names="x,y"):
    path.write_text(names + "\n" + "".join(f"{x!r},{y!r}\n" for x, y in numpy.asarray(points).tolist()))


def read_csv(text):
    """Columns by name, as numbers."""
    lines = list(csv.DictReader(io.StringIO(text)))
    return {name: numpy.array([float(line[name]) for line in lines]) for name in lines[0]}


def places(table):
    return numpy.column_stack((table["x"], table["y"]))


def write_pnm(path, pixels):
    """8 bits, from the upper left; gray if there is no third axis."""
    height, width = pixels.shape[:2]
    path.write_bytes(f"P{6 if pixels.ndim == 3 else 5}\n# by hand\n{width} {height}\n255\n".encode() +
                     pixels.astype(numpy.uint8).tobytes())


def read_pnm(data):
    match = re.match(rb"P([56])\n(?:#.*\n)?(\d+) (\d+)\n255\n", data)
    width, height = int(match[2]), int(match[3])
    shape = (height, width, 3) if match[1] == b"6" else (height, width)
    return numpy.frombuffer(data[match.end():], numpy.uint8).reshape(shape)


def write_png(path, pixels):
    height, width, channels = pixels.shape
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    lines = b"".join(b"\0" + row.tobytes() for row in pixels.astype(numpy.uint8))
    kind = {1: 0, 2: 4, 3: 2, 4: 6}[channels]
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, 8, kind,
                                                                      0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))


def read_png(data):
    """Pixels of 8 bits, not interlaced, from the upper left."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, compressed = 8, b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, bits, color, _, _, interlaced = struct.unpack(">2I5B", body)
        compressed += body if kind == b"IDAT" else b""
        at += size + 12
    assert bits == 8 and not interlaced
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[color]
    lines = numpy.frombuffer(zlib.decompress(compressed), numpy.uint8).reshape(height, -1)
    before = numpy.zeros(width * channels, int)
    result = []
    for line in lines:
        method, line = line[0], line[1:].astype(int)
        for i in range(len(line)):
            left = line[i - channels] if i >= channels else 0
            corner = before[i - channels] if i >= channels else 0
            up = before[i]
            if method == 4:
                guess = left + up - corner
                nearest = min((abs(guess - left), 0), (abs(guess - up), 1), (abs(guess - corner), 2))[1]
                line[i] += (left, up, corner)[nearest]
            else:
                line[i] += (0, left, up, (left + up) // 2)[method]
            line[i] &= 255
        result.append(line)
        before = line
    return numpy.array(result).reshape(height, width, channels)


def read_tiff(data):
    """The bytes of the pixels of a file that is not compressed, little end first."""
    assert data[:4] == b"II*\0"
    at, = struct.unpack_from("<I", data, 4)
    fields = {}
    for k in range(struct.unpack_from("<H", data, at)[0]):
        tag, kind, count = struct.unpack_from("<HHI", data, at + 2 + 12 * k)
        code, place = {3: "H", 4: "I"}[kind], at + 10 + 12 * k
        if count * struct.calcsize(code) > 4:
            place, = struct.unpack_from("<I", data, place)
        fields[tag] = struct.unpack_from(f"<{count}{code}", data, place)
    return b"".join(data[offset:offset + size] for offset, size in zip(fields[273], fields[279]))


def png_size(data):
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">2I", data[16:24])


class ProgramTest(unittest.TestCase):
    """A folder for each test, in which the program runs, and which it must leave in order."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="test-dhm-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.temporary = self.folder / "temporary"
        self.temporary.mkdir()
        self.environment = dict(os.environ, TMPDIR=str(self.temporary))

    def path(self, name):
        return self.folder / name

    def run_dhm(self, *arguments, status=YES, input=b"", stdout=subprocess.PIPE, limit=None):
        """Runs it, checks its exit status and that it left no temporary file."""
        def limit_files():
            if limit is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        ran = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, env=self.environment,
                             input=input, stdout=stdout, stderr=subprocess.PIPE, timeout=120,
                             preexec_fn=limit_files)
        # What it says is text, whatever it has read.
        result = Result(ran.returncode, ran.stdout, ran.stderr.decode())
        what = f"dhm {' '.join(map(str, arguments))}: {result.err}"
        self.assertIn(result.status, status if isinstance(status, set) else {status}, what)
        self.assert_tidy(what)
        self.assertNotRegex(result.err, "[\0-\x08\x0b-\x1f]", what)
        for line in result.err.splitlines()[:1]:
            self.assertTrue(line.startswith("dhm: "), what)
        return result

    def refuse(self, status, *arguments, says=(), **options):
        """Runs it, and expects a message with these words, and nothing new in the folder."""
        before = self.list_files()
        result = self.run_dhm(*arguments, status=status, **options)
        for words in [says] if isinstance(says, str) else says:
            self.assertIn(words, result.err)
        self.assertEqual(self.list_files(), before)
        return result

    def list_files(self):
        return {p.relative_to(self.folder): p.stat().st_mtime_ns for p in self.folder.rglob("*")
                if p.is_file()}

    def assert_tidy(self, what):
        left = [p.name for p in self.temporary.iterdir()]
        left += [p.name for p in self.folder.rglob("*unfinished*")]
        self.assertEqual(left, [], what)

    def assert_near(self, a, b, tolerance):
        self.assertEqual(numpy.shape(a), numpy.shape(b))
        self.assertLessEqual(numpy.abs(numpy.asarray(a) - numpy.asarray(b)).max(), tolerance)

    def map_points(self, files, points, *options):
        write_csv(self.path("points.csv"), points)
        return read_csv(self.run_dhm("map", *options, *files, "points.csv", "-o", "-").out.decode())


# --- What each command does


class Map(ProgramTest):
    def setUp(self):
        super().setUp()
        self.pair = make_pair()
        write_json(self.path("pair.json"), self.pair)
        self.points = inside_points(self.pair, 400)

    def map(self, *options, points=None):
        return self.map_points(["pair.json"], self.points if points is None else points, *options)

    def test_linear_interpolates(self):
        images = places(self.map("--system", "linear"))
        self.assert_near(images, interpolate(self.points, self.pair), 1e-14)

    def test_systems_differ_within_triangles_only(self):
        random = numpy.random.default_rng(3)
        ends = self.pair.triangles[:, :2]
        t = random.random((len(ends), 1))
        on_edges = (1 - t) * self.pair.source[ends[:, 0]] + t * self.pair.source[ends[:, 1]]
        expected = (1 - t) * self.pair.target[ends[:, 0]] + t * self.pair.target[ends[:, 1]]
        for system in ("Linear", "contour", "SMOOTH"):
            options = ("--system", system, "--linear-where-discordant")
            self.assert_near(places(self.map(*options, points=on_edges)), expected, 1e-12)
            self.assert_near(places(self.map(*options, points=self.pair.source)), self.pair.target, 0)
        linear, smooth = (places(self.map("-s", system)) for system in ("linear", "smooth"))
        self.assertGreater(numpy.abs(smooth - linear).max(), 1e-3)
        # Smooth is the default.
        self.assert_near(places(self.map()), smooth, 0)

    def test_images_stay_in_their_triangles(self):
        table = self.map("--triangle-id")
        found, _ = barycentric(self.points, self.pair.source, self.pair.triangles)
        images, weights = barycentric(places(table), self.pair.target, self.pair.triangles)
        self.assertTrue((table["TriangleId"] == found).all())
        self.assertTrue((table["TriangleId"] == images).all())
        self.assertGreaterEqual(weights.min(), 0)

    def test_inverse_returns(self):
        for system in ("linear", "contour", "smooth"):
            options = ("--system", system, "--linear-where-discordant")
            images = places(self.map(*options))
            self.assertGreater(numpy.abs(images - self.points).max(), 0.01)
            back = self.map("--inverse", *options, points=images)
            self.assert_near(places(back), self.points, 1e-13)

    def test_identity(self):
        write_json(self.path("pair.json"), Pair(self.pair.source, self.pair.source, self.pair.triangles))
        for system in ("linear", "contour", "smooth"):
            self.assert_near(places(self.map("--system", system)), self.points, 1e-15)

    def test_jacobian_is_the_derivative(self):
        h = 1e-6
        for system in ("linear", "contour", "smooth"):
            options = ("--system", system, "--linear-where-discordant")
            _, weights = barycentric(self.points, self.pair.source, self.pair.triangles)
            points = self.points[weights.min(axis=1) > 1e-4]
            table = self.map("--jacobian", "--determinant", *options, points=points)
            jacobian = numpy.stack([table[f"Jacobian_{k}"] for k in range(9)], axis=1).reshape(-1, 3, 3)
            for axis in range(2):
                step = h * numpy.eye(2)[axis]
                ahead, behind = (places(self.map(*options, points=points + s)) for s in (step, -step))
                difference = (ahead - behind) / (2 * h)
                # A bend of Contour's contours may be between.
                wrong = numpy.abs(jacobian[:, :2, axis] - difference).max(axis=1) > 1e-5
                self.assertLessEqual(wrong.sum(), 0 if system != "contour" else 4)
            determinant = numpy.linalg.det(jacobian[:, :2, :2])
            self.assert_near(table["JacobianDeterminant"], determinant, 1e-12)
            self.assertGreater(determinant.min(), 0)

    def test_numbers_of_columns_are_no_names(self):
        # The first line has a coordinate that is the number of a column.
        for lines in ("P1,0.25,0.5\nP2,3,2\n", "P1,3,2\nP2,0.25,0.5\n"):
            with open(self.path("numbers.csv"), "w", encoding="utf-8") as file:
                file.write(lines)
            result = self.run_dhm("map", "pair.json", "numbers.csv", "--columns", "2,3", "-o", "-")
            rows = [line.split(",") for line in result.out.decode().splitlines()]
            self.assertEqual(sorted((row[0], row[3]) for row in rows),
                             sorted((row.split(",")[0], "1" if "0.25" in row else "0") for row in lines.split()))

    def test_coordinates_leave_points_where_they_are(self):
        points = [[0.5, 0.5], [1.5, 0.5]]
        write_csv(self.path("points.csv"), points)
        table = read_csv(self.run_dhm("coordinates", "pair.json", "points.csv", "-o", "-").out.decode())
        self.assertEqual(places(table).tolist(), points)
        self.assertEqual(table["vtkValidPointMask"].tolist(), [1, 0])

    def test_points_outside_are_marked(self):
        points = [[0.5, 0.5], [1.5, 0.5], [0.2, 0.2]]
        write_csv(self.path("points.csv"), points)
        result = self.run_dhm("map", "pair.json", "points.csv", "-o", "-")
        self.assertIn("1 point is outside the domain", result.err)
        table = read_csv(result.out.decode())
        self.assertEqual(table["vtkValidPointMask"].tolist(), [1, 0, 1])
        self.assertEqual(numpy.isnan(places(table)).any(axis=1).tolist(), [False, True, False])
        self.refuse(REFUSED, "map", "--require-inside", "pair.json", "points.csv", "-o", "new.csv",
                    says="1 point is outside the domain")
        self.assertEqual(self.run_dhm("map", "-q", "pair.json", "points.csv", "-o", "-").err, "")

    def test_tolerance_takes_points_beside_the_domain(self):
        points = [[0.5, -1e-6], [1 + 1e-6, 0.5]]
        self.assertEqual(self.map(points=points)["vtkValidPointMask"].tolist(), [0, 0])
        near = self.map("--tolerance", "1e-5", points=points)
        self.assertEqual(near["vtkValidPointMask"].tolist(), [1, 1])
        self.assert_near(places(near), places(self.map(points=[[0.5, 0], [1, 0.5]])), 1e-5)

    def test_tables_keep_what_is_not_mapped(self):
        text = ("\ufeff# measured in 1990\nName;N;E;\"Remark; long\"\r\n\"Old \"\"Oak\"\"\";0.25;0.5;x\n"
                "Stone;0.5;0.125;\"two\nlines\"\n")
        self.path("table.csv").write_text(text, encoding="utf-8")
        out = self.run_dhm("map", "pair.json", "table.csv", "-o", "-", "-s", "linear").out.decode()
        lines = list(csv.reader(io.StringIO(out.split("\n", 1)[1]), delimiter=";"))
        self.assertTrue(out.startswith("# measured in 1990\n"))
        self.assertEqual(lines[0], ["Name", "N", "E", "Remark; long", "vtkValidPointMask"])
        self.assertEqual([line[0] for line in lines[1:]], ['Old "Oak"', "Stone"])
        self.assertEqual([line[3] for line in lines[1:]], ["x", "two\nlines"])
        images = numpy.array([[float(line[2]), float(line[1])] for line in lines[1:]])
        expected = interpolate(numpy.array([[0.5, 0.25], [0.125, 0.5]]), self.pair)
        self.assert_near(images, expected, 1e-15)

    def test_rows_are_no_comments(self):
        self.path("table.csv").write_text('id,x,y\n"#1",0.5,0.25\n2,0.25,0.5\n')
        for table in ("table.csv", "once.csv"):
            self.run_dhm("map", "pair.json", table, "-f", "-o", "once.csv")
            lines = list(csv.reader(self.path("once.csv").read_text().splitlines()))
            self.assertEqual([line[0] for line in lines], ["id", "#1", "2"])

    def test_ends_of_lines(self):
        """Those of a table become \\n, those within quotes stay."""
        self.path("table.csv").write_bytes(b'# old\r\nx,y,name\r\n0.5,0.25,"two\r\nlines\r"\r\n\r\n0.25,0.5,\r\n')
        out = self.run_dhm("coordinates", "pair.json", "table.csv", "-o", "-").out
        lines = out.split(b"\n")
        self.assertEqual(lines[0], b"# old")
        self.assertTrue(lines[1].startswith(b"x,y,name,"))
        self.assertEqual(lines[2] + b"\n" + lines[3][:7], b'0.5,0.25,"two\r\nlines\r"')
        self.assertTrue(lines[4].startswith(b"0.25,0.5,,"))

    def test_columns_by_number_and_name(self):
        self.path("table.txt").write_text("0.5 a 0.25\n0.125\tb 0.5\n")
        self.path("named.csv").write_text("up,right,id\n0.5,0.25,1\n0.125,0.5,2\n")
        for name, columns, order in (("table.txt", "1,3", 1), ("named.csv", "right,up", 1)):
            out = self.run_dhm("map", "pair.json", name, "--columns", columns, "-o", "result.csv", "-f",
                               "-s", "linear")
            numbers = [[float(x) for x in re.findall(r"(?<![\w.])\d\.\d+", line)]
                       for line in self.path("result.csv").read_text().splitlines()]
            numbers = numpy.array([line for line in numbers if line])
            source = numpy.array([[0.5, 0.25], [0.125, 0.5]])
            source = source if name == "table.txt" else source[:, ::-1]
            images = interpolate(source, self.pair)
            self.assert_near(numbers, images if name == "table.txt" else images[:, ::-1], 1e-15)
            self.assertEqual(out.err, "")
        for columns in ("4,1", "up", "0,1", "x,y", "1,2,3,1", "up,up", "up,1"):
            self.refuse(WRONG_USAGE, "map", "pair.json", "named.csv", "--columns", columns, "-o", "n.csv",
                        says="--columns")
        self.refuse(WRONG_USAGE, "map", "pair.json", "named.csv", "--columns", "left,up", "-o", "n.csv",
                    says=('"left"', '"up", "right", "id"'))
        # Neither case nor blanks matter, except between names that differ in nothing else.
        self.path("cases.csv").write_text("RIGHT, Up ,up\n0.25,0.5,9\n")
        out = self.run_dhm("map", "pair.json", "cases.csv", "--columns", " right,UP", "-o", "-").out
        self.assertEqual(out.decode().splitlines()[1].split(",")[2:], ["9", "1"])
        self.refuse(REFUSED, "map", "pair.json", "cases.csv", "--columns", "right,up", "-o", "n.csv",
                    "--require-inside", says="1 point is outside")

    def test_usual_names_of_columns(self):
        expected = interpolate(numpy.array([[0.25, 0.5]]), self.pair)[0]
        for x, y in (("x", "y"), ("E", "N"), ("Easting", "Northing"), ("East", "North"), ("X_Coord", "Y_Coord"),
                     ("Rechtswert", "Hochwert"), ("lon", "lat"), ("Longitude", "Latitude"), (" X", "y ")):
            self.path("table.csv").write_text(f"id;{y};{x}\n7;0.5;0.25\n")
            out = self.run_dhm("map", "pair.json", "table.csv", "-s", "linear", "-o", "-").out.decode()
            self.assertEqual(out.splitlines()[0], f"id;{y};{x};vtkValidPointMask")
            image = [float(word) for word in out.splitlines()[1].split(";")]
            self.assert_near(image, [7, expected[1], expected[0], 1], 1e-15)
        # Guessing would carry something else than points.
        self.path("table.csv").write_text("height,a,b\n0.5,0.25,0.5\n")
        self.refuse(FILE_TROUBLE, "map", "pair.json", "table.csv", "-o", "new.csv",
                    says=("table.csv", '"height", "a", "b"', "--columns"))

    def test_decimal_commas(self):
        for text, line in (("x;y\n0,5;0,25\n", 2), ("0,5;0,25\n", 1), ("x y\n0.5 1\n0,5 0,25\n", 3),
                           ("0,5 0,25\n", 1), ("id\tx\ty\n1\t0,5\t1\n", 2), ("P1;0,5;0,25\n", 1)):
            self.path("table.csv").write_text(text)
            self.refuse(FILE_TROUBLE, "map", "pair.json", "table.csv", "-o", "new.csv",
                        says=("table.csv", f"line {line}", "decimal commas"))
        # Where the coordinates are numbers, other columns are nobody's business.
        self.path("table.csv").write_text("0.5,0.25,12 30\n")
        self.assertEqual(self.run_dhm("map", "pair.json", "table.csv", "-o", "-").out.decode().strip()[-8:],
                         ",12 30,1")

    def test_tables_keep_their_columns_in_vtk_files(self):
        self.path("table.csv").write_text('id,x,y,name,x\n7,0.5,0.25,"Old, Oak",1\n8,0.25,0.5,Stone,2\n'
                                          ',0.125,0.5,"",3\n')
        for command, mesh in (("map", "pair.json"), ("coordinates", "pair.json")):
            self.run_dhm(command, mesh, "table.csv", "-f", "-o", "table.vtp")
            document = xml.etree.ElementTree.parse(self.path("table.vtp"))
            arrays = {array.get("Name"): array for array in document.find(".//PointData")}
            self.assertEqual(arrays["id"].get("type"), "Float64")
            self.assertEqual([float(arrays["id"].get(f"Range{end}")) for end in ("Min", "Max")], [7, 8])
            self.assertEqual([float(arrays["x"].get(f"Range{end}")) for end in ("Min", "Max")], [1, 3])
            self.assertEqual(arrays["name"].get("type"), "String")
            text = "".join(arrays["name"].itertext()).strip()
            # A header of its own, then the texts, each with a zero at its end.
            self.assertEqual(zlib.decompress(base64.b64decode(text[24:])), b"Old, Oak\0Stone\0\0")
        self.path("plain.txt").write_text("0.5 0.25 3\n0.25 0.5 4\n")
        self.run_dhm("map", "pair.json", "plain.txt", "-o", "plain.vtk")
        self.assertEqual(read_legacy(self.path("plain.vtk"))[1]["Column3"].tolist(), [3, 4])

    def test_points_that_are_nowhere(self):
        self.path("table.csv").write_text("x,y\n0.5,0.5\nnan,0.5\n3,3\n0.2,inf\n")
        result = self.run_dhm("map", "pair.json", "table.csv", "-o", "-")
        self.assertIn("3 points are outside the domain (of 2, the coordinates are no finite numbers; the "
                      "first is point 1,", result.err)
        self.assertEqual(read_csv(result.out.decode())["vtkValidPointMask"].tolist(), [1, 0, 0, 0])

    def test_tables_that_are_mapped_again(self):
        """What a column of the same name said before is replaced."""
        write_csv(self.path("points.csv"), [[0.5, 0.5], [1.5, 0.5]])
        self.run_dhm("map", "pair.json", "points.csv", "--triangle-id", "-o", "once.csv")
        out = self.run_dhm("map", "-i", "pair.json", "once.csv", "--triangle-id", "--jacobian", "-o", "-").out
        names = out.decode().splitlines()[0].split(",")
        self.assertEqual(len(names), len(set(names)))
        self.assertEqual(names[:4], self.path("once.csv").read_text().splitlines()[0].split(","))
        table = read_csv(out.decode())
        self.assertEqual(table["vtkValidPointMask"].tolist(), [1, 0])
        self.assert_near(places(table)[0], [0.5, 0.5], 1e-12)
        for name in set(names) - {"vtkValidPointMask", "TriangleId", "x", "y"}:
            self.assertTrue(name.startswith("Jacobian_"))

    def test_empty_table(self):
        self.path("empty.csv").write_text("x,y,name\n")
        out = self.run_dhm("map", "pair.json", "empty.csv", "-o", "-").out.decode()
        self.assertEqual(out.splitlines()[0].split(",")[:3], ["x", "y", "name"])
        self.assertEqual(len(out.splitlines()), 1)

    def test_vtk_data(self):
        """The points of a mesh file go where those of a table go, whichever VTK format they are in."""
        expected = self.map("--determinant")
        write_vtk(self.path("data.vtk"), self.points, numpy.array([[0, 1, 2]]))
        for output in ("data.vtp", "data2.vtk"):
            self.run_dhm("map", "pair.json", "data.vtk", "--determinant", "-o", output)
            back = self.run_dhm("map", "-i", "pair.json", output, "-o", f"back-{output}")
            self.assertEqual(back.err, "")
        points, determinants = read_legacy(self.path("data2.vtk"))
        self.assert_near(points[:, :2], places(expected), 0)
        self.assert_near(determinants["JacobianDeterminant"], expected["JacobianDeterminant"], 0)
        points, _ = read_legacy(self.path("back-data2.vtk"))
        self.assert_near(points[:, :2], self.points, 1e-13)

    def test_meshes_as_data(self):
        """The source's own mesh goes where the target is, in all formats."""
        source, target, triangles = self.pair
        writers = {"obj": write_obj, "off": write_off, "ply": write_ply,
                   "stl": lambda path, p, t: write_stl(path, p, t, False)}
        for extension, write in writers.items():
            write(self.path(f"mesh.{extension}"), source, triangles)
            write(self.path(f"expected.{extension}"), target, triangles)
            for output in ("obj", "off"):
                for side in ("mesh", "expected"):
                    pair = "pair.json" if side == "mesh" else "same.json"
                    write_json(self.path("same.json"), Pair(target, target, triangles))
                    result = self.run_dhm("map", pair, f"{side}.{extension}", "-o", f"{side}-out.{output}", "-f")
                    self.assertEqual(result.err, "")
                numbers = [numpy.array(re.findall(r"-?\d[\d.e-]*", self.path(f"{side}-out.{output}").read_text()),
                                       float) for side in ("mesh", "expected")]
                self.assert_near(*numbers, 1e-15)
        self.assertIn("without Jacobian", self.run_dhm("map", "pair.json", "mesh.off", "--jacobian", "-o",
                                                       "jacobian.obj").err)
        write_off(self.path("outside.off"), source + 0.5, triangles)
        self.refuse(REFUSED, "map", "pair.json", "outside.off", "-o", "new.obj", says=("outside", ".vtp"))
        self.refuse(WRONG_USAGE, "coordinates", "pair.json", "mesh.off", "-o", "new.obj", says=(".obj", ".vtp"))

    def test_pictures_become_curved_grids(self):
        write_pnm(self.path("gray.pgm"), numpy.zeros((2, 2)))
        self.run_dhm("map", "pair.json", "gray.pgm", "-o", "gray.vts")
        self.assertIn(b"StructuredGrid", self.path("gray.vts").read_bytes())
        self.refuse(WRONG_USAGE, "map", "pair.json", "gray.pgm", "-o", "new.png", says=(".vts", "dhm warp"))
        self.refuse(WRONG_USAGE, "map", "pair.json", "gray.pgm", "-o", "new.vti", says=(".vts"))
        self.refuse(WRONG_USAGE, "map", "pair.json", "gray.pgm", "-o", "new.csv", says="gray.pgm")

    def test_discordant_and_invalid_triangles(self):
        # In the target, one triangle is turned over.
        pair = make_pair(2, 2)
        target = pair.source.copy()
        target[4] = [0.9, 0.05]
        write_json(self.path("folded.json"), Pair(pair.source, target, pair.triangles))
        write_csv(self.path("points.csv"), self.points)
        result = self.refuse(REFUSED, "map", "folded.json", "points.csv", "-o", "new.csv",
                             says=("folded.json: ", "flipped", "--mask-invalid"))
        self.assertNotIn("MaskInvalid", result.err)
        table = self.map_points(["folded.json"], self.points, "--mask-invalid")
        valid = table["vtkValidPointMask"] == 1
        self.assertTrue(0 < valid.sum() < len(valid))
        flipped = numpy.flatnonzero(doubled_areas(target, pair.triangles) <= 0)
        found, _ = barycentric(self.points, pair.source, pair.triangles)
        self.assertTrue((~valid[numpy.isin(found, flipped)]).all())
        # An obtuse target and an acute source: Contour does not exist everywhere.
        flat = Pair(numpy.array([[0, 0], [1, 0], [0.5, 1.0]]), numpy.array([[0, 0], [1, 0], [3, 0.05]]),
                    numpy.array([[0, 1, 2]]))
        write_json(self.path("flat.json"), flat)
        write_csv(self.path("middle.csv"), [[0.5, 0.4]])
        self.refuse(REFUSED, "map", "-s", "contour", "flat.json", "middle.csv", "-o", "new.csv",
                    says="--linear-where-discordant")
        self.run_dhm("map", "-s", "contour", "--linear-where-discordant", "flat.json", "middle.csv",
                     "-o", "new.csv")


def read_legacy(path):
    """The points of a binary legacy file, and its point arrays."""
    data = path.read_bytes()
    match = re.search(rb"POINTS (\d+) (double|float)\n", data)
    count = int(match[1])
    points = numpy.frombuffer(data, ">f8" if match[2] == b"double" else ">f4", 3 * count, match.end())
    arrays = {}
    after = data[data.find(b"POINT_DATA"):]
    for found in re.finditer(rb"\n(\w+) (\d+) (\d+) double\n", after):
        components = int(found[2])
        values = numpy.frombuffer(after, ">f8", components * int(found[3]), found.end())
        arrays[found[1].decode()] = values.reshape(-1, components).squeeze()
    return points.reshape(-1, 3), arrays


class Coordinates(ProgramTest):
    def test_ranges_and_known_points(self):
        pair = make_pair(3, 3)
        write_off(self.path("mesh.off"), pair.source, pair.triangles)
        corners = pair.source[pair.triangles]
        centers, middles = corners.mean(axis=1), (corners[:, 1] + corners[:, 2]) / 2
        random = inside_points(pair, 300)
        write_csv(self.path("points.csv"), numpy.vstack((centers, middles, pair.source, random)))
        table = read_csv(self.run_dhm("coordinates", "mesh.off", "points.csv", "-o", "-").out.decode())
        n, m = len(centers), len(pair.source)
        e, p, c = (table[name] for name in ("EdgeLabel", "EdgeParameter", "ContourParameter"))
        self.assertTrue(numpy.isin(e[n:], (1, 2, 3)).all())
        self.assertTrue(((p >= 0) & (p <= 1) & (c >= 0) & (c <= 1)).all())
        self.assert_near(c[:n], numpy.zeros(n), 1e-15)
        self.assertEqual(table["TriangleId"][:n].tolist(), list(range(n)))
        self.assert_near(c[n:2 * n], numpy.ones(n), 1e-15)
        self.assert_near(p[n:2 * n], numpy.full(n, 0.5), 1e-15)
        self.assert_near(c[2 * n:2 * n + m], numpy.ones(m), 1e-15)
        self.assert_near(numpy.abs(p[2 * n:2 * n + m] - 0.5), numpy.full(m, 0.5), 1e-15)
        # Points stay where they are.
        self.assert_near(places(table)[2 * n + m:], random, 0)
        self.assertTrue((table["vtkValidPointMask"] == 1).all())
        found, _ = barycentric(random, pair.source, pair.triangles)
        self.assertTrue((table["TriangleId"][2 * n + m:] == found).all())

    def test_a_pair_has_the_same_coordinates_in_both_meshes(self):
        pair = make_pair(3, 3)
        write_json(self.path("pair.json"), pair)
        for side in (0, 1):
            write_obj(self.path(f"{side}.obj"), pair[side], pair.triangles)
        for system in ("linear", "contour", "smooth"):
            options = ("-s", system, "--linear-where-discordant")
            images = places(self.map_points(["pair.json"], inside_points(pair, 200), *options))
            write_csv(self.path("images.csv"), images)
            tables = [read_csv(self.run_dhm("coordinates", *options, f"{side}.obj", name, "-o", "-")
                               .out.decode()) for side, name in ((0, "points.csv"), (1, "images.csv"))]
            discordant = numpy.zeros(200, bool)
            if system == "contour":
                discordant = numpy.abs(tables[0]["EdgeParameter"] - tables[1]["EdgeParameter"]) > 1e-9
                self.assertLess(discordant.sum(), 100)
            for name in ("TriangleId", "EdgeLabel", "EdgeParameter", "ContourParameter"):
                self.assert_near(tables[0][name][~discordant], tables[1][name][~discordant], 1e-11)

    def test_refusals(self):
        write_csv(self.path("points.csv"), [[5, 5]])
        write_off(self.path("mesh.off"), *make_grid(1, 1))
        self.refuse(REFUSED, "coordinates", "--require-inside", "mesh.off", "points.csv", "-o", "new.csv",
                    says="outside")
        write_off(self.path("flat.off"), numpy.array([[0, 0], [1, 1], [2, 2]]), numpy.array([[0, 1, 2]]))
        self.refuse(REFUSED, "coordinates", "flat.off", "points.csv", "-o", "new.csv",
                    says=("flat.off: ", "area"))
        self.refuse(WRONG_USAGE, "coordinates", "mesh.off", "-o", "new.csv")
        self.refuse(FILE_TROUBLE, "coordinates", "none.off", "points.csv", "-o", "new.csv", says="none.off")


class Check(ProgramTest):
    def check(self, pair, *options, status=YES):
        write_json(self.path("pair.json"), pair)
        report = json.loads(self.run_dhm("check", "--json", *options, "pair.json", status=status).out)
        self.assertEqual(report["valid"], status == YES)
        return report

    def test_counts(self):
        columns, rows_ = 5, 4
        report = self.check(make_pair(columns, rows_))
        for side in ("source", "target"):
            self.assertEqual(report[side]["file"], "pair.json")
            self.assertEqual(report[side]["points"], 30)
            self.assertEqual(report[side]["triangles"], 40)
            self.assertEqual(report[side]["unused_points"], 0)
            self.assertEqual(report[side]["duplicate_points"], 0)
            self.assertTrue(report[side]["planar"])
        self.assertEqual(report["problems"], [])
        self.assertFalse(report["mirrored"])
        self.assertEqual(report["boundary_edges"], 2 * (columns + rows_))
        self.assertEqual(report["interior_edges"], (3 * 40 - 18) // 2)
        self.assertEqual((report["components"], report["boundary_loops"]), (1, 1))
        self.assertEqual(report["mended_windings"], 0)
        self.assertEqual(report["reordered_triangles"], 0)

    def test_measures(self):
        pair = make_pair(4, 4)
        report = self.check(pair)
        corners = [points[pair.triangles] for points in (pair.source, pair.target)]
        sides = [numpy.stack((p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=2) for p in corners]
        linear = sides[1] @ numpy.linalg.inv(sides[0])
        stretches = numpy.linalg.svd(linear, compute_uv=False)
        for name, values, best in (("largest_stretch", stretches[:, 0], numpy.argmax),
                                   ("smallest_stretch", stretches[:, 1], numpy.argmin),
                                   ("worst_distortion", stretches[:, 0] / stretches[:, 1], numpy.argmax)):
            self.assertEqual(report[name]["cell"], best(values))
            self.assertAlmostEqual(report[name]["value"], values[best(values)], 12)
        determinants = numpy.linalg.det(linear)
        systems = report["systems"]
        self.assertAlmostEqual(systems["Linear"]["smallest_determinant"]["value"], determinants.min(), 12)
        self.assertAlmostEqual(systems["Linear"]["largest_determinant"]["value"], determinants.max(), 12)
        self.assertEqual(systems["Linear"]["largest_distance_from_linear"]["value"], 0)
        for system in systems.values():
            self.assertEqual(system["not_positive"], 0)
            self.assertGreater(system["smallest_determinant"]["value"], 0)
        edges = report["interior_edges"]
        self.assertEqual(systems["Smooth"]["differentiable_edges"], edges)
        self.assertEqual(systems["Smooth"]["creases"], 0)
        self.assertEqual(systems["Linear"]["creases"], edges)
        for side, p in zip(("source", "target"), corners):
            angles = []
            for k in range(3):
                u, v = p[:, (k + 1) % 3] - p[:, k], p[:, (k + 2) % 3] - p[:, k]
                cosine = (u * v).sum(axis=1) / numpy.linalg.norm(u, axis=1) / numpy.linalg.norm(v, axis=1)
                angles.append(numpy.degrees(numpy.arccos(cosine)))
            self.assertAlmostEqual(report[side]["smallest_angle_degrees"]["value"], numpy.min(angles), 9)

    def test_annulus_and_components(self):
        report = self.check(make_annulus(), "--quick")
        self.assertEqual((report["components"], report["boundary_loops"]), (1, 2))
        self.assertEqual((report["boundary_edges"], report["interior_edges"]), (24, 24))
        a, b = make_pair(2, 2), make_annulus()
        two = Pair(numpy.vstack((a.source, b.source + 5)), numpy.vstack((a.target, b.target + 5)),
                   numpy.vstack((a.triangles, b.triangles + len(a.source))))
        report = self.check(two, "--quick")
        self.assertEqual((report["components"], report["boundary_loops"]), (2, 3))

    def test_windings(self):
        pair = make_pair()
        mixed = pair.triangles.copy()
        mixed[[3, 17, 22]] = mixed[[3, 17, 22]][:, ::-1]
        self.assertEqual(self.check(pair._replace(triangles=mixed), "--quick")["mended_windings"], 3)
        write_off(self.path("a.off"), pair.source, pair.triangles)
        write_off(self.path("b.off"), pair.target, mixed)
        report = json.loads(self.run_dhm("check", "--json", "--quick", "a.off", "b.off").out)
        self.assertEqual(report["reordered_triangles"], 3)
        mirrored = pair._replace(target=pair.target * [-1, 1])
        self.assertTrue(self.check(mirrored)["mirrored"])

    def test_unused_and_duplicate_points(self):
        pair = make_pair(2, 2)
        more = Pair(numpy.vstack((pair.source, pair.source[3], [9, 9])),
                    numpy.vstack((pair.target, [7, 7], [9, 9])), pair.triangles)
        report = self.check(more, "--quick")
        self.assertEqual(report["source"]["unused_points"], 2)
        self.assertEqual(report["source"]["duplicate_points"], 1)
        self.assertEqual(report["source"]["first_duplicates"], [9])
        self.assertEqual(report["target"]["duplicate_points"], 0)

    def test_offenders(self):
        """Each kind of defect is named, with its cells, and so is the status."""
        pair = make_pair(3, 3, move=0)
        def moved(point, place):
            target = pair.target.copy()
            target[point] = place
            return pair._replace(target=target)
        def with_triangles(*triangles):
            return pair._replace(triangles=numpy.vstack((pair.triangles, triangles)))
        flipped = moved(5, [0.95, 0.5])
        cases = {
            "flipped": flipped,
            "no area": moved(5, pair.target[6]),
            "repeated corner": with_triangles((0, 0, 1)),
        }
        for kind, bad in cases.items():
            report = self.check(bad, "--quick", status=REFUSED)
            kinds = {problem["kind"]: problem for problem in report["problems"]}
            self.assertIn(kind, kinds)
            self.assertTrue(kinds[kind]["first_cells"] and kinds[kind]["message"])
        report = self.check(flipped, "--quick", status=REFUSED)
        problem = next(p for p in report["problems"] if p["kind"] == "flipped")
        wrong = numpy.flatnonzero(doubled_areas(flipped.target, flipped.triangles) < 0)
        self.assertEqual(problem["count"], len(wrong))
        self.assertEqual(problem["first_cells"], wrong.tolist())
        # Three triangles on an edge, in space.
        fin = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0.5, 0, 1]])
        write_off(self.path("fin.off"), fin, numpy.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]]))
        report = json.loads(self.run_dhm("check", "--json", "fin.off", "fin.off", status=REFUSED).out)
        self.assertIn("edge of many triangles", [problem["kind"] for problem in report["problems"]])
        # Overlapping without being flipped: a strip wound around twice.
        t = numpy.arange(0, 4 * numpy.pi, 0.3)
        ring = numpy.vstack([r * numpy.column_stack((numpy.cos(t), numpy.sin(t))) for r in (1, 2)])
        straight = numpy.vstack([numpy.column_stack((t, numpy.full_like(t, r))) for r in (2, 1)])
        n = len(t)
        strip = [(k, n + k, n + k + 1) for k in range(n - 1)]
        strip += [(k, n + k + 1, k + 1) for k in range(n - 1)]
        report = self.check(Pair(straight, ring, numpy.array(strip)), "--quick", status=REFUSED)
        self.assertIn("overlapping", [problem["kind"] for problem in report["problems"]])

    def test_invalid_triangles_do_not_touch_the_measures_of_others(self):
        """What is said of the valid triangles is what is said of them alone."""
        pair = make_pair(4, 4, seed=3)
        alone = self.check(pair)
        # Without area in the source; over many others in the target.
        along = numpy.vstack((pair.triangles, [0, 6, 24]))
        for bad in (pair._replace(triangles=along),
                    Pair(pair.target, pair.source, along)):
            report = self.check(bad, status=REFUSED)
            self.assertEqual([problem["kind"] for problem in report["problems"]], ["no area"])
            self.assertEqual(report["problems"][0]["first_cells"], [32])
            sides = ("source", "target") if bad.source is pair.source else ("target", "source")
            for side, other in zip(("source", "target"), sides):
                for name in ("discordant_triangles", "smallest_angle_degrees",
                             "largest_area_ratio_across_an_edge"):
                    self.assertEqual(report[side][name], alone[other][name], name)
        # Nothing to compare is no number.
        single = Pair(numpy.array([[0, 0], [1, 0], [0, 1]]), numpy.array([[0, 0], [1, 0], [0, 2]]),
                      numpy.array([[0, 1, 2]]))
        report = self.check(single, "--quick")
        self.assertIsNone(report["source"]["largest_area_ratio_across_an_edge"])
        self.assertAlmostEqual(report["source"]["smallest_angle_degrees"]["value"], 45)
        self.assertRegex(self.run_dhm("check", "--quick", "pair.json").out.decode(),
                         r"largest area ratio across an edge +none +none\n")

    def test_mismatched_pairs(self):
        pair = make_pair(3, 3)
        write_off(self.path("a.off"), pair.source, pair.triangles)
        write_off(self.path("fewer.off"), pair.source[:15], pair.triangles[:2])
        other = pair.triangles.copy()
        other[4] = other[5]
        write_off(self.path("other.off"), pair.target, other)
        for name, kinds in (("fewer.off", {"point counts differ", "cell counts differ"}),
                            ("other.off", {"connectivity differs"})):
            result = self.run_dhm("check", "--json", "a.off", name, status=REFUSED)
            found = {problem["kind"] for problem in json.loads(result.out)["problems"]}
            self.assertTrue(kinds & found, found)
            write_csv(self.path("points.csv"), [[0.5, 0.5]])
            for command in (["map", "a.off", name, "points.csv", "-o", "new.csv"],
                            ["refine", "--within", "0.1", "a.off", name, "-o", "new.json"],
                            ["convert", "a.off", name, "-o", "new.json"],
                            ["morph", "a.off", name, "-o", "new%d.vtp"],
                            ["figure", "a.off", name, "-o", "new.png"]):
                self.refuse(REFUSED, *command, says=f"a.off and {name}: ")

    def test_a_report_for_people(self):
        write_json(self.path("pair.json"), make_annulus())
        out = self.run_dhm("check", "pair.json").out.decode()
        self.assertIn("pair.json: a valid pair", out)
        self.assertRegex(out, r"boundary loops +2\n")
        self.assertRegex(out, r"points +24 +24\n")
        self.assertRegex(out, r"edges: creases +24 +\d+ +0\n")
        pair = make_pair(2, 2)
        write_json(self.path("pair.json"), pair._replace(target=pair.target[::-1] * 0))
        result = self.run_dhm("check", "pair.json", status=REFUSED)
        self.assertIn("NOT a valid pair", result.out.decode())
        self.assertIn("not a valid pair", result.err)

    def test_pictures(self):
        write_json(self.path("pair.json"), make_pair())
        self.run_dhm("check", "--quick", "pair.json", "--picture", "pair.png")
        self.assertEqual(png_size(self.path("pair.png").read_bytes())[0], 2 * 620 + 30)
        # A picture of an invalid pair is wanted most.
        pair = make_pair(2, 2)
        write_json(self.path("bad.json"), pair._replace(target=pair.source * [[1, 1]] * (pair.source < 1)))
        self.run_dhm("check", "--quick", "bad.json", "--picture", "bad.svg", status=REFUSED)
        xml.etree.ElementTree.parse(self.path("bad.svg"))
        self.refuse(WRONG_USAGE, "check", "pair.json", "--picture", "pair.gif", says=("pair.gif", ".png"))
        self.refuse(FILE_TROUBLE, "check", "pair.json", "--picture", "pair.png", says="--force")
        self.run_dhm("check", "--quick", "pair.json", "--picture", "pair.png", "--force")

    def test_triangles_that_share_no_points(self):
        """They are no fault, but hardly meant."""
        def check(name):
            return self.run_dhm("check", "--quick", "--json", *name)
        pair = make_pair(4, 4)
        separate = numpy.arange(pair.triangles.size).reshape(-1, 3)
        for side, points in ((0, pair.source), (1, pair.target)):
            write_off(self.path(f"{side}.off"), points[pair.triangles].reshape(-1, 2), separate)
        result = check(["0.off", "1.off"])
        report = json.loads(result.out)
        self.assertEqual((report["interior_edges"], report["components"]), (0, 32))
        for words in (f"{96 - 25} points", "0 edges join two triangles", "vtkCleanPolyData", "dhm convert"):
            self.assertIn(words, result.err)
        # Points of one place that are joined by triangles all the same are none of this: a cut.
        points, triangles = make_grid(4, 4)
        cut = triangles.copy()
        upper = points[triangles].mean(axis=1)[:, 1] > 0.5
        twins = {k: len(points) + i for i, k in enumerate(numpy.flatnonzero(points[:, 1] == 0.5))}
        cut[upper] = numpy.vectorize(lambda k: twins.get(k, k))(cut[upper])
        write_off(self.path("cut.off"), numpy.vstack((points, points[list(twins)])), cut)
        result = check(["cut.off", "cut.off"])
        self.assertEqual(json.loads(result.out)["source"]["duplicate_points"], 5)
        self.assertEqual(result.err, "")

    def test_the_meshes_are_reported_before_the_map_is_measured(self):
        write_json(self.path("pair.json"), make_pair(40, 40, move=0.2))
        expected = self.run_dhm("check", "pair.json").out
        with subprocess.Popen([PROGRAM, "check", "pair.json"], cwd=self.folder, env=self.environment,
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
            first = os.read(process.stdout.fileno(), 1 << 16)
            self.assertIsNone(process.poll())
            rest = process.stdout.read()
        self.assertIn(b"worst distortion", first)
        self.assertNotIn(b"det J", first)
        self.assertEqual(first + rest, expected)

    def test_surfaces_and_empty_meshes(self):
        points, triangles = make_grid(4, 4)
        bent = [numpy.column_stack((points, h * points[:, 0] ** 2)) for h in (0.3, 0.7)]
        for side in (0, 1):
            write_off(self.path(f"{side}.off"), bent[side], triangles)
        report = json.loads(self.run_dhm("check", "--json", "0.off", "1.off").out)
        self.assertFalse(report["source"]["planar"])
        self.assertEqual(report["systems"]["Smooth"]["not_positive"], 0)
        self.path("empty.off").write_text("OFF\n0 0 0\n")
        self.refuse(FILE_TROUBLE, "check", "empty.off", "empty.off", says=("empty.off", "no triangles"))


class Warp(ProgramTest):
    width, height = 24, 18

    def setUp(self):
        super().setUp()
        random = numpy.random.default_rng(4)
        self.image = random.integers(0, 256, (self.height, self.width, 3)).astype(numpy.uint8)
        write_pnm(self.path("image.ppm"), self.image)
        self.pair = make_pair(4, 3, width=self.width - 1, height=self.height - 1)

    def warp(self, pair, *options, image="image.ppm", output="out.ppm"):
        write_json(self.path("pair.json"), pair)
        self.run_dhm("warp", "--force", *options, "pair.json", image, "-o", output)
        return self.path(output).read_bytes()

    def test_identity_keeps_all_pixels(self):
        identity = self.pair._replace(target=self.pair.source)
        self.assertTrue((read_pnm(self.warp(identity)) == self.image).all())
        rgba = read_png(self.warp(identity, output="out.png"))
        self.assertTrue((rgba[:, :, :3] == self.image).all())
        self.assertTrue((rgba[:, :, 3] == 255).all())
        write_pnm(self.path("gray.pgm"), self.image[:, :, 0])
        gray = read_pnm(self.warp(identity, image="gray.pgm", output="gray-out.pgm"))
        self.assertTrue((gray == self.image[:, :, 0]).all())
        for extension in ("vti", "tif"):
            self.warp(identity, output=f"there.{extension}")
            again = read_png(self.warp(identity, image=f"there.{extension}", output="again.png"))
            self.assertTrue((again == rgba).all())

    def test_shift(self):
        # Four pixels to the right and three up; rows are counted from above.
        shifted = self.pair._replace(target=self.pair.source + [4, 3])
        rgba = read_png(self.warp(shifted, output="out.png"))
        self.assertTrue((rgba[:-3, 4:, :3] == self.image[3:, :-4]).all())
        alpha = numpy.zeros((self.height, self.width))
        alpha[:-3, 4:] = 255
        self.assertTrue((rgba[:, :, 3] == alpha).all())
        self.assertTrue((rgba[alpha == 0] == 0).all())
        back = read_png(self.warp(shifted, "--inverse", output="out.png"))
        self.assertTrue((back[3:, :-4, :3] == self.image[:-3, 4:]).all())
        white = read_pnm(self.warp(shifted))
        self.assertTrue((white[alpha == 0] == 255).all())
        orange = read_png(self.warp(shifted, "--background", "#ff8001", output="out.png"))
        self.assertEqual(orange.shape[2], 3)
        self.assertTrue((orange[alpha == 0] == [255, 128, 1]).all())
        black = read_pnm(self.warp(shifted, "--background", "black", "--size", "40x30"))
        self.assertEqual(black.shape, (30, 40, 3))
        self.assertTrue((black[30 - 18 - 3:30 - 3, 4:28] == self.image).all())
        self.assertEqual(black.astype(int).sum(), self.image.astype(int).sum())

    def test_alpha_is_carried(self):
        alpha = numpy.random.default_rng(5).integers(0, 256, self.image.shape[:2] + (1,))
        rgba = numpy.concatenate((self.image, alpha), axis=2)
        write_png(self.path("rgba.png"), rgba)
        shifted = self.pair._replace(target=self.pair.source + [4, 0])
        out = read_png(self.warp(shifted, image="rgba.png", output="out.png"))
        self.assertTrue((out[:, 4:] == rgba[:, :-4]).all())
        self.assertTrue((out[:, :4] == 0).all())

    def test_pixels_are_looked_up_by_the_inverse(self):
        out = read_pnm(self.warp(self.pair, output="out.ppm")).astype(float)
        row, column = numpy.mgrid[0:self.height, 0:self.width]
        points = numpy.column_stack((column.ravel(), self.height - 1 - row.ravel()))
        origins = places(self.map_points(["pair.json"], points, "--inverse"))
        x = origins[:, 0].clip(0, self.width - 1)
        y = self.height - 1 - origins[:, 1].clip(0, self.height - 1)
        i, j = (numpy.minimum(v.astype(int), n - 2) for v, n in ((x, self.width), (y, self.height)))
        u, v = (x - i)[:, None], (y - j)[:, None]
        image = self.image.astype(float)
        expected = ((1 - v) * ((1 - u) * image[j, i] + u * image[j, i + 1]) +
                    v * ((1 - u) * image[j + 1, i] + u * image[j + 1, i + 1]))
        self.assertLessEqual(numpy.abs(out.reshape(-1, 3) - expected).max(), 0.5 + 1e-6)

    def test_pictures_of_many_kinds(self):
        """Text, larger values, 16 bits, palettes and thin gray: they are read as what they say."""
        identity = self.pair._replace(target=self.pair.source)
        self.path("text.ppm").write_text(
            f"P3 {self.width}\n# comment\n{self.height} 255 " + " ".join(map(str, self.image.ravel())))
        self.assertTrue((read_pnm(self.warp(identity, image="text.ppm")) == self.image).all())
        self.path("small.pgm").write_bytes(f"P5 {self.width} {self.height} 15\n".encode() +
                                           (self.image[:, :, 0] // 16).tobytes())
        small = read_pnm(self.warp(identity, image="small.pgm", output="out.pgm"))
        self.assertTrue((small == self.image[:, :, 0] // 16 * 17).all())
        deep = self.image[:, :, 0].astype(">u2") * 256 + 7
        self.path("deep.pgm").write_bytes(f"P5 {self.width} {self.height} 65535\n".encode() +
                                          deep.tobytes())
        self.warp(identity, image="deep.pgm", output="deep.vti")
        self.warp(identity, image="deep.pgm", output="deep.png", *["--background", "white"])
        self.warp(identity, image="deep.png", output="again.png", *["--background", "white"])
        self.assertEqual(self.path("deep.png").read_bytes(), self.path("again.png").read_bytes())
        self.assertEqual(self.path("deep.png").read_bytes()[24], 16)
        self.refuse(REFUSED, "warp", "pair.json", "deep.pgm", "-o", "new.pgm", says=("8 bits", ".png"))

    def test_pixels_that_a_picture_cannot_hold(self):
        write_json(self.path("pair.json"), self.pair)
        def write_vti(name, layers):
            values = " ".join(str(k / 7) for k in range(24 * layers))
            extent = f"0 5 0 3 0 {layers - 1}"
            self.path(name).write_text(
                f'<?xml version="1.0"?>\n<VTKFile type="ImageData" version="0.1"><ImageData WholeExtent='
                f'"{extent}" Origin="0 0 0" Spacing="1 1 1"><Piece Extent="{extent}"><PointData Scalars="s">'
                f'<DataArray type="Float32" Name="s" format="ascii">{values}</DataArray></PointData></Piece>'
                "</ImageData></VTKFile>")
        write_vti("float.vti", 1)
        write_vti("volume.vti", 2)
        for extension in ("png", "jpg", "ppm"):
            self.refuse(REFUSED, "warp", "pair.json", "float.vti", "-o", f"new.{extension}",
                        says=(f".{extension}", "float", ".vti"))
        for extension in ("png", "jpg", "ppm", "tif"):
            self.refuse(REFUSED, "warp", "pair.json", "volume.vti", "-o", f"new.{extension}",
                        says=("one layer", ".vti"))
        # Of elevations, say.
        write_json(self.path("same.json"), self.pair._replace(target=self.pair.source))
        options = ("--background", "black", "same.json")
        self.run_dhm("warp", *options, "float.vti", "-o", "a.tif")
        self.run_dhm("warp", *options, "a.tif", "-o", "b.tif")
        self.assertEqual(self.path("a.tif").read_bytes(), self.path("b.tif").read_bytes())
        values = numpy.frombuffer(read_tiff(self.path("a.tif").read_bytes()), "<f4").reshape(4, 6)[::-1]
        self.assert_near(values.ravel(), numpy.arange(24) / 7, 1e-6)
        self.path("deep.pgm").write_bytes(b"P5 2 2 65535\n" + bytes(8))
        self.refuse(REFUSED, "warp", "pair.json", "deep.pgm", "-o", "new.jpg", says=(".jpg", "short"))

    def test_wrong_colours_sizes_and_names(self):
        write_json(self.path("pair.json"), self.pair)
        def refuse(*options, output="new.png", says):
            self.refuse(WRONG_USAGE, "warp", "pair.json", "image.ppm", *options, "-o", output, says=says)
        for color in ("red", "#12345", "#12345g", "#1234567", ""):
            if color:
                refuse("--background", color, says=(color, "#rrggbb"))
        for size in ("0x5", "5", "x", "5x", "-3x4", "3x4x5", "1e3x2", "200000x2", "4.5x3"):
            refuse("--size=" + size, says=(size, "WIDTHxHEIGHT", "from 1 to 100000"))
        refuse("--background", "transparent", output="new.ppm", says=("transparent", ".ppm"))
        refuse("--background", "transparent", output="new.jpg", says=("transparent", ".jpg"))
        for name in ("new", "new.gif", "new.csv", "new.vtp"):
            refuse(output=name, says=".png")
        self.refuse(WRONG_USAGE, "warp", "pair.json", "-o", "new.png")

    def test_meshes_beside_the_image(self):
        boxes = ("x from 0 to 23, y from 0 to 17", "x from 1000 to 1001, y from 0 to 1")
        small = make_pair(2, 2)
        beside = Pair(small.source + [1000, 0], small.target + [1000, 0], small.triangles)
        write_json(self.path("beside.json"), beside)
        source, target = "the source of beside.json", "the target of beside.json"
        for command, name in ((["warp", "beside.json", "image.ppm", "-o", "new.png"], source),
                              (["warp", "-i", "beside.json", "image.ppm", "-o", "new.png"], target),
                              (["figure", "beside.json", "--image", "image.ppm", "-o", "new.png"], source),
                              (["morph", "beside.json", "--source-image", "image.ppm", "-o", "new%d.png"], source),
                              (["morph", "beside.json", "--target-image", "image.ppm", "-o", "new%d.png"], target)):
            self.refuse(REFUSED, *command, says=("image.ppm", name, *boxes, "do not overlap"))
        # An image that is seen nowhere.
        write_json(self.path("away.json"), Pair(self.pair.source, self.pair.target + 500, self.pair.triangles))
        self.refuse(REFUSED, "warp", "away.json", "image.ppm", "-o", "new.png",
                    says=("the result", "the target of away.json", "do not overlap"))
        # Perhaps from 0 to 1 instead of in pixels.
        write_json(self.path("unit.json"), small)
        result = self.run_dhm("warp", "unit.json", "image.ppm", "-o", "unit.png")
        self.assertIn("less than a hundredth", result.err)
        write_json(self.path("pair.json"), self.pair)
        self.assertEqual(self.run_dhm("warp", "pair.json", "image.ppm", "-o", "pair.png").err, "")

    def test_xmorph_meshes(self):
        # In xmorph's own units, ten to a pixel; the middle of the rim does not touch the picture's end.
        points, _ = make_grid(3, 2, 10 * (self.width - 1), 10 * (self.height - 1))
        write_mesh(self.path("a.mesh"), 4, points)
        self.run_dhm("warp", "a.mesh", "a.mesh", "image.ppm", "-o", "out.ppm")
        self.assertTrue((read_pnm(self.path("out.ppm").read_bytes()) == self.image).all())
        inner = points.copy()
        inner[:4, 1] += 30
        write_mesh(self.path("b.mesh"), 4, inner)
        self.refuse(WRONG_USAGE, "warp", "b.mesh", "b.mesh", "image.ppm", "-o", "new.ppm",
                    says=("b.mesh", "--working-size"))
        self.run_dhm("warp", "b.mesh", "b.mesh", "image.ppm", "-f", "-o", "out.ppm", "--working-size",
                     f"{self.width}x{self.height}")
        out = read_pnm(self.path("out.ppm").read_bytes())
        self.assertTrue((out[3:] == self.image[3:]).all())
        self.assertTrue((out[:3] == 255).all())
        write_mesh(self.path("c.mesh"), 3, points)
        self.refuse(FILE_TROUBLE, "warp", "a.mesh", "c.mesh", "image.ppm", "-o", "new.ppm",
                    says="columns and rows")
        write_off(self.path("a.off"), points, make_grid(3, 2)[1])
        self.refuse(WRONG_USAGE, "warp", "a.mesh", "a.off", "image.ppm", "-o", "new.ppm", says=".mesh")


class Morph(ProgramTest):
    def setUp(self):
        super().setUp()
        random = numpy.random.default_rng(6)
        self.images = random.integers(0, 256, (2, 18, 24, 3)).astype(numpy.uint8)
        for side in (0, 1):
            write_pnm(self.path(f"{side}.ppm"), self.images[side])
        self.pair = make_pair(4, 3, width=23, height=17)
        write_json(self.path("pair.json"), self.pair)

    def test_frames_begin_and_end_with_the_images(self):
        self.run_dhm("morph", "pair.json", "--source-image", "0.ppm", "--target-image", "1.ppm",
                     "--frames", "3", "-o", "frame-%03d.ppm")
        frames = [read_pnm(self.path(f"frame-00{k}.ppm").read_bytes()) for k in range(3)]
        self.assertTrue((frames[0] == self.images[0]).all())
        self.assertTrue((frames[2] == self.images[1]).all())
        # Half-way: the two images on the mesh in between, in equal parts.
        halves = []
        between = (self.pair.source + self.pair.target) / 2
        for side in (0, 1):
            write_json(self.path("half.json"), Pair(self.pair[side], between, self.pair.triangles))
            self.run_dhm("warp", "half.json", f"{side}.ppm", "-f", "-o", "half.ppm")
            halves.append(read_pnm(self.path("half.ppm").read_bytes()).astype(float))
        self.assertLessEqual(numpy.abs(frames[1] - (halves[0] + halves[1]) / 2).max(), 0.501)

    def test_one_image_and_other_formats(self):
        for extension in ("png", "jpg", "ppm", "vti"):
            self.run_dhm("morph", "pair.json", "--source-image", "0.ppm", "-n", "2",
                         "-o", f"one%d.{extension}")
        self.assertTrue((read_png(self.path("one0.png").read_bytes())[:, :, :3] == self.images[0]).all())
        self.assertTrue((read_pnm(self.path("one0.ppm").read_bytes()) == self.images[0]).all())
        self.assertEqual(self.path("one1.jpg").read_bytes()[:3], b"\xff\xd8\xff")
        self.refuse(WRONG_USAGE, "morph", "pair.json", "--source-image", "0.ppm", "-n", "2",
                    "-o", "new%d.jpg", "--background", "transparent", says="transparent")

    def test_meshes_move_along_straight_lines(self):
        self.run_dhm("morph", "pair.json", "-n", "5", "-o", "m%d.vtk")
        for k in range(5):
            points, _ = read_legacy(self.path(f"m{k}.vtk"))
            expected = self.pair.source + k / 4 * (self.pair.target - self.pair.source)
            self.assert_near(points[:, :2], expected, 1e-13)
        write_vtk(self.path("data.vtk"), inside_points(self.pair, 50), numpy.array([[0, 1, 2]]))
        self.run_dhm("morph", "pair.json", "-n", "2", "--data", "data.vtk", "-o", "d%d.vtk")
        points, _ = read_legacy(self.path("d1.vtk"))
        self.assert_near(points[:, :2],
                         places(self.map_points(["pair.json"], inside_points(self.pair, 50))), 0)

    def test_folds_are_refused(self):
        # Turned by a half: all points meet half-way.
        turned = self.pair._replace(target=[23, 17] - self.pair.source)
        write_json(self.path("turned.json"), turned)
        self.refuse(REFUSED, "morph", "turned.json", "-n", "3", "-o", "new%d.vtp",
                    says=("turned.json: ", "24 triangles are turned over", "frame 1", "0.5"))
        # At none of the frames.
        result = self.run_dhm("morph", "turned.json", "-n", "2", "-o", "two%d.vtp")
        self.assertIn("at none of the frames", result.err)
        mirrored = self.pair._replace(target=self.pair.source * [-1, 1])
        write_json(self.path("mirrored.json"), mirrored)
        self.refuse(REFUSED, "morph", "mirrored.json", "-o", "new%d.vtp", says="mirror image")
        # One triangle only: a corner passes over the opposite edge and back... in a curve of areas.
        bad = self.pair.target.copy()
        bad[6] = [20, 15]
        write_json(self.path("bad.json"), self.pair._replace(target=bad))
        self.refuse(REFUSED, "morph", "bad.json", "-o", "new%d.vtp", says="flipped")

    def test_refusals(self):
        def refuse(status, *options, output="new%d.png", says=()):
            self.refuse(status, "morph", "pair.json", *options, "-o", output, says=says)
        images = ("--source-image", "0.ppm", "--target-image", "1.ppm")
        refuse(WRONG_USAGE, *images, output="new.png", says="%03d")
        refuse(WRONG_USAGE, *images, output="new%d.gif", says=".png")
        refuse(WRONG_USAGE, output="new%d.png", says=("--source-image", ".vtp"))
        refuse(WRONG_USAGE, output="new%d-%d.vtp", says=("more than one place", "new%d-%d.vtp"))
        self.path("points.csv").write_text("x,y\n1,2\n")
        refuse(WRONG_USAGE, "--data", "points.csv", output="new%d.vtp", says=("points.csv", "dhm coordinates"))
        refuse(WRONG_USAGE, *images, "--data", "0.ppm", says="--data")
        for frames in ("1", "0", "-1", "x", "nan", "2.5", "1000000"):
            refuse(WRONG_USAGE, *images, "--frames", frames, says=("--frames", frames))
        refuse(FILE_TROUBLE, "--source-image", "none.ppm", says="none.ppm")
        write_pnm(self.path("gray.pgm"), self.images[0][:, :, 0])
        refuse(REFUSED, "--source-image", "0.ppm", "--target-image", "gray.pgm", says="same kind")
        self.path("new3.png").write_text("mine")
        refuse(FILE_TROUBLE, *images, says=("new3.png", "--force"))
        self.assertEqual(self.path("new3.png").read_text(), "mine")
        self.run_dhm("morph", "pair.json", *images, "-n", "4", "-o", "new%d.png", "--force")
        self.assertTrue((read_png(self.path("new3.png").read_bytes())[:, :, :3] == self.images[1]).all())


class Figure(ProgramTest):
    def setUp(self):
        super().setUp()
        write_json(self.path("pair.json"), make_pair(4, 4))

    def test_formats_and_sizes(self):
        for options, panels, more in (((), 2, 0), (("--all-systems",), 4, 0),
                                      (("--close-up", "0.5,0.5,0.1"), 2, 106), (("--contours",), 2, 0)):
            self.run_dhm("figure", "pair.json", "--width", "100", *options, "-f", "-o", "figure.png")
            size = png_size(self.path("figure.png").read_bytes())
            self.assertEqual(size, (106 * panels + 6, 136 + more))
        pixels = read_png(self.path("figure.png").read_bytes())
        self.assertTrue((pixels[0, 0] == 255).all())
        self.assertGreater(len(numpy.unique(pixels.reshape(-1, 3), axis=0)), 10)
        self.run_dhm("figure", "pair.json", "--width", "100", "-o", "figure.svg")
        root = xml.etree.ElementTree.parse(self.path("figure.svg")).getroot()
        self.assertTrue(root.tag.endswith("svg"))
        self.assertEqual([float(root.get(name).rstrip("pt")) for name in ("width", "height")], [218, 136])
        self.run_dhm("figure", "pair.json", "-o", "figure.pdf")
        pdf = self.path("figure.pdf").read_bytes()
        self.assertTrue(pdf.startswith(b"%PDF-") and pdf.rstrip().endswith(b"%%EOF"))

    def test_image_below(self):
        pair = make_pair(3, 3, width=23, height=17)
        write_json(self.path("image.json"), pair)
        image = numpy.zeros((18, 24, 3), numpy.uint8)
        image[:, :, 1] = 200
        write_pnm(self.path("green.ppm"), image)
        self.run_dhm("figure", "image.json", "--image", "green.ppm", "--width", "100", "-o", "figure.png")
        pixels = read_png(self.path("figure.png").read_bytes()).reshape(-1, 3)
        self.assertGreater((pixels == [0, 200, 0]).all(axis=1).mean(), 0.1)

    def test_refusals(self):
        def refuse(*options, output="new.png", says=()):
            self.refuse(WRONG_USAGE, "figure", "pair.json", *options, "-o", output, says=says)
        for name in ("new", "new.jpg", "new.vtp"):
            refuse(output=name, says=(".png", name))
        for values in ("1,2", "1,2,3,4", "a,b,c", "0,0,0", "0,0,-1", "nan,0,1", "0,0,inf", ","):
            refuse("--close-up=" + values, says="X,Y,R")
        for option, values in (("--grid", ("0", "501", "-3", "x", "nan", "1.5")),
                               ("--width", ("0", "49", "5001", "nan", "inf", "x"))):
            for value in values:
                refuse(f"{option}={value}", says=(option, value))
        points, triangles = make_grid(2, 2)
        bent = numpy.column_stack((points, points[:, 0] ** 2))
        write_off(self.path("bent.off"), bent, triangles)
        self.refuse(REFUSED, "figure", "bent.off", "bent.off", "-o", "new.png", says="planes")


class Refine(ProgramTest):
    def setUp(self):
        super().setUp()
        self.pair = make_pair(3, 3)
        write_json(self.path("pair.json"), self.pair, name="A shift", description="As published",
                   input_crs="EPSG:2393")

    def assert_conforming(self, pair):
        counts = edges_of(pair.triangles)
        self.assertLessEqual(max(counts.values()), 2)
        boundary = [edge for edge, count in counts.items() if count == 1]
        # No point hangs on an edge: the boundary is the rectangle's, once around.
        lengths = sum(numpy.linalg.norm(pair.source[a] - pair.source[b]) for a, b in boundary)
        self.assertAlmostEqual(lengths, 4.0, 12)
        self.assertAlmostEqual(doubled_areas(pair.source, pair.triangles).sum() / 2, 1.0, 12)
        self.assertAlmostEqual(doubled_areas(pair.target, pair.triangles).sum() / 2, 1.0, 12)
        for points in (pair.source, pair.target):
            self.assertGreater(doubled_areas(points, pair.triangles).min(), 0)

    def test_within_the_distance(self):
        points = numpy.random.default_rng(7).random((20000, 2))
        smooth = places(self.map_points(["pair.json"], points))
        linear = places(self.map_points(["pair.json"], points, "-s", "linear"))
        worst = numpy.linalg.norm(smooth - linear, axis=1).max()
        sizes = [len(self.pair.triangles)]
        for within in (0.3 * worst, 0.05 * worst):
            result = self.run_dhm("refine", "pair.json", "--within", repr(within), "-f", "-o", "fine.json")
            fine, document = read_json(self.path("fine.json"))
            self.assertRegex(result.err, rf"{len(self.pair.triangles)} triangles became "
                                         rf"{len(fine.triangles)}; farthest from Smooth: ")
            self.assertLessEqual(float(re.search(r"Smooth: ([^,]+),", result.err)[1]), within)
            piecewise = places(self.map_points(["fine.json"], points, "-s", "linear"))
            distances = numpy.linalg.norm(piecewise - smooth, axis=1)
            self.assertLessEqual(distances.max(), within)
            # Not much finer than needed.
            self.assertGreater(distances.max(), 0.3 * within)
            self.assert_near(fine.source[:16], self.pair.source, 0)
            self.assert_near(fine.target[:16], self.pair.target, 0)
            self.assert_conforming(fine)
            sizes.append(len(fine.triangles))
            self.assertEqual((document["name"], document["input_crs"]), ("A shift", "EPSG:2393"))
            self.assertTrue(document["description"].startswith("As published. Refined by dhm"))
        self.assertEqual(sizes, sorted(set(sizes)))

    def test_nothing_to_do_and_other_maps(self):
        self.run_dhm("refine", "pair.json", "--within", "1", "-o", "same.json")
        same, _ = read_json(self.path("same.json"))
        self.assertEqual(same.triangles.tolist(), self.pair.triangles.tolist())
        self.run_dhm("refine", "pair.json", "-s", "linear", "--within", "1e-9", "-f", "-o", "same.json")
        self.assertEqual(len(read_json(self.path("same.json"))[0].triangles), len(self.pair.triangles))
        for output in ("fine.vtp", "fine.vtk"):
            self.run_dhm("refine", "pair.json", "--within", "0.002", "-o", output, "--output-crs", "X:1")
            report = json.loads(self.run_dhm("check", "--quick", "--json", output).out)
            self.assertGreater(report["source"]["triangles"], len(self.pair.triangles))
        result = self.run_dhm("refine", "-q", "pair.json", "--within", "0.01", "-o", "-", "--input-crs",
                              "X:2", "--output-crs", "X:3")
        self.assertEqual(result.err, "")
        document = json.loads(result.out)
        self.assertEqual((document["input_crs"], document["output_crs"]), ("X:2", "X:3"))

    def test_refusals(self):
        def refuse(status, *options, output="new.json", says=()):
            self.refuse(status, "refine", "pair.json", *options, "-o", output, says=says)
        refuse(REFUSED, "--within", "1e-6", "--most-triangles", "500", says=("500", "--most-triangles"))
        refuse(REFUSED, "--within", "1", "--most-triangles", "5", says="--most-triangles")
        for value in ("0", "-1", "nan", "inf", "x", ""):
            refuse(WRONG_USAGE, "--within=" + value, says=("--within", value))
            refuse(WRONG_USAGE, "--within", "1", "--most-triangles=" + value, says="--most-triangles")
        refuse(WRONG_USAGE, says="--within")
        # Before the work, which would say something.
        for output in ("new.obj", "new"):
            result = self.refuse(WRONG_USAGE, "refine", "pair.json", "--within", "1", "-o", output,
                                 says=".json")
            self.assertNotIn("triangles became", result.err)
        refuse(WRONG_USAGE, "--within", "1", output="new.obj", says=(".obj", ".json"))
        refuse(WRONG_USAGE, "--within", "1", "--mask-invalid", says="--mask-invalid")
        refuse(WRONG_USAGE, "--within", "1", output="new", says=".json")
        points, triangles = make_grid(2, 2)
        write_off(self.path("bent.off"), numpy.column_stack((points, points[:, 0] ** 2)), triangles)
        self.refuse(REFUSED, "refine", "bent.off", "bent.off", "--within", "1", "-o", "new.json",
                    says=("bent.off", "plane"))


class Convert(ProgramTest):
    def setUp(self):
        super().setUp()
        pair = make_pair(4, 3)
        # Coordinates with all digits, large and small.
        self.pair = Pair(pair.source * [[1e6 / 3, 7e6 / 9]], pair.target * [[1e6 / 3, 7e6 / 9]],
                         pair.triangles)
        write_json(self.path("pair.json"), self.pair, name="Ä shift", output_crs="EPSG:3067")

    def assert_same(self, name, pair=None):
        read, document = read_json(self.path(name))
        for side in (0, 1):
            self.assert_near(read[side], (pair or self.pair)[side], 0)
        self.assertEqual(read.triangles.tolist(), self.pair.triangles.tolist())
        return document

    def test_one_file(self):
        self.run_dhm("convert", "pair.json", "-o", "again.json")
        document = self.assert_same("again.json")
        self.assertEqual((document["name"], document["output_crs"]), ("Ä shift", "EPSG:3067"))
        for name in ("pair.vtp", "pair.vtk"):
            self.run_dhm("convert", "pair.json", "-o", name)
            self.run_dhm("convert", name, "-f", "-o", "again.json", "--input-crs", "EPSG:2393")
            self.assertEqual(self.assert_same("again.json")["input_crs"], "EPSG:2393")
        self.run_dhm("convert", "pair.json", "-f", "-o", "pair.vtp", "--output-array", "Moved")
        self.refuse(WRONG_USAGE, "convert", "pair.vtp", "-o", "new.json", says=('"Target"', "--target-array"))
        self.run_dhm("convert", "pair.vtp", "--target-array", "Moved", "-f", "-o", "again.json")
        self.assert_same("again.json")

    def test_two_files(self):
        for extension in ("obj", "off", "vtp", "vtk"):
            names = [f"{side}.{extension}" for side in ("source", "target")]
            self.run_dhm("convert", "pair.json", "-o", names[0], "--target-output", names[1])
            self.run_dhm("convert", *names, "-f", "-o", "again.json")
            self.assert_same("again.json")

    def test_meshes_made_by_others(self):
        """Each format that is read, written here by hand."""
        source, target, triangles = self.pair
        writers = {
            "obj": write_obj, "off": write_off, "vtk": write_vtk, "vtu": write_vtu, "ply": write_ply,
            "grid.vtk": lambda path, p, t: write_vtk(path, p, t, grid=True),
            "little.ply": lambda path, p, t: write_ply(path, p, t, "binary_little_endian"),
            "big.ply": lambda path, p, t: write_ply(path, p, t, "binary_big_endian")}
        for extension, write in writers.items():
            for side, points in (("source", source), ("target", target)):
                write(self.path(f"{side}.{extension}"), points, triangles)
            self.run_dhm("convert", f"source.{extension}", f"target.{extension}", "-f", "-o", "again.json")
            self.assert_same("again.json")
        write_vtk(self.path("both.vtk"), source, triangles, target=target)
        self.run_dhm("convert", "both.vtk", "--target-array", "Moved", "-f", "-o", "again.json")
        self.assert_same("again.json")

    def test_single_precision(self):
        halves = Pair(*(p.astype(numpy.float32).astype(float) for p in self.pair[:2]), self.pair.triangles)
        for side in (0, 1):
            write_ply(self.path(f"{side}.ply"), halves[side], halves.triangles, "binary_big_endian", "float")
        self.run_dhm("convert", "0.ply", "1.ply", "-o", "again.json")
        self.assert_same("again.json", halves)

    def test_stl_points_are_joined(self):
        for binary in (False, True):
            pair = self.pair
            if binary:
                pair = Pair(*(p.astype(numpy.float32).astype(float) for p in pair[:2]), pair.triangles)
            for side in (0, 1):
                write_stl(self.path(f"{side}.stl"), pair[side], pair.triangles, binary)
            self.run_dhm("convert", "0.stl", "1.stl", "-f", "-o", "again.json")
            read, _ = read_json(self.path("again.json"))
            self.assertEqual(len(read.source), len(pair.source))
            for side in (0, 1):
                self.assert_near(read[side][read.triangles], pair[side][pair.triangles], 0)
        report = json.loads(self.run_dhm("check", "--json", "--quick", "0.stl", "1.stl").out)
        self.assertEqual((report["components"], report["boundary_loops"]), (1, 1))

    def test_metadata(self):
        """Heights, comments and other columns of a published file."""
        document = json.loads(self.path("pair.json").read_text())
        document["transformed_components"] = ["horizontal", "vertical"]
        document["vertices_columns"] = COLUMNS[::-1] + ["offset_z"]
        document["vertices"] = [vertex[::-1] + [0.5] for vertex in document["vertices"]]
        document["fallback_strategy"] = "none"
        self.path("heights.json").write_text(json.dumps(document))
        result = self.run_dhm("convert", "heights.json", "-o", "again.json")
        self.assertIn("heights", result.err)
        again = self.assert_same("again.json")
        self.assertEqual(again["transformed_components"], ["horizontal"])
        self.assertEqual(again["fallback_strategy"], "none")

    def test_refusals(self):
        def refuse(*arguments, says=()):
            self.refuse(WRONG_USAGE, "convert", "pair.json", *arguments, says=says)
        refuse("-o", "new.obj", says=("--target-output", ".obj"))
        refuse("-o", "new.stl", says=(".stl", ".json"))
        refuse("-o", "new", says=".json")
        refuse("-o", "new.obj", "--target-output", "new.obj", says="--target-output")
        refuse("-o", "new.obj", "--target-output", "target.ply", says=(".ply", ".off"))
        refuse(says="--output")
        points, triangles = make_grid(2, 2)
        write_off(self.path("bent.off"), numpy.column_stack((points, points[:, 0] ** 2)), triangles)
        self.refuse(REFUSED, "convert", "bent.off", "bent.off", "-o", "new.json", says=("bent.off", "z"))


# --- What is wrong with command lines and files


OPTIONS = {
    "pair": "--target-array --input-format --working-size",
    "system": "--system --incenter --linear-where-discordant --tolerance",
    "map options": "--system --incenter --linear-where-discordant --mask-invalid --tolerance",
    "output": "--output --force --output-format",
    "data": "--columns --data-format --require-inside",
}
OPTIONS_OF = {
    "check": f"{OPTIONS['pair']} --json --quick --picture --force",
    "map": f"{OPTIONS['pair']} {OPTIONS['map options']} {OPTIONS['output']} {OPTIONS['data']} --inverse "
           "--jacobian --determinant --triangle-id --carry-all-vectors --keep-vectors",
    "warp": f"{OPTIONS['pair']} {OPTIONS['map options']} {OPTIONS['output']} --image-format --inverse "
            "--size --background",
    "morph": f"{OPTIONS['pair']} {OPTIONS['map options']} --output --force --source-image --target-image "
             "--data --frames --size --background",
    "figure": f"{OPTIONS['pair']} {OPTIONS['map options']} {OPTIONS['output']} --all-systems --grid "
              "--contours --image --close-up --width",
    "coordinates": f"--input-format {OPTIONS['map options']} {OPTIONS['output']} {OPTIONS['data']}",
    "refine": f"{OPTIONS['pair']} {OPTIONS['system']} {OPTIONS['output']} --within --most-triangles "
              "--input-crs --output-crs",
    "convert": f"{OPTIONS['pair']} {OPTIONS['output']} --target-output --output-array --input-crs "
               "--output-crs",
}


class CommandLine(ProgramTest):
    def setUp(self):
        super().setUp()
        write_json(self.path("pair.json"), make_pair(2, 2))
        write_csv(self.path("points.csv"), [[0.5, 0.5], [0.1, 0.7]])

    def test_help(self):
        out = self.run_dhm("--help").out.decode()
        for command in OPTIONS_OF:
            self.assertRegex(out, rf"(?m)^ +{command} ")
        for command, options in OPTIONS_OF.items():
            result = self.run_dhm(command, "--help")
            self.assertEqual(result.err, "")
            text = result.out.decode()
            shown = set(re.findall(r"(?m)^ +(?:-\w,)?(--[\w-]+)", text))
            self.assertEqual(shown - {"--help", "--version", "--quiet"}, set(options.split()), command)
            self.assertLessEqual(max(map(len, text.splitlines())), 100)
            self.assertIn(f"dhm {command}", text)

    def test_manual_page(self):
        page = self.run_dhm("--manual-page").out.decode()
        self.assertTrue(page.startswith(".TH DHM 1"))
        for options in OPTIONS_OF.values():
            for option in options.split():
                self.assertIn(option.replace("-", "\\-"), page)

    def test_version(self):
        for arguments in (["--version"], ["check", "--version"]):
            self.assertRegex(self.run_dhm(*arguments).out.decode(), r"^dhm \d+\.\d+\.\d+\n$")

    def test_wrong_usage(self):
        self.refuse(WRONG_USAGE, says="--help")
        self.refuse(WRONG_USAGE, "chekc", "pair.json", says=('"chekc"', "check", "convert", "--help"))
        self.refuse(WRONG_USAGE, "--chekc", says=("--chekc", "--help"))
        for command in OPTIONS_OF:
            self.refuse(WRONG_USAGE, command, says=f"dhm {command} --help")
            self.refuse(WRONG_USAGE, command, "--no-such-option", "a.json", says=f"dhm {command} --help")
        self.refuse(WRONG_USAGE, "check", "pair.json", "--no-such-option", says="--no-such-option")
        self.refuse(WRONG_USAGE, "check", "a.json", "b.json", "c.json", says="SOURCE [TARGET]")
        self.refuse(WRONG_USAGE, "map", "pair.json", "points.csv", says="--output")
        self.refuse(WRONG_USAGE, "map", "pair.json", "-o", "new.csv", says="SOURCE [TARGET] DATA")
        self.refuse(WRONG_USAGE, "map", "pair.json", "points.csv", "-o", says="--output")

    def test_files_in_the_place_of_others(self):
        pair = make_pair(2, 2)
        write_off(self.path("a.off"), pair.source, pair.triangles)
        write_off(self.path("b.off"), pair.target, pair.triangles)
        write_pnm(self.path("image.pgm"), numpy.zeros((2, 2)))
        for files, said in ((("a.off", "b.off"), "b.off was taken for DATA"),
                            (("points.csv", "pair.json"), "pair.json was taken for DATA"),
                            (("pair.json", "b.off", "points.csv"), "points.csv was taken for DATA")):
            self.refuse(WRONG_USAGE, "map", *files, "-o", "new.vtp", says=("SOURCE [TARGET] DATA", said))
        self.refuse(WRONG_USAGE, "warp", "image.pgm", "pair.json", "-o", "new.png",
                    says=("image.pgm as a mesh", "SOURCE [TARGET] IMAGE", "pair.json was taken for IMAGE"))

    def test_advice_names_only_what_there_is(self):
        pair = make_pair(3, 3, move=0)
        target = pair.target.copy()
        target[5] = [0.95, 0.5]
        write_json(self.path("bad.json"), pair._replace(target=target))
        commands = {"map": ["points.csv", "-o", "new.csv"], "figure": ["-o", "new.png"],
                    "morph": ["-o", "new%d.vtp"], "refine": ["--within", "1", "-o", "new.json"],
                    "convert": ["-o", "new.json"]}
        for command, arguments in commands.items():
            result = self.refuse(REFUSED, command, "bad.json", *arguments, says=("bad.json", "flipped"))
            known = "--mask-invalid" in OPTIONS_OF[command]
            self.assertEqual("use --mask-invalid to leave them out" in result.err, known, command)
            self.assertEqual("--mask-invalid" in result.err, known, command)
        out = self.run_dhm("check", "--quick", "bad.json", status=REFUSED).out.decode()
        self.assertIn("--mask-invalid of dhm map", out)

    def test_out_of_range(self):
        arguments = ("map", "pair.json", "points.csv", "-o", "new.csv")
        self.refuse(WRONG_USAGE, *arguments, "--system=", says="--system")
        for system in ("bicubic", "3"):
            self.refuse(WRONG_USAGE, *arguments, "--system=" + system,
                        says=("--system", "smooth", "contour", "linear", system))
        for tolerance in ("-1", "nan", "inf", "x"):
            self.refuse(WRONG_USAGE, *arguments, "--tolerance=" + tolerance, says=("--tolerance", tolerance))

    def test_names_of_formats(self):
        no_extension = "The output's name has no extension"
        write_pnm(self.path("image.pgm"), numpy.zeros((2, 2)))
        self.refuse(WRONG_USAGE, "map", "pair.json", "points.csv", "-o", "new", says=(no_extension, ".csv"))
        self.refuse(WRONG_USAGE, "warp", "pair.json", "image.pgm", "-o", "new", says=(no_extension, ".png"))
        self.refuse(WRONG_USAGE, "morph", "pair.json", "-o", "new%d", says=(no_extension, ".vtp"))
        self.refuse(WRONG_USAGE, "morph", "pair.json", "--source-image", "image.pgm", "-o", "new%d",
                    says=(no_extension, ".png"))
        self.refuse(WRONG_USAGE, "figure", "pair.json", "-o", "new", says=("new", ".svg"))
        self.refuse(WRONG_USAGE, "convert", "pair.json", "-o", "new", says=(no_extension, ".json"))
        self.refuse(WRONG_USAGE, "convert", "pair.json", "-o", "new", "--target-output", "other",
                    says=(no_extension, ".off"))
        self.refuse(WRONG_USAGE, "map", "pair.json", "points.csv", "-o", "new.xyzzy", says=(".xyzzy", ".csv"))
        self.refuse(WRONG_USAGE, "map", "pair.json", "points.csv", "-o", "new.vtu", says=(".vtu", ".vtp"))
        self.refuse(WRONG_USAGE, "map", "pair.json", "points.csv", "-o", "", says="empty")
        self.refuse(WRONG_USAGE, "check", "", says="empty")
        self.path("mesh.dxf").write_text("0\nSECTION\n")
        self.refuse(WRONG_USAGE, "check", "mesh.dxf", "mesh.dxf", says=("mesh.dxf", ".off"))
        self.refuse(WRONG_USAGE, "check", "mesh.dxf", says=("mesh.dxf", ".json"))
        self.refuse(WRONG_USAGE, "map", "pair.json", "mesh.dxf", "-o", "new.vtp", says=("mesh.dxf", ".csv"))
        self.refuse(WRONG_USAGE, "check", "pair.json", "pair.json", says="alone")

    def test_quiet(self):
        write_csv(self.path("outside.csv"), [[5, 5]])
        for flag in ("-q", "--quiet"):
            self.assertEqual(
                self.run_dhm(flag, "map", "pair.json", "outside.csv", "-o", "x.csv", "-f").err, "")
            self.assertEqual(
                self.run_dhm("refine", "pair.json", flag, "--within", "1", "-o", "x.json", "-f").err, "")
        # Errors are said.
        self.refuse(FILE_TROUBLE, "-q", "check", "none.json", says="none.json")


class InputFiles(ProgramTest):
    def setUp(self):
        super().setUp()
        self.pair = make_pair(4, 4)
        write_json(self.path("pair.json"), self.pair)
        write_csv(self.path("points.csv"), inside_points(self.pair, 30))

    def test_missing_files_and_folders(self):
        commands = (["check", "{}"], ["check", "pair.json", "{}"], ["map", "pair.json", "{}", "-o", "new.csv"],
                    ["map", "{}", "points.csv", "-o", "new.csv"],
                    ["warp", "pair.json", "{}", "-o", "new.png"],
                    ["morph", "pair.json", "--source-image", "{}", "-o", "new%d.png"],
                    ["figure", "pair.json", "--image", "{}", "-o", "new.png"],
                    ["coordinates", "{}", "points.csv", "-o", "new.csv"],
                    ["refine", "{}", "--within", "1", "-o", "new.json"],
                    ["convert", "{}", "-o", "new.json"], ["convert", "{}", "{}", "-o", "new.json"])
        self.path("folder.off").mkdir()
        for command in commands:
            self.refuse(FILE_TROUBLE, *(word.format("none.off") for word in command),
                        says=("none.off", "No such file"))
            self.refuse(FILE_TROUBLE, *(word.format("folder.off") for word in command),
                        says=("folder.off", "is a folder"))

    @unittest.skipIf(os.geteuid() == 0, "root may read everything")
    def test_no_permission(self):
        self.path("pair.json").chmod(0)
        self.refuse(FILE_TROUBLE, "check", "pair.json", says=("pair.json", "Permission denied"))

    def damage(self, data, text):
        """The file cut off at several places, and otherwise garbled."""
        for share in (0.0, 0.02, 0.3, 0.6, 0.8, 0.95):
            yield f"cut at {share}", data[:int(share * len(data))]
        yield "noise", numpy.random.default_rng(8).bytes(700)
        if text:
            middle = len(data) // 2
            yield "garbled", data[:middle] + b" \xff\x1b[31m?? " + data[middle + 8:]

    def test_damaged_meshes(self):
        source, target, triangles = self.pair
        text = {"obj": write_obj, "off": write_off, "ply": write_ply, "vtu": write_vtu,
                "stl": lambda path, p, t: write_stl(path, p, t, False), "vtk": write_vtk}
        binary = {"ply": lambda path, p, t: write_ply(path, p, t, "binary_little_endian"),
                  "stl": lambda path, p, t: write_stl(path, p, t, True)}
        for writers in (text, binary):
            for extension, write in writers.items():
                write(self.path(f"source.{extension}"), source, triangles)
                write(self.path(f"target.{extension}"), target, triangles)
                self.run_dhm("check", "--quick", f"source.{extension}", f"target.{extension}")
                for how, data in self.damage(self.path(f"source.{extension}").read_bytes(), writers is text):
                    name = f"damaged.{extension}"
                    self.path(name).write_bytes(data)
                    with self.subTest(extension=extension, how=how, text=writers is text):
                        command = ["check", "--quick", name, f"target.{extension}"]
                        if extension == "obj" and how in ("cut at 0.3", "cut at 0.6"):
                            # Whole lines of it are one, too: but without faces, or not the target's.
                            status = self.run_dhm(*command, status={REFUSED, FILE_TROUBLE}).status
                            self.assertEqual(status, FILE_TROUBLE if how == "cut at 0.3" else status)
                            continue
                        says = [name]
                        if writers is text and extension not in ("vtk", "vtu") and \
                                how not in ("noise", "cut at 0.0") and extension != "obj":
                            says.append("line")
                        self.refuse(FILE_TROUBLE, *command, says=says)

    def test_damaged_pairs(self):
        self.run_dhm("convert", "pair.json", "-o", "pair.vtp")
        self.run_dhm("convert", "pair.json", "-o", "pair.vtk")
        for extension in ("json", "vtp", "vtk"):
            text = extension != "vtk"
            for how, data in self.damage(self.path(f"pair.{extension}").read_bytes(), text):
                name = f"damaged.{extension}"
                self.path(name).write_bytes(data)
                with self.subTest(extension=extension, how=how):
                    says = [name] + (["line"] if extension == "json" else [])
                    self.refuse(FILE_TROUBLE, "check", "--quick", name, says=says)

    def test_wrong_triangulation_files(self):
        good = json.loads(self.path("pair.json").read_text())
        def refuse(says, **changes):
            document = {key: value for key, value in {**good, **changes}.items() if value is not None}
            self.path("bad.json").write_text(json.dumps(document))
            self.refuse(FILE_TROUBLE, "check", "bad.json", says=["bad.json", *says])
        refuse(["file_type"], file_type="GeoJSON")
        refuse(["file_type"], file_type=None)
        refuse(["format_version"], format_version="2.0")
        refuse(["transformed_components"], transformed_components=["vertical"])
        refuse(["vertices"], vertices=None)
        refuse(["vertices"], vertices={"a": 1})
        refuse(["target_y"], vertices_columns=COLUMNS[:3] + ["z"])
        refuse(["vertices[3]"], vertices=good["vertices"][:3] + [[1, 2, 3]] + good["vertices"][4:])
        refuse(["vertices[0]", "source_x"], vertices=[["1", 2, 3, 4]] + good["vertices"][1:])
        for index in (-1, 25, 1.5, "1", None, 2 ** 63, 1e300):
            refuse(["triangles[1]", "vertex"], triangles=good["triangles"][:1] + [[0, 1, index]])
        for text in ("[]", "null", "3", '"x"', "{}"):
            self.path("bad.json").write_text(text)
            self.refuse(FILE_TROUBLE, "check", "bad.json", says="bad.json")

    def test_damaged_tables(self):
        for text, says in (("", "no points"), ("\n\n# nothing\n", "no points"),
                           ("x,y\n1,2\n3\n", "line 3"), ("x,y\n1,2\n3,b\n", "line 3"),
                           ('x,y\n1,"2\n', "line 2"), ("x,y\n0.1,0.2\n0.3,\n", "line 3"),
                           ("x\n1\n", "two coordinates"), ("x,y\n1,2,3\n", "line 2"),
                           ("x,y\n1,1e999\n", "line 2"), ("x,y\n0x1,2\n", "line 2")):
            self.path("bad.csv").write_text(text)
            self.refuse(FILE_TROUBLE, "map", "pair.json", "bad.csv", "-o", "new.csv", says=("bad.csv", says))
        self.path("bad.csv").write_bytes(numpy.random.default_rng(9).bytes(3000))
        self.refuse(FILE_TROUBLE, "map", "pair.json", "bad.csv", "-o", "new.csv", says="bad.csv")

    def test_damaged_xmorph_meshes(self):
        points, _ = make_grid(4, 4, 100, 100)
        write_mesh(self.path("good.mesh"), 5, points)
        for how, data in self.damage(self.path("good.mesh").read_bytes(), True):
            self.path("bad.mesh").write_bytes(data)
            with self.subTest(how=how):
                self.refuse(FILE_TROUBLE, "check", "--quick", "bad.mesh", "good.mesh",
                            says=("bad.mesh", "line"))

    def test_damaged_pictures(self):
        random = numpy.random.default_rng(10)
        write_json(self.path("pair.json"), make_pair(3, 3, width=29, height=19))
        write_pnm(self.path("good.ppm"), random.integers(0, 256, (20, 30, 3)))
        for extension in ("png", "jpg", "tif", "vti"):
            self.run_dhm("warp", "pair.json", "good.ppm", "-o", f"good.{extension}")
        self.path("good2.ppm").write_text("P3 30 20 255\n" + " ".join(["120"] * 1800))
        # One whose directory comes first, unlike those that VTK writes.
        entries = [(256, 30), (257, 20), (258, 8), (259, 1), (262, 1), (273, 134), (277, 1), (278, 20),
                   (279, 600)]
        self.path("good2.tif").write_bytes(
            b"II*\0\x08\0\0\0" + struct.pack("<H", len(entries)) + b"".join(
                struct.pack("<HHII", tag, 4, 1, value) for tag, value in entries) + bytes(16) +
            random.bytes(600))
        for name in ("good.png", "good.jpg", "good.tif", "good.vti", "good.ppm", "good2.ppm", "good2.tif"):
            self.run_dhm("warp", "pair.json", name, "-f", "-o", "out.png")
            for how, data in self.damage(self.path(name).read_bytes(), name == "good.png"):
                bad = f"bad.{name[-3:]}"
                self.path(bad).write_bytes(data)
                with self.subTest(name=name, how=how):
                    self.refuse(FILE_TROUBLE, "warp", "pair.json", bad, "-o", "new.png", says=bad)
                    if name == "good.png":
                        self.refuse(FILE_TROUBLE, "figure", "pair.json", "--image", bad, "-o", "new.png",
                                    says=bad)
        # Larger than any memory, by what they say.
        for header in (b"P6 1000000 1000000 255\n", b"P5 99999999999999999999 2 255\n", b"P6 0 5 255\n",
                       b"P6 5 5 0\n", b"P6 5 5 70000\n", b"P4 5 5\n"):
            self.path("bad.ppm").write_bytes(header + bytes(100))
            self.refuse(FILE_TROUBLE, "warp", "pair.json", "bad.ppm", "-o", "new.png", says="bad.ppm")
        png = bytearray(self.path("good.png").read_bytes())
        png[16:24] = struct.pack(">2I", 500000, 500000)
        png[29:33] = struct.pack(">I", zlib.crc32(png[12:29]))
        self.path("bad.png").write_bytes(png)
        self.refuse(FILE_TROUBLE, "warp", "pair.json", "bad.png", "-o", "new.png", says="bad.png")
        # Another kind of picture than the name says.
        shutil.copy(self.path("good.jpg"), self.path("jpeg.png"))
        self.refuse(FILE_TROUBLE, "warp", "pair.json", "jpeg.png", "-o", "new.png", says="jpeg.png")

    def test_damaged_data(self):
        write_vtk(self.path("data.vtk"), inside_points(self.pair, 60), numpy.array([[0, 1, 2]]))
        self.run_dhm("map", "pair.json", "data.vtk", "-o", "good.vtk")
        self.run_dhm("map", "pair.json", "data.vtk", "-o", "good.vtp")
        for extension in ("vtk", "vtp"):
            for how, data in self.damage(self.path(f"good.{extension}").read_bytes(), extension == "vtp"):
                self.path(f"bad.{extension}").write_bytes(data)
                with self.subTest(extension=extension, how=how):
                    self.refuse(FILE_TROUBLE, "map", "pair.json", f"bad.{extension}", "-o", "new.vtp",
                                says=f"bad.{extension}")

    def test_cells_that_begin_elsewhere(self):
        """VTK's files of today say where each cell's points begin."""
        write_vtk(self.path("plain.vtk"), self.pair.source, self.pair.triangles, target=self.pair.target)
        text = self.path("plain.vtk").read_text().replace("Version 3.0", "Version 5.1")
        count = len(self.pair.triangles)
        corners = " ".join(map(str, self.pair.triangles.ravel().tolist()))
        head, tail = text[:text.index("POLYGONS")], text[text.index("POINT_DATA"):]
        def write(offsets):
            self.path("mesh.vtk").write_text(
                f"{head}POLYGONS {count + 1} {3 * count}\nOFFSETS vtktypeint64\n"
                f"{' '.join(map(str, offsets))}\nCONNECTIVITY vtktypeint64\n{corners}\n{tail}")
        good = list(range(0, 3 * count + 1, 3))
        write(good)
        check = ["check", "--quick", "--target-array", "Moved", "mesh.vtk"]
        self.run_dhm(*check)
        for place, value in ((5, 10 ** 12), (5, -10 ** 12), (count, 10 ** 9), (0, -10 ** 9), (count, 3)):
            write(good[:place] + [value] + good[place + 1:])
            self.refuse(FILE_TROUBLE, *check, says="mesh.vtk")
            self.refuse(FILE_TROUBLE, "map", "pair.json", "mesh.vtk", "-o", "new.vtp", says="mesh.vtk")

    def test_standard_input(self):
        pair = self.path("pair.json").read_bytes()
        points = self.path("points.csv").read_bytes()
        expected = self.run_dhm("map", "pair.json", "points.csv", "-o", "-").out
        self.assertEqual(self.run_dhm("map", "-", "points.csv", "-o", "-", input=pair).out, expected)
        self.assertEqual(self.run_dhm("map", "pair.json", "-", "-o", "-", input=points).out, expected)
        self.run_dhm("convert", "-", "-o", "source.off", "--target-output", "target.off", input=pair)
        off = self.path("target.off").read_bytes()
        out = self.run_dhm("map", "source.off", "-", "points.csv", "--input-format", "off", "-o", "-",
                           input=off).out
        self.assertEqual(out, expected)
        out = self.run_dhm("map", "pair.json", "-", "-o", "-", "--output-format", "vtp", input=points).out
        self.assertIn(b"<VTKFile", out)
        out = self.run_dhm("coordinates", "-", "points.csv", "--input-format", "mesh", "-o", "-",
                           input=b"M2\n2 2\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n").out
        self.assertIn(b"EdgeLabel", out)
        # Of another kind than expected.
        self.refuse(FILE_TROUBLE, "check", "-", input=off, says=("standard input", ".json", "--input-format"))
        self.refuse(FILE_TROUBLE, "map", "source.off", "-", "points.csv", "-o", "new.csv", "--input-format",
                    "ply", input=off, says=("standard input", ".ply", "--input-format"))
        self.refuse(FILE_TROUBLE, "map", "pair.json", "-", "-o", "new.csv", input=off,
                    says=("standard input", ".csv", "--data-format"))
        self.refuse(FILE_TROUBLE, "warp", "pair.json", "-", "-o", "new.png", input=off,
                    says=("standard input", ".png", "--image-format"))
        # Damaged and missing.
        self.refuse(FILE_TROUBLE, "check", "-", input=pair[:500], says=("standard input", "line"))
        self.refuse(FILE_TROUBLE, "check", "-", says="standard input")
        self.refuse(FILE_TROUBLE, "map", "pair.json", "-", "-o", "new.csv", says="standard input")
        self.refuse(WRONG_USAGE, "map", "-", "-", "-o", "new.csv", says="standard input")
        image = b"P5 2 2 255\n\0\1\2\3"
        out = self.run_dhm("warp", "pair.json", "-", "--image-format", "ppm", "-o", "-", "--output-format",
                           "ppm", input=image).out
        self.assertTrue(out.startswith(b"P5\n2 2\n255\n"))


class OutputFiles(ProgramTest):
    def setUp(self):
        super().setUp()
        self.pair = make_pair(6, 6, width=39, height=29)
        write_json(self.path("pair.json"), self.pair)
        write_csv(self.path("points.csv"), inside_points(self.pair, 300))
        write_vtk(self.path("data.vtk"), inside_points(self.pair, 300), numpy.array([[0, 1, 2]]))
        random = numpy.random.default_rng(11)
        write_pnm(self.path("image.ppm"), random.integers(0, 256, (30, 40, 3)))
        self.commands = [["map", "pair.json", "points.csv", "-o", "out.csv"]]
        self.commands += [["map", "pair.json", "data.vtk", "-o", f"out.{e}"] for e in ("vtp", "vtk")]
        self.commands += [["map", "pair.json", "image.ppm", "-o", f"out.{e}"] for e in ("vts", "vtk")]
        self.commands += [["warp", "pair.json", "image.ppm", "-o", f"out.{e}"]
                          for e in ("png", "jpg", "tif", "ppm", "vti")]
        self.commands += [["coordinates", "pair.json", "points.csv", "-o", "out.csv"]]
        self.commands += [["figure", "pair.json", "--grid", "3", "-o", f"out.{e}"] for e in ("png", "svg", "pdf")]
        self.commands += [["check", "--quick", "pair.json", "--picture", "out.png"]]
        self.commands += [["refine", "pair.json", "--within", "0.5", "-o", f"out.{e}"]
                          for e in ("json", "vtp", "vtk")]
        self.commands += [["convert", "pair.json", "-o", f"out.{e}"] for e in ("json", "vtp", "vtk")]
        self.commands += [["convert", "pair.json", "--target-output", f"target.{e}", "-o", f"out.{e}"]
                          for e in ("obj", "off", "vtp")]

    def test_full_disk(self):
        """A file that does not grow to its size, even for want of its last bytes, is not there at all."""
        for command in self.commands:
            self.run_dhm(*command)
            output = self.path(command[-1])
            size = output.stat().st_size
            for path in self.folder.glob("target.*"):
                path.unlink()
            output.unlink()
            for limit in (size // 2, size - 1):
                with self.subTest(command=command, limit=limit):
                    self.refuse(FILE_TROUBLE, *command, limit=limit, says=("Cannot write", ))
        morph = ["morph", "pair.json", "-n", "2", "-o", "out%d.vtp"]
        self.refuse(FILE_TROUBLE, *morph, limit=2000, says="out0.vtp")

    def test_full_device(self):
        with open("/dev/full", "wb") as full:
            for command in self.commands:
                if command[0] == "check":
                    continue
                format_ = command[-1].split(".")[1]
                if "--target-output" in command:
                    continue
                with self.subTest(command=command):
                    self.refuse(FILE_TROUBLE, *command[:-1], "-", "--output-format", format_, stdout=full,
                                says=("standard output", "No space left"))
            for command in (["check", "--quick", "pair.json"], ["check", "--quick", "--json", "pair.json"],
                            ["--help"], ["map", "--help"], ["--version"], ["--manual-page"]):
                self.refuse(FILE_TROUBLE, *command, stdout=full, says="standard output")
        self.refuse(FILE_TROUBLE, "map", "pair.json", "points.csv", "-o", "/dev/full",
                    says=("/dev/full", "No space left"))
        self.assertTrue(pathlib.Path("/dev/full").is_char_device())
        self.refuse(FILE_TROUBLE, "check", "-", limit=100, input=self.path("pair.json").read_bytes(),
                    says="standard input")

    def test_a_reader_that_has_gone(self):
        reading, writing = os.pipe()
        os.close(reading)
        with os.fdopen(writing, "wb") as gone:
            self.refuse(FILE_TROUBLE, "map", "pair.json", "points.csv", "-o", "-", stdout=gone,
                        says="standard output")

    def test_nothing_is_overwritten(self):
        for command in self.commands:
            output = self.path(command[-1])
            output.write_text("mine")
            self.refuse(FILE_TROUBLE, *command, says=(output.name, "exists", "--force"))
            self.assertEqual(output.read_text(), "mine")
            output.unlink()
        self.path("target.obj").write_text("mine")
        self.refuse(FILE_TROUBLE, "convert", "pair.json", "-o", "out.obj", "--target-output", "target.obj",
                    says=("target.obj", "--force"))
        for command in (self.commands[0], self.commands[-6]):
            self.path(command[-1]).write_text("mine")
            self.run_dhm(*command, "--force")
            self.assertNotEqual(self.path(command[-1]).read_text(), "mine")
        # With --force, what is there is replaced only by what is whole.
        self.path("out.csv").write_text("mine")
        self.refuse(FILE_TROUBLE, *self.commands[0], "--force", limit=100)
        self.refuse(FILE_TROUBLE, "map", "pair.json", "none.csv", "-o", "out.csv", "--force", says="none.csv")
        self.assertEqual(self.path("out.csv").read_text(), "mine")

    def test_a_file_may_replace_its_own_input(self):
        self.run_dhm("convert", "pair.json", "-o", "pair.json", "--force")
        self.assert_near(read_json(self.path("pair.json"))[0].target, self.pair.target, 0)

    def test_folders(self):
        self.path("folder.csv").mkdir()
        command = ["map", "pair.json", "points.csv", "-o"]
        self.refuse(FILE_TROUBLE, *command, "folder.csv", says=("folder.csv", "is a folder"))
        self.refuse(FILE_TROUBLE, *command, "nowhere/out.csv", says=("nowhere/out.csv", "No such file"))
        self.refuse(FILE_TROUBLE, *command, "points.csv/out.csv", says=("points.csv/out.csv", ))
        self.run_dhm(*command, "folder.csv/out.csv")
        self.assertTrue(self.path("folder.csv/out.csv").is_file())
        self.refuse(FILE_TROUBLE, *command, "/proc/out.csv", says="/proc/out.csv")
        if os.geteuid() != 0:
            self.path("folder.csv").chmod(0o555)
            self.refuse(FILE_TROUBLE, *command, "folder.csv/new.csv", says="Permission denied")

    def test_permissions_and_pipes(self):
        self.run_dhm(*self.commands[0])
        self.path("usual").touch()
        self.assertEqual(self.path("out.csv").stat().st_mode, self.path("usual").stat().st_mode)
        os.mkfifo(self.path("pipe.csv"))
        reader = subprocess.Popen(["cat", "pipe.csv"], cwd=self.folder, stdout=subprocess.PIPE)
        self.run_dhm("map", "pair.json", "points.csv", "-o", "pipe.csv")
        self.assertEqual(reader.communicate(timeout=10)[0], self.path("out.csv").read_bytes())
        out = self.run_dhm("map", "pair.json", "points.csv", "-o", "/dev/stdout").out
        self.assertEqual(out, self.path("out.csv").read_bytes())


class Processes(ProgramTest):
    def setUp(self):
        super().setUp()
        write_json(self.path("pair.json"), make_pair(6, 6))

    def start(self, *arguments, **options):
        return subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, env=self.environment,
                                stdout=subprocess.DEVNULL, **options)

    def wait_for(self, what, seconds=20):
        end = time.monotonic() + seconds
        while not what():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)

    def test_interrupts_leave_nothing(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            process = self.start("refine", "pair.json", "--within", "1e-9", "-o", "fine.json",
                                 stderr=subprocess.DEVNULL)
            self.wait_for(lambda: list(self.folder.glob(".*unfinished*")))
            time.sleep(0.1)
            self.assertIsNone(process.poll())
            process.send_signal(number)
            self.assertEqual(process.wait(10), -number)
            self.assert_tidy(number)
            self.assertFalse(self.path("fine.json").exists())

    def test_interrupts_while_reading(self):
        process = self.start("check", "-", stdin=subprocess.PIPE, stderr=subprocess.DEVNULL)
        process.stdin.write(b"{")
        process.stdin.flush()
        self.wait_for(lambda: list(self.temporary.iterdir()))
        process.terminate()
        self.assertEqual(process.wait(10), -signal.SIGTERM)
        process.stdin.close()
        self.assert_tidy("standard input")

    def run_on_terminal(self, *arguments):
        """What a terminal on standard error sees."""
        master, slave = pty.openpty()
        process = self.start(*arguments, stderr=slave)
        os.close(slave)
        seen = b""
        while True:
            if select.select([master], [], [], 60)[0]:
                try:
                    seen += os.read(master, 4096)
                    continue
                except OSError:
                    pass
            break
        os.close(master)
        self.assertEqual(process.wait(60), YES)
        return seen.decode()

    def test_progress_bars(self):
        write_vtk(self.path("data.vtk"), inside_points(make_pair(6, 6), 20000), numpy.array([[0, 1, 2]]))
        command = ["map", "pair.json", "data.vtk", "-f", "-o", "out.vtp"]
        seen = self.run_on_terminal(*command)
        self.assertIn("Mapping [", seen)
        self.assertIn("100 %", seen)
        self.assertTrue(seen.endswith("\r\x1b[K"))
        self.assertEqual(self.run_on_terminal(*command, "--quiet"), "")
        self.assertEqual(self.run_dhm(*command).err, "")
        seen = self.run_on_terminal("refine", "pair.json", "--within", "0.01", "-o", "fine.json")
        self.assertIn("Refining [", seen)
        # Nothing but the bar and the remark: no leftovers of bars that are gone.
        self.assertRegex(seen, r"^(\rRefining \[[#.]{30}\] \d+ %)+\r\x1b\[Kdhm: \d+ triangles became")
        write_pnm(self.path("image.pgm"), numpy.zeros((2, 2)))
        self.assertIn("Morphing [", self.run_on_terminal("morph", "pair.json", "--source-image", "image.pgm",
                                                         "-o", "frame%d.png"))

    def test_locale_does_not_matter(self):
        self.environment["LC_ALL"] = "de_DE.UTF-8"
        write_csv(self.path("points.csv"), [[0.5, 0.25]])
        out = self.run_dhm("map", "pair.json", "points.csv", "-o", "-").out.decode()
        self.assertRegex(out, r"\n0\.\d+,0\.\d+,1\n$")


# --- Real data


@unittest.skipUnless(FINLAND.is_file(), f"{FINLAND} is not there")
class Finland(ProgramTest):
    """The published shift from Finland's old grid to its new one."""

    @classmethod
    def setUpClass(cls):
        document = json.loads(FINLAND.read_text())
        columns = [document["vertices_columns"].index(name) for name in COLUMNS]
        vertices = numpy.array([[vertex[k] for k in columns] for vertex in document["vertices"]])
        corners = [document["triangles_columns"].index(f"idx_vertex{k}") for k in (1, 2, 3)]
        triangles = numpy.array([[triangle[k] for k in corners] for triangle in document["triangles"]])
        cls.pair = Pair(vertices[:, :2], vertices[:, 2:], triangles)
        cls.points = inside_points(cls.pair, 100000)

    def run_cct(self, triangulation, points):
        lines = "".join(f"{x!r} {y!r} 0 0\n" for x, y in points.tolist())
        ran = subprocess.run(["cct", "-d", "9", "+proj=tinshift", f"+file={triangulation}"],
                             input=lines.encode(), stdout=subprocess.PIPE, cwd=self.folder, check=True)
        return numpy.array([line.split()[:2] for line in ran.stdout.decode().splitlines()], float)

    def test_check(self):
        report = json.loads(self.run_dhm("check", "--json", FINLAND).out)
        self.assertTrue(report["valid"])
        self.assertEqual((report["source"]["points"], report["source"]["triangles"]), (767, 1450))
        areas = doubled_areas(self.pair.source, self.pair.triangles)
        self.assertEqual(report["mended_windings"], 148)
        self.assertEqual(report["mended_windings"], min((areas > 0).sum(), (areas < 0).sum()))
        self.assertEqual(report["systems"]["Smooth"]["not_positive"], 0)
        self.assertEqual(report["systems"]["Smooth"]["creases"], 0)
        edges = edges_of(self.pair.triangles)
        self.assertEqual(report["boundary_edges"], sum(count == 1 for count in edges.values()))
        self.assertEqual(report["interior_edges"], sum(count == 2 for count in edges.values()))
        self.assertEqual(report["components"], 1)
        # Euler: points - edges + triangles = 2 components - loops, of a planar mesh.
        euler = 767 - len(edges) + 1450
        self.assertEqual(report["boundary_loops"], 2 - euler)

    def test_smooth_and_linear(self):
        ends = numpy.array(list(edges_of(self.pair.triangles)))
        t = numpy.random.default_rng(12).random((len(ends), 1))
        on_edges = (1 - t) * self.pair.source[ends[:, 0]] + t * self.pair.source[ends[:, 1]]
        boundary = numpy.vstack((self.pair.source, on_edges))
        expected = numpy.vstack((self.pair.target, (1 - t) * self.pair.target[ends[:, 0]] +
                                 t * self.pair.target[ends[:, 1]]))
        for system in ("linear", "smooth"):
            table = self.map_points([FINLAND], boundary, "-s", system, "--tolerance", "1e-12")
            self.assert_near(places(table), expected, 1e-6)
        smooth, linear = (places(self.map_points([FINLAND], self.points, "-s", system))
                          for system in ("smooth", "linear"))
        farthest = numpy.linalg.norm(smooth - linear, axis=1).max()
        report = json.loads(self.run_dhm("check", "--json", FINLAND).out)
        said = report["systems"]["Smooth"]["largest_distance_from_linear"]["value"]
        self.assertGreater(farthest, 0.01)
        self.assertAlmostEqual(said, farthest, delta=0.3 * farthest)

    @unittest.skipUnless(shutil.which("cct"), "PROJ's cct (proj-bin) is not there")
    def test_as_proj_does(self):
        linear = places(self.map_points([FINLAND], self.points, "-s", "linear"))
        self.assert_near(self.run_cct(FINLAND, self.points), linear, 1e-6)
        self.run_dhm("refine", FINLAND, "--within", "0.01", "-o", "fine.json")
        smooth = places(self.map_points([FINLAND], self.points))
        distances = numpy.linalg.norm(self.run_cct("./fine.json", self.points) - smooth, axis=1)
        self.assertLessEqual(distances.max(), 0.01)
        fine, _ = read_json(self.path("fine.json"))
        self.assert_near(fine.source[:767], self.pair.source, 0)
        self.assert_near(fine.target[:767], self.pair.target, 0)
        self.assertLessEqual(max(edges_of(fine.triangles).values()), 2)


@unittest.skipUnless(XMORPH.is_dir(), f"{XMORPH} (Debian's gtkmorph-example) is not there")
class Xmorph(ProgramTest):
    def test_photographs(self):
        # The working picture's size as the session's file says it, where the mesh does not reach its ends.
        size = ("--working-size", "300x400")
        for name, options in (("AD", ()), ("AD2", size), ("AD_freeborder", size)):
            folder = XMORPH / name
            meshes = [folder / f"image{k}.png.mesh" for k in (1, 2)]
            images = [folder / f"image{k}.png" for k in (1, 2)]
            with self.subTest(name=name):
                report = json.loads(self.run_dhm("check", "--json", "--quick", *options, *meshes).out)
                self.assertTrue(report["valid"])
                header = meshes[0].read_text().split()
                columns, rows_ = int(header[1]), int(header[2])
                self.assertEqual(report["source"]["points"], columns * rows_)
                self.assertEqual(report["source"]["triangles"], 2 * (columns - 1) * (rows_ - 1))
                sizes = [png_size(image.read_bytes()) for image in images]
                self.run_dhm("warp", *options, *meshes, images[0], "-o", f"{name}.png")
                self.assertEqual(png_size(self.path(f"{name}.png").read_bytes()), sizes[0])
                self.run_dhm("morph", *options, *meshes, "--source-image", images[0], "--target-image",
                             images[1], "--frames", "10", "--size", "60x80", "-o", f"{name}-%02d.png")
                frames = sorted(self.folder.glob(f"{name}-*.png"))
                self.assertEqual([frame.name for frame in frames],
                                 [f"{name}-{k:02d}.png" for k in range(10)])
                for frame in frames:
                    self.assertEqual(png_size(frame.read_bytes()), (60, 80))


if __name__ == "__main__":
    unittest.main()
