# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm map and dhm coordinates: comparison with numpy, and reading and writing of tables."""

import csv
import io

import numpy
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkMultiBlockDataSet
from vtkmodules.vtkIOLegacy import vtkGenericDataObjectReader
from vtkmodules.vtkIOXML import vtkXMLMultiBlockDataReader, vtkXMLMultiBlockDataWriter, vtkXMLPolyDataReader
from vtkhomeomorphism.arrays import make_mesh
from conftest import FILE, REFUSED, USAGE
from pairs import MASK, Pair, barycentric, inside_points, interpolate, make_pair, map_points, read_csv, write_csv, \
    write_json, write_mesh, write_vtk, xy


@pytest.fixture
def pair(dhm):
    result = make_pair()
    write_mesh(dhm.path("a.off"), result.source, result.triangles)
    write_mesh(dhm.path("b.off"), result.target, result.triangles)
    write_json(dhm.path("pair.json"), result)
    return result


MESHES = ["a.off", "b.off"]


def test_linear_interpolates_and_is_what_triangulation_files_mean(dhm, pair):
    points = inside_points(pair, 300)
    expected = interpolate(points, pair)
    for files, options in ((MESHES, ["-s", "linear"]), (["pair.json"], [])):
        numpy.testing.assert_allclose(xy(map_points(dhm, files, points, *options)), expected, rtol=0, atol=1e-14)


def test_smooth_is_the_default_of_meshes_and_differs_within_triangles_only(dhm, pair):
    ends = pair.triangles[:, :2]
    t = numpy.random.default_rng(3).random((len(ends), 1))
    on_edges, expected = ((1 - t) * p[ends[:, 0]] + t * p[ends[:, 1]] for p in pair[:2])
    for system in ("Linear", "contour", "SMOOTH"):
        options = ("--system", system, "--linear-where-discordant")
        numpy.testing.assert_allclose(xy(map_points(dhm, MESHES, on_edges, *options)), expected, rtol=0, atol=1e-12)
        numpy.testing.assert_array_equal(xy(map_points(dhm, MESHES, pair.source, *options)), pair.target)
    points = inside_points(pair, 100)
    smooth = xy(map_points(dhm, MESHES, points))
    assert numpy.abs(smooth - interpolate(points, pair)).max() > 1e-3
    numpy.testing.assert_array_equal(xy(map_points(dhm, ["pair.json"], points, "-s", "smooth")), smooth)


def test_other_systems_tell_how_far_they_are_from_the_official_meaning(dhm, pair):
    write_json(dhm.path("degrees.json"), Pair(pair.source, pair.target + [25, 60], pair.triangles),
               output_crs="EPSG:4258")
    points = inside_points(pair, 200)
    for name, scale in (("pair.json", [1, 1]), ("degrees.json", [numpy.cos(numpy.radians(60.5)), 1])):
        write_csv(dhm.path("p.csv"), points)
        result = dhm("map", name, "p.csv", "-s", "smooth", "-o", "-")
        distance = numpy.hypot(*((xy(read_csv(result.out)) - xy(map_points(dhm, [name], points))) * scale).T).max()
        said = float(result.err.split("point ")[1].split(":")[1].split()[0])
        meters = name == "degrees.json"
        assert said == pytest.approx(distance * (111195 if meters else 1), rel=0.02)
        assert ("meters" in result.err) == meters


def test_the_inverse_returns(dhm, pair):
    points = inside_points(pair, 200)
    for system in ("linear", "contour", "smooth"):
        options = ("--system", system, "--linear-where-discordant")
        images = xy(map_points(dhm, MESHES, points, *options))
        assert numpy.abs(images - points).max() > 0.01
        back = xy(map_points(dhm, MESHES, images, "--inverse", *options))
        numpy.testing.assert_allclose(back, points, rtol=0, atol=1e-13)


def test_jacobian_determinant_and_triangle(dhm, pair):
    points = inside_points(pair, 200)
    found, weights = barycentric(points, pair.source, pair.triangles)
    points, found = points[weights.min(axis=1) > 1e-4], found[weights.min(axis=1) > 1e-4]
    table = map_points(dhm, MESHES, points, "--jacobian", "--determinant", "--triangle-id")
    assert (table["TriangleId"] == found).all()
    jacobian = numpy.stack([table[f"Jacobian_{k}"] for k in range(9)], axis=1).reshape(-1, 3, 3)[:, :2, :2]
    for axis in range(2):
        step = 1e-6 * numpy.eye(2)[axis]
        ahead, behind = (xy(map_points(dhm, MESHES, points + s)) for s in (step, -step))
        numpy.testing.assert_allclose(jacobian[:, :, axis], (ahead - behind) / 2e-6, atol=1e-5)
    numpy.testing.assert_allclose(table["JacobianDeterminant"], numpy.linalg.det(jacobian), atol=1e-12)


def test_images_on_surfaces_have_a_third_coordinate(dhm, pair):
    surface = numpy.column_stack((pair.target, 0.2 * numpy.sin(3 * pair.target[:, 0])))
    write_mesh(dhm.path("surface.off"), surface, pair.triangles)
    points = inside_points(pair, 50)
    table = map_points(dhm, ["a.off", "surface.off"], points, "-s", "linear")
    expected = interpolate(points, pair._replace(target=surface))
    numpy.testing.assert_allclose(numpy.column_stack((xy(table), table["z"])), expected, rtol=0, atol=1e-14)
    write_csv(dhm.path("p.csv"), points)
    assert "no z" in dhm("map", "-i", "a.off", "surface.off", "p.csv", "-o", "-").err


def test_points_outside_are_marked_and_never_invented(dhm, pair):
    write_csv(dhm.path("p.csv"), [[0.5, 0.5], [1.5, 0.5], [numpy.nan, 0.2]])
    result = dhm("map", *MESHES, "p.csv", "-o", "-")
    assert "2 points are outside" in result.err
    table = read_csv(result.out)
    assert table[MASK].tolist() == [1, 0, 0]
    assert numpy.isnan(xy(table)).all(axis=1).tolist() == [False, True, True]
    dhm.refuse(REFUSED, "map", "--require-inside", *MESHES, "p.csv", "-o", "new.csv", says="2 points are outside")
    assert dhm("map", "-q", *MESHES, "p.csv", "-o", "-").err == ""
    near = map_points(dhm, MESHES, [[0.5, -1e-6]], "--tolerance", "1e-5")
    assert near[MASK] == 1 and abs(near["y"][0]) < 1e-5


def test_coordinates_leave_points_where_they_are(dhm, pair):
    write_csv(dhm.path("p.csv"), [[0.5, 0.51], [1.5, 0.5]])
    table = read_csv(dhm("coordinates", "a.off", "p.csv", "-o", "-").out)
    assert xy(table).tolist() == [[0.5, 0.51], [1.5, 0.5]] and table[MASK].tolist() == [1, 0]
    assert 0 <= table["ContourParameter"][0] <= 1 and table["EdgeLabel"][0] in (1, 2, 3)


def test_heights_as_proj_maps_them(dhm, pair):
    """Interpolated linearly at the place in the source, in the file's columns, forward and back."""
    points = inside_points(pair, 100)
    found, weights = barycentric(points, pair.source, pair.triangles)
    offsets = numpy.random.default_rng(4).random(len(pair.source))
    change = (weights * offsets[pair.triangles[found]]).sum(axis=1)
    vertices = numpy.hstack((pair.source, pair.target, offsets[:, None]))
    both = {"transformed_components": ["horizontal", "vertical"]}
    columns = ["source_x", "source_y", "target_x", "target_y"]
    write_json(dhm.path("h.json"), pair, **both, vertices_columns=columns + ["offset_z"], vertices=vertices.tolist())
    vertices = numpy.hstack((vertices[:, :4], numpy.full((len(offsets), 1), 7.0), 7 + offsets[:, None]))
    write_json(dhm.path("z.json"), pair, **both, vertices_columns=columns + ["source_z", "target_z"],
               vertices=vertices.tolist())
    write_json(dhm.path("v.json"), pair, transformed_components=["vertical"],
               vertices_columns=["source_x", "source_y", "offset_z"],
               vertices=numpy.hstack((pair.source, offsets[:, None])).tolist())
    given = numpy.column_stack((points, numpy.full(len(points), 50.0)))
    for name in ("h.json", "z.json", "v.json"):
        table = map_points(dhm, [name], given)
        expected = points if name == "v.json" else interpolate(points, pair)
        numpy.testing.assert_allclose(xy(table), expected, rtol=0, atol=1e-13)
        numpy.testing.assert_allclose(table["z"], 50 + change, rtol=0, atol=1e-12)
        images = numpy.column_stack((xy(table), table["z"]))
        back = map_points(dhm, [name], images, "--inverse")
        numpy.testing.assert_allclose(numpy.column_stack((xy(back), back["z"])), given, rtol=0, atol=1e-12)
        dhm("convert", name, "-o", "again.json", "-f")
        again = map_points(dhm, ["again.json"], given)
        numpy.testing.assert_array_equal(again["z"], table["z"])


def test_fallback_strategies_extend_the_nearest_triangle(dhm, pair):
    points = numpy.array([[0.5, 0.5], [-0.3, 0.4], [1.2, 1.3], [0.3, -0.01]])
    corners = pair.source[pair.triangles]
    for strategy in ("nearest_centroid", "nearest_side"):
        write_json(dhm.path("f.json"), pair, format_version="1.1", fallback_strategy=strategy)
        result = dhm.path("p.csv")
        write_csv(result, points)
        ran = dhm("map", "f.json", "p.csv", "-o", "-")
        table = read_csv(ran.out)
        assert table["Fallback"].tolist() == [0, 1, 1, 1] and table[MASK].tolist() == [1, 0, 0, 0]
        assert strategy in ran.err
        for k in range(1, 4):
            if strategy == "nearest_centroid":
                cell = ((corners.mean(axis=1) - points[k]) ** 2).sum(axis=1).argmin()
            else:
                t = numpy.linspace(0, 1, 2001)[:, None, None, None]
                sides = corners + t * (numpy.roll(corners, -1, axis=1) - corners)
                cell = ((sides - points[k]) ** 2).sum(axis=-1).min(axis=(0, 2)).argmin()
            own = Pair(pair.source, pair.target, pair.triangles[cell : cell + 1])
            numpy.testing.assert_allclose(xy(table)[k], interpolate(points[k : k + 1], own)[0], atol=1e-12)


# --- Tables


def test_tables_keep_every_digit_and_column(dhm, pair):
    text = ("\ufeff# measured in 1990\nName;N;E;\"Remark; long\";no\r\n\"Old \"\"Oak\"\"\";0.250;0.50;x;007\n"
            "Stone;3;3;\"two\nlines\";1.10\n")
    dhm.path("t.csv").write_text(text, encoding="utf-8")
    out = dhm("map", "pair.json", "t.csv", "-o", "-").out.decode()
    assert out.startswith("# measured in 1990\n")
    lines = list(csv.reader(io.StringIO(out.split("\n", 1)[1]), delimiter=";"))
    assert lines[0] == ["Name", "N", "E", "Remark; long", "no", MASK]
    assert [(l[0], l[3], l[4]) for l in lines[1:]] == [('Old "Oak"', "x", "007"), ("Stone", "two\nlines", "1.10")]
    image = [float(lines[1][2]), float(lines[1][1])]
    numpy.testing.assert_allclose(image, interpolate(numpy.array([[0.5, 0.25]]), pair)[0], atol=1e-15)
    dhm.path("again.csv").write_text(out)
    assert f"column {MASK} is replaced" in dhm("map", "pair.json", "again.csv", "-o", "-").err
    # Coordinates that do not move keep their text.
    out = dhm("coordinates", "pair.json", "t.csv", "-o", "-").out.decode()
    assert ";0.250;0.50;x;007;" in out and ";3;3;" in out


@pytest.mark.parametrize("text, rows", [
    (b'x,y,desc\n0.4,0.5,6" pipe\n0.5,0.5,8" pipe\n0.6,0.5,none\n', 3),
    (b"x,y,n\r0.4,0.5,a\r0.5,0.5,b\r", 2),
    (b'x y n\n0.4 0.5 "a\tb"\n  0.4\t0.4   c  \n', 2),
    (b'id,x,y\n"#1",0.5,0.25\n2,0.25,0.5\n', 2),
    (b'"#1",0.5,0.25\n2,0.25,0.5\n', 2),
    (b'x,y,n\r\n0.5,0.25,"two\r\nlines\r"\r\n\r\n0.25,0.5,\r\n', 2),
    (b"x;y;\xe4\n0.5;0.25;\xfc\n", 1),
])
def test_tables_go_through_twice(dhm, pair, text, rows):
    dhm.path("t.csv").write_bytes(text)
    columns = ["--columns", "2,3"] if text.startswith(b'"#1"') else []
    identity = Pair(pair.source, pair.source, pair.triangles)
    write_json(dhm.path("same.json"), identity)
    dhm("map", *columns, "same.json", "t.csv", "-o", "once.csv")
    dhm("map", *columns, "same.json", "once.csv", "-o", "twice.csv")
    separator = ";" if b";" in text else "," if b"," in text else " "
    once, twice = (
        list(csv.reader(io.StringIO(dhm.path(n).read_bytes().decode("latin-1"), newline=""), delimiter=separator))
        for n in ("once.csv", "twice.csv")
    )
    assert len(once) == rows + (0 if text.startswith(b'"#1"') else 1)
    for a, b in zip(once, twice):
        assert len(a) == len(once[0])
        b = b[: len(a)]
        assert a[0] == b[0] or float(a[0]) == pytest.approx(float(b[0]))
        assert a[-2] == b[-2] or float(a[-2]) == pytest.approx(float(b[-2]))
    for word in ("a\tb", "two\r\nlines\r", "\xfc", '6" pipe', "#1"):
        if word.encode("latin-1") in text:
            assert any(word in field for row in twice for field in row)


def test_columns_are_chosen(dhm, pair):
    expected = interpolate(numpy.array([[0.25, 0.5]]), pair)[0]
    for x, y in (("x", "y"), ("E", "N"), ("Easting", "Northing"), ("Rechtswert", "Hochwert"), ("lon", "lat"),
                 (" X", "y "), ("POINT_X", "POINT_Y")):
        dhm.path("t.csv").write_text(f"id;{y};{x}\n7;0.5;0.25\n")
        out = dhm("map", "pair.json", "t.csv", "-o", "-").out.decode().splitlines()
        assert out[0] == f"id;{y};{x};{MASK}"
        numpy.testing.assert_allclose([float(w) for w in out[1].split(";")], [7, *expected[::-1], 1], atol=1e-15)
    dhm.path("t.csv").write_text("up,right,id\n0.5,0.25,1\n")
    for columns in ("right,up", "2,1", " RIGHT,Up"):
        out = dhm("map", "pair.json", "t.csv", "--columns", columns, "-o", "-").out.decode().splitlines()
        numpy.testing.assert_allclose([float(w) for w in out[1].split(",")[:2]], expected[::-1], atol=1e-15)
    for columns in ("4,1", "up", "0,1", "x,y", "1,2,3,1", "up,up", "up,1"):
        dhm.refuse(USAGE, "map", "pair.json", "t.csv", "--columns", columns, "-o", "n.csv", says="--columns")
    # Guessing would map something else than points.
    dhm.path("t.csv").write_text("height,a,b\n0.5,0.25,0.5\n")
    dhm.refuse(FILE, "map", "pair.json", "t.csv", "-o", "n.csv", says=("t.csv", '"height", "a", "b"', "--columns"))


@pytest.mark.parametrize("text, says", [
    ("", "no points"), ("\n\n# nothing\n", "no points"), ("x,y\n", "no points"), ("x,y\n1,2\n3\n", "line 3"),
    ("x,y\n1,2\n3,b\n", "line 3"), ('x,y\n1,"2\n', "line 2"), ("x,y\n0.1,0.2\n0.3,\n", "line 3"),
    ("x\n1\n", "two coordinates"), ("x,y\n1,2,3\n", "line 2"), ("x,y\n1,1e999\n", "line 2"),
    ("x,y\n0x1,2\n", "line 2"), ("x,y\n1_0,2\n", "line 2"), ('# c\n\nx,y,n\n1,2,"a\nb"\n3,b,c\n', "line 6"),
    ("x;y\n0,5;0,25\n", "decimal points"), ("0,5;0,25\n", "line 1"), ("x y\n0.5 1\n0,5 0,25\n", "line 3"),
    ("id\tx\ty\n1\t0,5\t1\n", "line 2"), ("0,5;0,25;a;b\n1,5;2,5;c;d\n", "0,25"), ("0,5 0,25\n", "line 1"),
])
def test_damaged_tables(dhm, pair, text, says):
    dhm.path("bad.csv").write_text(text)
    dhm.refuse(FILE, "map", "pair.json", "bad.csv", "-o", "new.csv", says=("bad.csv", says))


def test_noise_is_not_a_table(dhm, pair):
    dhm.path("bad.csv").write_bytes(numpy.random.default_rng(9).bytes(3000))
    dhm.refuse(FILE, "map", "pair.json", "bad.csv", "-o", "new.csv", says="bad.csv")


def test_array_names_that_xml_cannot_hold(dhm, pair):
    write_vtk(dhm.path("d.vtk"), inside_points(pair, 9), [[0, 1, 2]], target=numpy.zeros((9, 2)))
    text = dhm.path("d.vtk").read_text()
    for code, character in (("26", "&"), ("3c", "<"), ("22", '"')):
        dhm.path("n.vtk").write_text(text.replace("VECTORS Moved", f"VECTORS R%{code}D"))
        dhm.refuse(REFUSED, "map", "pair.json", "n.vtk", "-o", "n.vtp", says=(f"R{character}D", ".vtk"))
        dhm("map", "pair.json", "n.vtk", "-o", "out.vtk", "--force")


def test_a_million_rows_are_read_and_written_by_columns(dhm, pair):
    """A tenth of them, all different, come out in their order."""
    points = inside_points(pair, 100000)
    table = map_points(dhm, ["pair.json"], points)
    some = numpy.arange(0, 100000, 999)
    numpy.testing.assert_allclose(xy(table)[some], interpolate(points[some], pair), rtol=0, atol=1e-14)


# --- Meshes and VTK's files


def test_vtk_data_keeps_its_arrays(dhm, pair):
    points = inside_points(pair, 60)
    write_vtk(dhm.path("d.vtk"), points, [[0, 1, 2]], target=points)
    dhm("map", *MESHES, "d.vtk", "-o", "d.vtp", "--vectors", "none")
    assert 'Name="Moved"' in dhm.path("d.vtp").read_text()
    dhm("map", "--inverse", *MESHES, "d.vtp", "-o", "back.off", "-q")
    meshio = pytest.importorskip("meshio")
    back = meshio.read(dhm.path("back.off"))
    numpy.testing.assert_allclose(back.points[:, :2], points, rtol=0, atol=1e-13)
    numpy.testing.assert_array_equal(back.cells[0].data, [[0, 1, 2]])


def test_vectors_that_are_not_active_are_named_or_mapped(dhm, pair):
    points = inside_points(pair, 60)
    write_vtk(dhm.path("d.vtk"), points, [[0, 1, 2]], target=points)
    text = dhm.path("d.vtk").read_text()
    dhm.path("d.vtk").write_text(text + text[text.index("VECTORS Moved") :].replace("Moved", "Other"))
    for option in ("active", "all", "none"):
        said = dhm("map", *MESHES, "d.vtk", "--vectors", option, "-o", "v.vtp", "-f").err
        assert ("Other (--vectors all" in said) == (option == "active") and "Moved" not in said
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(dhm.path("v.vtp")))
        reader.Update()
        arrays = reader.GetOutput().GetPointData()
        moved, other = (vtk_to_numpy(arrays.GetArray(name))[:, :2] for name in ("Moved", "Other"))
        assert (moved == other).all() == (option != "active")
        numpy.testing.assert_array_equal((other == points).all(), option != "all")


def test_meshes_with_points_outside_are_not_written_where_they_cannot_be_marked(dhm, pair):
    write_mesh(dhm.path("d.off"), [[0.5, 0.5], [0.6, 0.5], [1.5, 0.6]], [[0, 1, 2]])
    dhm.refuse(REFUSED, "map", *MESHES, "d.off", "-o", "new.obj", says=".vtp")
    dhm("map", *MESHES, "d.off", "-o", "new.vtp")


def test_trees_of_data_stay_trees(dhm, pair):
    tree, points = vtkMultiBlockDataSet(), [inside_points(pair, 9, seed) for seed in (1, 2)]
    for block, name in ((0, "rock"), (2, "soil")):
        tree.SetBlock(block, make_mesh(points[block // 2], [[0, 1, 2]]))
        tree.GetMetaData(block).Set(vtkCompositeDataSet.NAME(), name)
    writer = vtkXMLMultiBlockDataWriter()
    writer.SetFileName(str(dhm.path("tree.vtm")))
    writer.SetInputData(tree)
    writer.Write()
    words = ("map", "-s", "linear", *MESHES, "tree.vtm", "-o")
    for name in ("out.vtm", "out.vtk"):
        dhm(*words, name)
        reader = vtkGenericDataObjectReader() if name == "out.vtk" else vtkXMLMultiBlockDataReader()
        reader.SetFileName(str(dhm.path(name)))
        reader.Update()
        result = reader.GetOutputDataObject(0)
        assert result.GetNumberOfBlocks() == 3 and result.GetBlock(1) is None
        for block, called in ((0, "rock"), (2, "soil")):
            found = vtk_to_numpy(result.GetBlock(block).GetPoints().GetData())[:, :2]
            numpy.testing.assert_allclose(found, interpolate(points[block // 2], pair), rtol=0, atol=1e-6)
            assert result.GetMetaData(block).Get(vtkCompositeDataSet.NAME()) == called
    # Files of blocks are replaced on request only, and others in their folder stay.
    dhm.path("out.vtm").unlink()
    dhm.path("out/mine.txt").write_text("a note")
    dhm.refuse(FILE, *words, "out.vtm", says=("out_0.vtp", "--force"))
    dhm(*words, "out.vtm", "--force")
    assert dhm.path("out/mine.txt").read_text() == "a note"
    dhm.refuse(USAGE, *words, "-", "--output-format", "vtm", says=".vtk")


def test_parts_of_meshes_that_are_lost_are_named(dhm, pair):
    text = "mtllib a.mtl\nv 0.2 0.2 0 1 0 0\nv 0.8 0.2 0 1 0 0\nv 0.5 0.8 0 1 0 0\nvt 0 0\nusemtl red\n"
    dhm.path("d.obj").write_text(text + "f 1/1 2/1 3/1\nl 1 2\n")
    assert "not mtllib, colors, vt, usemtl, l." in dhm("map", *MESHES, "d.obj", "-o", "out.obj").err
    dhm.path("d.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
        "property uchar red\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0.2 0.2 0 9\n0.8 0.2 0 9\n0.5 0.8 0 9\n3 0 1 2\n")
    assert "not red." in dhm("map", *MESHES, "d.ply", "-o", "out.ply").err
    # Nothing is lost of plain meshes, nor of meshes of the pair.
    assert "not" not in dhm("map", "-s", "linear", *MESHES, "a.off", "-o", "plain.off").err
    dhm.path("b.obj").write_text("vt 0 0\nvn 0 0 1\n" + text + "f 1 2 3\n")
    assert "not" not in dhm("check", "b.obj", "b.obj", "--quick").err


def test_kinds_that_do_not_fit(dhm, pair):
    write_csv(dhm.path("p.csv"), [[0.5, 0.5]])
    for data, output, says in (
            ("a.off", "new.csv", ".vtp"), ("p.csv", "new.vtu", ".csv"), ("p.csv", "new.xyzzy", ".csv"),
            ("p.csv", "new", "no extension"), ("p.csv", "", "no extension"), ("p.csv", "new.gpkg", ".gpkg")):
        dhm.refuse(USAGE, "map", "pair.json", data, "-o", output, says=says)
    dhm.refuse(USAGE, "coordinates", "pair.json", "a.off", "-o", "new.obj", says=".vtp")


# --- Systems


def test_defaults_are_said(dhm, pair):
    Image = pytest.importorskip("PIL.Image")
    Image.fromarray(numpy.zeros((2, 2), "u1")).save(dhm.path("i.png"))
    write_csv(dhm.path("p.csv"), [[0.5, 0.5]])
    bent = numpy.column_stack((pair.source, pair.source[:, 0] ** 2))
    write_mesh(dhm.path("bent.off"), bent, pair.triangles)
    for arguments, system in (
            (["map", *MESHES, "p.csv", "-o", "-"], "smooth"), (["map", "pair.json", "p.csv", "-o", "-"], "linear"),
            (["warp", *MESHES, "i.png", "-o", "w.png"], "cubic"),
            (["warp", "pair.json", "i.png", "-o", "l.png"], "linear"),
            (["morph", *MESHES, "--source-image", "i.png", "-n", "2", "-o", "m%d.png"], "cubic"),
            (["map", "bent.off", "bent.off", "p.csv", "-o", "-"], "smooth")):
        assert f"coordinate system is {system}" in dhm(*arguments).err
        assert "coordinate system" not in dhm(*arguments, "--force", "--system", "linear").err
    dhm.refuse(REFUSED, "map", "bent.off", "bent.off", "p.csv", "-s", "cubic", "-o", "n.csv", says="Smooth")


def test_cubic_and_its_options(dhm, pair):
    """A map other than Smooth's, with an inverse, near Linear if it has to be."""
    points = inside_points(pair, 300)
    linear, smooth = (xy(map_points(dhm, MESHES, points, "-s", s)) for s in ("linear", "smooth"))
    seen = [smooth]
    for options in ([], ["--bending", "local"], ["--fairness", "1"], ["--max-deviation", "1e-3"]):
        options = ["--system", "cubic", *options]
        images = xy(map_points(dhm, MESHES, points, *options))
        assert all(numpy.abs(images - other).max() > 1e-4 for other in seen)
        seen.append(images)
        numpy.testing.assert_allclose(xy(map_points(dhm, MESHES, images, "-i", *options)), points, rtol=0, atol=1e-12)
    assert numpy.hypot(*(seen[-1] - linear).T).max() <= 1e-3 < numpy.hypot(*(seen[1] - linear).T).max()
    for values in ("0", "-1", "x"):
        dhm.refuse(USAGE, "map", *MESHES, "p.csv", "--max-deviation=" + values, "-o", "n.csv", says="--max-deviation")
    dhm.refuse(USAGE, "map", *MESHES, "p.csv", "--fairness=9", "-o", "n.csv", says="--fairness")
