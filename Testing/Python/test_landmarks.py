# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Files of landmarks: each format, landmarks that are left out, and files that are refused."""

import json
import os

import numpy
import pytest

from vtkhomeomorphism.landmarks import (
    LandmarkFileError,
    is_landmark_file,
    read_landmarks,
    read_lines,
)

SHARED = os.environ.get(
    "DHM_SHARED_DATA", os.path.join(os.path.dirname(__file__), "..", "..", "..", "shared", "data")
)
POINTS = [[0.25, 1.5, 100.0, 200.0], [10.0, 2.0, 110.0, 190.0], [5.0, 9.0, 105.0, 180.0]]


def write(tmp_path, name, text, encoding="utf-8"):
    path = tmp_path / name
    path.write_bytes(text.encode(encoding))
    return path


def expect_points(landmarks, expected=POINTS):
    numpy.testing.assert_array_equal(
        numpy.hstack([landmarks.source, landmarks.target]), numpy.array(expected)
    )


def test_csv_with_and_without_header(tmp_path):
    rows = "\n".join(",".join(repr(v) for v in p) for p in POINTS)
    bare = read_landmarks(write(tmp_path, "bare.csv", rows))
    expect_points(bare)
    assert bare.names == ["1", "2", "3"]
    named = "id,Target_Y,target_x,source_x,source_y\n" + "\n".join(
        f"p{i},{p[3]},{p[2]},{p[0]},{p[1]}" for i, p in enumerate(POINTS)
    )
    landmarks = read_landmarks(write(tmp_path, "named.csv", named, "utf-8-sig"))
    expect_points(landmarks)
    assert landmarks.names == ["p0", "p1", "p2"]
    assert not landmarks.image_coordinates


@pytest.mark.parametrize("names", ["pixelX,pixelY,enable", "sourceX,sourceY,enable,dX,dY,residual"])
def test_qgis_points_have_y_up_and_disabled_rows(tmp_path, names):
    extra = ",0,0,0" if "residual" in names else ""
    text = f"mapX,mapY,{names}\n" + "".join(
        f"{p[2]},{p[3]},{p[0]},{-p[1]},1{extra}\n" for p in POINTS
    )
    text += f"7,7,7,-7,0{extra}\n"
    if extra:
        text = "#CRS: EPSG:3857\n" + text
    landmarks = read_landmarks(write(tmp_path, "control.points", text))
    expect_points(landmarks)
    assert landmarks.left_out == [("6" if extra else "5", "disabled")]
    assert landmarks.image_coordinates
    assert landmarks.crs == ("EPSG:3857" if extra else None)


def annotation(key="resourceCoords"):
    return {
        "type": "Annotation",
        "body": {
            "type": "FeatureCollection",
            "features": [
                {
                    "type": "Feature",
                    "properties": {key: p[:2]},
                    "geometry": {"type": "Point", "coordinates": p[2:]},
                }
                for p in POINTS
            ],
        },
    }


def test_georeference_annotations(tmp_path):
    path = write(tmp_path, "map.json", json.dumps(annotation()))
    expect_points(read_landmarks(path))
    assert read_landmarks(path).crs == "EPSG:4326"
    assert is_landmark_file(path)
    page = {"type": "AnnotationPage", "items": [annotation("pixelCoords")]}
    expect_points(read_landmarks(write(tmp_path, "page.json", json.dumps(page))))
    page["items"].append(annotation())
    with pytest.raises(LandmarkFileError, match="2 georeference annotations"):
        read_landmarks(write(tmp_path, "two.json", json.dumps(page)))


def test_bigwarp_leaves_out_and_names_points_set_on_one_side(tmp_path):
    text = "".join(
        f'"Pt-{i}","true","{p[0]}","{p[1]}","{p[2]}","{p[3]}"\n' for i, p in enumerate(POINTS)
    )
    text += '"Pt-3","true","1.0","2.0","Infinity","Infinity"\n"Pt-4","false","1","1","1","1"\n'
    landmarks = read_landmarks(write(tmp_path, "landmarks.csv", text))
    expect_points(landmarks)
    assert landmarks.names == ["Pt-0", "Pt-1", "Pt-2"]
    assert landmarks.left_out == [("Pt-3", "no position in the target"), ("Pt-4", "disabled")]


@pytest.mark.parametrize(
    "name, text, where",
    [
        ("a.csv", "source_x,source_y,target_x,target_y\n1,2,3,4\n1,2,x,4\n", "line 3: target_x"),
        ("b.csv", "1,2,3,4\n5,6,7,8\n", "2 usable"),
        ("c.csv", "a,b,c,d\n1,2,3,4\n", "need the columns"),
        ("d.csv", "1,2,3\n", "3 columns"),
        ("e.csv", "1,2,3,4\n1,2,3\n", "line 2"),
        ("f.points", "mapX,mapY,enable\n1,2,1\n", "pixelX is missing"),
        ("g.json", "{", "not valid JSON"),
        ("h.json", "[" * 100000, "not valid JSON"),
        ("i.csv", "", "no landmarks"),
        ("j.csv", "id,source_x,source_y,target_x,target_y\n", "0 usable"),
        ("k.points", "mapX,mapY,pixelX,pixelY,enable\n", "0 usable"),
        ("l.csv", "1,2,3,4\0", "not a text file"),
    ],
)
def test_refusals_name_file_and_line(tmp_path, name, text, where):
    path = write(tmp_path, name, text)
    with pytest.raises(LandmarkFileError) as refusal:
        read_landmarks(path)
    assert name in str(refusal.value) and where in str(refusal.value)


def test_comments_and_names_in_other_encodings(tmp_path):
    text = ("# of 1990\nid,source_x,source_y,target_x,target_y\n\nKöln,0.25,1.5,100,200\n# moved\n"
            "b,10,2,110,190\nc,5,9,105,180\n")
    for encoding in ("utf-8", "utf-8-sig", "latin-1"):
        for ends in ("\n", "\r\n", "\r"):
            path = write(tmp_path, "a.csv", text.replace("\n", ends), encoding)
            assert is_landmark_file(path)
            landmarks = read_landmarks(path)
            expect_points(landmarks)
            assert landmarks.names == ["Köln", "b", "c"]
            lines = write(tmp_path, "lines.txt", "c Köln" + ends, encoding)
            assert read_lines(lines, landmarks.names) == [[2, 0]]


def test_lines_refer_to_landmarks_by_name(tmp_path):
    path = write(tmp_path, "lines.csv", "a b c\n\nc,a\n")
    assert read_lines(path, ["c", "a", "b"]) == [[1, 2, 0], [0, 1]]
    with pytest.raises(LandmarkFileError, match="line 1: there is no landmark b"):
        read_lines(path, ["a", "c"])


def test_real_landmarks():
    folder = os.path.join(SHARED, "landmarks")
    if not os.path.isdir(folder):
        pytest.skip("the real landmarks are absent")
    for name, count in (("nobeoka", 392), ("uno-bus", 343)):
        landmarks = read_landmarks(os.path.join(folder, f"{name}.csv"))
        assert len(landmarks.source) >= count
    lines = read_lines(os.path.join(folder, "uno-bus-lines.csv"), landmarks.names)
    assert max(max(line) for line in lines) < len(landmarks.source)
