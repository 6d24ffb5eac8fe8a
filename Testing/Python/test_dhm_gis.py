# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""dhm map of vector data, with geopandas and GDAL's ogrinfo as independent readers."""

import shutil
import sqlite3
import subprocess

import numpy
import pytest
from conftest import FILE, REFUSED, USAGE
from pairs import Pair, inside_points, interpolate, make_pair, write_csv, write_json

geopandas = pytest.importorskip("geopandas")
import shapely.geometry as geometry  # noqa: E402


@pytest.fixture
def shift(dhm):
    own = make_pair(5, 4, width=2000, height=1600, seed=11)
    result = Pair(own.source + [3384000, 6672000], own.target + [384000, 6669000], own.triangles)
    write_json(dhm.path("shift.json"), result, input_crs="EPSG:2393", output_crs="EPSG:3067")
    return result


def box(x, y, size):
    return [(x, y), (x + size, y), (x + size, y + size), (x, y + size), (x, y)]


@pytest.fixture
def parcels(shift):
    points = inside_points(shift, 6)
    x, y = 3384700.0, 6672500.0
    shapes = [
        geometry.Polygon(box(x, y, 400), [box(x + 100, y + 100, 50)]),
        geometry.MultiPolygon([geometry.Polygon(box(x + 500, y, 60)), geometry.Polygon(box(x + 500, y + 100, 60))]),
        geometry.LineString([(x, y, 5.5), (x + 300, y + 200, 6.5)]),
        geometry.Point(points[0]),
        geometry.MultiPoint(points[1:4].tolist()),
        None,
    ]
    return geopandas.GeoDataFrame(
        {"name": ["Österby", "b", "c", None, "e", "f"], "number": [1, 2, 3, 4, 5, 6],
         "area": [0.1, 0.25, 1 / 3, 4.0, 5.5, 6.5]},
        geometry=shapes, crs="EPSG:2393",
    )


def vertices(shape):
    if shape is None or shape.is_empty:
        return numpy.empty((0, 2))
    if hasattr(shape, "geoms"):
        return numpy.vstack([vertices(part) for part in shape.geoms])
    rings = [shape.exterior, *shape.interiors] if hasattr(shape, "exterior") else [shape]
    return numpy.vstack([numpy.array(ring.coords)[:, :2] for ring in rings])


def test_a_geopackage_there_and_back(dhm, shift, parcels):
    parcels.to_file(dhm.path("in.gpkg"), layer="parcels", driver="GPKG")
    parcels[3:5].to_file(dhm.path("in.gpkg"), layer="marks", driver="GPKG")
    dhm("map", "shift.json", "in.gpkg", "-o", "there.gpkg")
    there = geopandas.read_file(dhm.path("there.gpkg"), layer="parcels")
    assert there.crs == "EPSG:3067" and list(there.columns) == list(parcels.columns)
    for name in ("name", "number", "area"):
        known = parcels[name].notna()
        assert there[name].notna().tolist() == known.tolist()
        assert there[name][known].tolist() == parcels[name][known].tolist()
    for before, after in zip(parcels.geometry, there.geometry):
        assert (before is None) == (after is None)
        if before is not None:
            assert before.geom_type == after.geom_type and before.has_z == after.has_z
            numpy.testing.assert_allclose(vertices(after), interpolate(vertices(before), shift), rtol=0, atol=1e-8)
    assert [p[2] for p in there.geometry[2].coords] == [5.5, 6.5]
    dhm("map", "--inverse", "shift.json", "there.gpkg", "-o", "back.gpkg")
    for layer in ("parcels", "marks"):
        first, back = (geopandas.read_file(dhm.path(name), layer=layer) for name in ("in.gpkg", "back.gpkg"))
        assert back.crs == "EPSG:2393"
        for before, after in zip(first.geometry, back.geometry):
            numpy.testing.assert_allclose(vertices(after), vertices(before), rtol=0, atol=1e-8)
    if shutil.which("ogrinfo"):
        said = subprocess.run(["ogrinfo", "-so", dhm.path("there.gpkg"), "parcels"], stdout=subprocess.PIPE, check=True)
        text = said.stdout.decode()
        assert "Feature Count: 6" in text and 'ID["EPSG",3067]' in text and "number: Integer64" in text
        low, high = there.total_bounds[:2], there.total_bounds[2:]
        assert f"({low[0]:.6f}, {low[1]:.6f}) - ({high[0]:.6f}, {high[1]:.6f})" in text


def test_tables_without_geometry_stay(dhm, shift, parcels):
    """QGIS keeps the styles of a GeoPackage's layers in one."""
    parcels.to_file(dhm.path("in.gpkg"), layer="parcels", driver="GPKG")
    database = sqlite3.connect(dhm.path("in.gpkg"))
    database.execute("create table layer_styles (id integer primary key, f_table_name text, rank integer, style text)")
    database.execute("insert into layer_styles values (1, 'parcels', 7, '<qgis/>'), (2, 'other', null, null)")
    database.execute("insert into gpkg_contents (table_name, data_type, identifier) "
                     "values ('layer_styles', 'attributes', 'layer_styles')")
    database.commit()
    database.close()
    dhm("map", "shift.json", "in.gpkg", "-o", "out.gpkg")
    database = sqlite3.connect(dhm.path("out.gpkg"))
    rows = database.execute("select f_table_name, rank, style from layer_styles").fetchall()
    assert rows == [("parcels", 7, "<qgis/>"), ("other", None, None)]
    kinds = dict(database.execute("select table_name, data_type from gpkg_contents").fetchall())
    assert kinds == {"parcels": "features", "layer_styles": "attributes"}
    database.close()
    assert "layer_styles is left out" in dhm("map", "shift.json", "in.gpkg", "-o", "out.geojson").err


def test_types_of_columns_and_of_empty_layers_stay(dhm, shift, parcels):
    fiona = pytest.importorskip("fiona")
    types = {"day": "date", "floors": "int32", "owner": "str:20", "flat": "bool"}
    schema = {"geometry": "3D Polygon", "properties": types}
    shape = geometry.mapping(geometry.Polygon([(x, y, 1.0) for x, y in box(3384700, 6672500, 90)]))
    rows = [{"day": "2001-02-03", "floors": 3, "owner": "Österby", "flat": True},
            {"day": None, "floors": None, "owner": None, "flat": False}]
    for name, some in (("full", rows), ("empty", [])):
        with fiona.open(dhm.path("in.gpkg"), "w", layer=name, driver="GPKG", schema=schema, crs="EPSG:2393") as file:
            file.writerecords([{"type": "Feature", "geometry": shape, "properties": row} for row in some])
    dhm("map", "shift.json", "in.gpkg", "-o", "out.gpkg")
    for name, some in (("full", rows), ("empty", [])):
        with fiona.open(dhm.path("in.gpkg"), layer=name) as first, fiona.open(dhm.path("out.gpkg"), layer=name) as file:
            assert file.schema == first.schema and file.crs.to_epsg() == 3067
            assert [dict(row["properties"]) for row in file] == [dict(row["properties"]) for row in first]
            assert len(file) == len(some)
    columns = sqlite3.connect(dhm.path("out.gpkg")).execute("pragma table_info(full)").fetchall()
    assert {row[1]: row[2] for row in columns}["flat"] == "BOOLEAN"


def test_a_column_that_is_replaced_is_named(dhm, shift, parcels):
    parcels["outside"] = "a note"
    parcels.geometry[0] = geometry.Point(0, 0)
    parcels.to_file(dhm.path("in.gpkg"), driver="GPKG")
    assert "column outside is replaced" in dhm("map", "shift.json", "in.gpkg", "-o", "out.gpkg").err
    assert geopandas.read_file(dhm.path("out.gpkg"))["outside"].tolist() == [1, 0, 0, 0, 0, 0]


def test_other_formats(dhm, shift, parcels):
    for name, some in (("in.geojson", parcels), ("in.shp", parcels[:2]), ("in.fgb", parcels[:1])):
        some.to_file(dhm.path(name), driver={"n": "GeoJSON", "p": "ESRI Shapefile", "b": "FlatGeobuf"}[name[-1]])
        dhm("map", "shift.json", name, "-o", "out." + name[3:], "--crs", "EPSG:3067")
        out = geopandas.read_file(dhm.path("out." + name[3:]))
        assert out["number"].tolist() == some["number"].tolist()
        expected = interpolate(vertices(some.geometry.iloc[0]), shift)
        found = vertices(out.geometry[0])
        # A format may turn rings the other way round.
        numpy.testing.assert_allclose(numpy.sort(found, axis=0), numpy.sort(expected, axis=0), rtol=0, atol=1e-6)
    assert dhm.path("out.shx").is_file() and dhm.path("out.dbf").is_file()
    dhm.refuse(FILE, "map", "shift.json", "in.shp", "-o", "out.shp", says="--force")


def test_densified_segments_follow_the_map(dhm, shift):
    ends = numpy.array([[3384100.0, 6672100.0], [3385900.0, 6673500.0]])
    line = geopandas.GeoDataFrame({"id": [1]}, geometry=[geometry.LineString(ends)], crs="EPSG:2393")
    line.to_file(dhm.path("line.gpkg"), driver="GPKG")
    dhm("map", "shift.json", "line.gpkg", "-o", "dense.gpkg", "--densify", "10")
    found = vertices(geopandas.read_file(dhm.path("dense.gpkg")).geometry[0])
    count = int(numpy.ceil(numpy.hypot(*(ends[1] - ends[0])) / 10))
    t = numpy.linspace(0, 1, count + 1)[:, None]
    numpy.testing.assert_allclose(found, interpolate(ends[0] + t * (ends[1] - ends[0]), shift), rtol=0, atol=1e-8)


def test_features_outside_are_marked_and_not_invented(dhm, shift, parcels):
    far = geometry.Polygon(box(3384700, 6672500, 40000))
    layer = geopandas.GeoDataFrame({"id": [1, 2]}, geometry=[far, parcels.geometry[0]], crs="EPSG:2393")
    layer.to_file(dhm.path("far.gpkg"), driver="GPKG")
    said = dhm("map", "shift.json", "far.gpkg", "-o", "out.gpkg").err
    assert "1 feature is outside" in said and "marked 1 in outside" in said
    out = geopandas.read_file(dhm.path("out.gpkg"))
    assert out["outside"].tolist() == [1, 0]
    assert out.geometry[0] is None or out.geometry[0].is_empty
    dhm.refuse(REFUSED, "map", "shift.json", "far.gpkg", "-o", "new.gpkg", "--require-inside", says="1 feature")


def test_coordinate_reference_systems(dhm, shift, parcels):
    other = parcels[:1].set_crs("EPSG:3067", allow_override=True)
    other.to_file(dhm.path("other.gpkg"), driver="GPKG")
    assert "EPSG:2393" in dhm("map", "shift.json", "other.gpkg", "-o", "out.gpkg").err
    parcels[:1].to_file(dhm.path("in.gpkg"), driver="GPKG")
    dhm.refuse(USAGE, "map", "shift.json", "in.gpkg", "-o", "new.gpkg", "--crs", "EPSG:0", says="EPSG:0")
    # Without a word in the mesh's file the data's own stays.
    write_json(dhm.path("plain.json"), shift)
    dhm("map", "plain.json", "in.gpkg", "-o", "plain.gpkg")
    assert geopandas.read_file(dhm.path("plain.gpkg")).crs == "EPSG:2393"


def test_refusals(dhm, shift, parcels):
    parcels.to_file(dhm.path("in.gpkg"), layer="a", driver="GPKG")
    parcels.to_file(dhm.path("in.gpkg"), layer="b", driver="GPKG")
    dhm.refuse(REFUSED, "map", "shift.json", "in.gpkg", "-o", "new.geojson", says=("2", ".gpkg"))
    dhm.refuse(USAGE, "map", "shift.json", "in.gpkg", "-o", "new.csv", says="in.gpkg")
    dhm.path("bad.gpkg").write_bytes(dhm.path("in.gpkg").read_bytes()[:3000])
    dhm.refuse(FILE, "map", "shift.json", "bad.gpkg", "-o", "new.gpkg", says="bad.gpkg")
    dhm.path("bad.geojson").write_text('{"type": "FeatureCollection", "features": [')
    dhm.refuse(FILE, "map", "shift.json", "bad.geojson", "-o", "new.geojson", says="bad.geojson")


def test_missing_libraries_are_named(dhm, shift, parcels):
    """Without the optional libraries the rest works, and the message says which package to install."""
    blocked = dhm.path("blocked")
    for name in ("geopandas", "rasterio"):
        (blocked / name).mkdir(parents=True)
        (blocked / name / "__init__.py").write_text(f'raise ModuleNotFoundError("", name="{name}")')
    dhm.environment["PYTHONPATH"] = f"{blocked}:{dhm.environment.get('PYTHONPATH', '')}"
    parcels.to_file(dhm.path("in.gpkg"), driver="GPKG")
    dhm.refuse(FILE, "map", "shift.json", "in.gpkg", "-o", "new.gpkg", says=("geopandas", "python3-geopandas", "pip"))
    (blocked / "geopandas" / "__init__.py").write_text('raise ImportError("no pyogrio or fiona")')
    result = dhm.refuse(FILE, "map", "shift.json", "in.gpkg", "-o", "new.gpkg", says="no pyogrio or fiona")
    assert "python3-no" not in result.err
    write_csv(dhm.path("p.csv"), inside_points(shift, 5))
    dhm("map", "shift.json", "p.csv", "-o", "out.csv")


@pytest.mark.parametrize("extension", ["gpkg", "geojson", "shp", "fgb"])
def test_full_disks(dhm, shift, parcels, extension):
    parcels[:1].to_file(dhm.path("in.gpkg"), driver="GPKG")
    command = ["map", "shift.json", "in.gpkg", "-o", f"out.{extension}"]
    dhm(*command)
    sizes = {path.name: path.stat().st_size for path in dhm.folder.glob("out.*")}
    for path in dhm.folder.glob("out.*"):
        path.unlink()
    for limit in (0, max(sizes.values()) // 2, max(sizes.values()) - 1):
        dhm.refuse(FILE, *command, limit=limit, says=f"out.{extension}")
    dhm(*command)
    assert {path.name: path.stat().st_size for path in dhm.folder.glob("out.*")} == sizes
