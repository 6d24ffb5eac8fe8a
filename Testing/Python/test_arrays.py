# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""The Python package agrees with computations by numpy and scipy."""

import copy
import doctest
import pickle
import sys
import tempfile
import threading
import unittest

import numpy
import scipy.interpolate
import scipy.ndimage
import scipy.spatial
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersSources import vtkSphereSource

import vtkhomeomorphism
from vtkhomeomorphism import Homeomorphism, arrays

try:
    from vtkmodules.vtkIOHDF import vtkHDFReader, vtkHDFWriter
except ImportError:
    vtkHDFWriter = None


def make_pair(count=60, seed=5, move=0.02):
    """Delaunay triangles of random points of the unit square, and slightly moved points."""
    random = numpy.random.default_rng(seed)
    source = random.random((count, 2))
    source = numpy.vstack((source, [[0, 0], [1, 0], [1, 1], [0, 1]]))
    triangulation = scipy.spatial.Delaunay(source)
    corners = source[triangulation.simplices]

    def area(p):
        (x1, y1), (x2, y2) = (p[:, 1] - p[:, 0]).T, (p[:, 2] - p[:, 0]).T
        return x1 * y2 - y1 * x2

    target = source + move * random.standard_normal(source.shape)
    # As far as no triangle is flipped.
    while (area(target[triangulation.simplices]) * area(corners) <= 0).any():
        target = source + 0.7 * (target - source)
    return triangulation, source, target


class Arrays(unittest.TestCase):
    def setUp(self):
        self.triangulation, self.source, self.target = make_pair()
        self.triangles = self.triangulation.simplices
        self.points = numpy.random.default_rng(6).random((4000, 2))

    def make(self, system="smooth", **options):
        return Homeomorphism(self.source, self.target, self.triangles, system, **options)

    def test_linear_is_scipys_interpolation(self):
        expected = scipy.interpolate.LinearNDInterpolator(self.triangulation, self.target)
        images = self.make("linear")(self.points)
        numpy.testing.assert_allclose(images, expected(self.points), rtol=0, atol=1e-14)

    def test_smooth_is_linear_at_vertices_and_edges_only(self):
        linear, smooth = self.make("linear"), self.make("smooth")
        numpy.testing.assert_array_equal(smooth(self.source), self.target)
        edges = numpy.vstack([self.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
        middles = self.source[edges].mean(axis=1)
        numpy.testing.assert_allclose(
            smooth(middles), self.target[edges].mean(axis=1), rtol=0, atol=1e-15
        )
        difference = numpy.abs(smooth(self.points) - linear(self.points)).max()
        self.assertGreater(difference, 1e-3)

    def test_round_trips(self):
        for system in ("linear", "smooth", "contour"):
            f = self.make(system, discordant_by_linear=True)
            numpy.testing.assert_allclose(
                f.inverse(f(self.points)), self.points, rtol=0, atol=1e-13
            )

    def test_an_affine_map_is_reproduced(self):
        matrix = numpy.array([[1.5, 0.3], [-0.2, 0.7]])
        target = self.source @ matrix.T + [3.0, -1.0]
        f = Homeomorphism(self.source, target, self.triangles)
        numpy.testing.assert_allclose(
            f(self.points), self.points @ matrix.T + [3.0, -1.0], rtol=0, atol=1e-14
        )
        numpy.testing.assert_allclose(
            f.jacobian(self.points), numpy.broadcast_to(matrix, (4000, 2, 2)), atol=1e-11
        )

    def test_the_jacobian_is_the_derivative(self):
        f = self.make()
        points = 0.1 + 0.8 * self.points
        jacobian = f.jacobian(points)
        step = 1e-6
        for k in range(2):
            shift = step * numpy.eye(2)[k]
            quotient = (f(points + shift) - f(points - shift)) / (2 * step)
            numpy.testing.assert_allclose(jacobian[:, :, k], quotient, atol=1e-3)
            self.assertLess(numpy.median(numpy.abs(jacobian[:, :, k] - quotient)), 1e-8)
        inverse = f.jacobian(f(points), inverse=True)
        numpy.testing.assert_allclose(
            inverse @ jacobian, numpy.broadcast_to(numpy.eye(2), (4000, 2, 2)), atol=1e-9
        )

    def test_outside_is_nan(self):
        f = self.make()
        images = f([[0.5, 0.5], [1.5, 0.5], [numpy.nan, 0.0]])
        self.assertTrue(numpy.isfinite(images[0]).all())
        self.assertTrue(numpy.isnan(images[1:]).all())
        self.assertTrue(numpy.isnan(f.jacobian([[1.5, 0.5]])).all())
        triangle, edge, p, c = f.coordinates([[1.5, 0.5]])
        self.assertEqual((triangle[0], edge[0]), (-1, 0))
        self.assertTrue(numpy.isnan(p[0]) and numpy.isnan(c[0]))

    def test_coordinates_agree_in_source_and_target(self):
        f = self.make()
        back = Homeomorphism(self.target, self.source, self.triangles)
        here, there = f.coordinates(self.points), back.coordinates(f(self.points))
        same = here[0] == there[0]
        # Except for points that rounding moves across an edge.
        self.assertGreater(same.mean(), 0.999)
        numpy.testing.assert_allclose(here[3][same], there[3][same], atol=1e-9)

    def test_continuity(self):
        edges = 3 * len(self.triangles) - len(self.triangulation.convex_hull)
        for system, verdict in (("linear", 1), ("smooth", 0)):
            result = self.make(system).continuity(samples=3)
            self.assertEqual(len(result["Verdict"]), edges // 2)
            # Beside needles at the hull some verdicts are undecided (2).
            self.assertTrue(numpy.isin(result["Verdict"], (verdict, 2)).all())
            self.assertGreater((result["Verdict"] == verdict).mean(), 0.95)
            self.assertEqual(result["EdgeTriangles"].shape, (edges // 2, 2))

    def test_surfaces(self):
        lift = lambda p: numpy.column_stack((p, numpy.sin(3 * p[:, 0]) * p[:, 1]))
        f = Homeomorphism(lift(self.source), lift(self.target), self.triangles)
        middles = lift(self.source)[self.triangles].mean(axis=1)
        numpy.testing.assert_allclose(
            f(middles), lift(self.target)[self.triangles].mean(axis=1), atol=0.05
        )
        numpy.testing.assert_allclose(f.inverse(f(middles)), middles, rtol=0, atol=1e-13)

    def test_images_are_pulled_back(self):
        rows, columns = 40, 50
        scale = numpy.array([columns - 1.0, rows - 1.0])
        f = Homeomorphism(self.source * scale, self.target * scale, self.triangles)
        image = numpy.random.default_rng(8).random((rows, columns, 3))
        warped = f.warp_image(image, background=-1.0)
        y, x = numpy.mgrid[0:rows, 0:columns]
        pixels = numpy.column_stack((x.ravel(), y.ravel())).astype(float)
        origins = f.inverse(pixels)
        inside = numpy.isfinite(origins[:, 0])
        for channel in range(3):
            expected = scipy.ndimage.map_coordinates(
                image[:, :, channel], origins[inside][:, ::-1].T, order=1, mode="nearest"
            )
            got = warped[:, :, channel].reshape(-1)
            numpy.testing.assert_allclose(got[inside], expected, atol=1e-9)
            self.assertTrue((got[~inside] == -1.0).all())
        bytes_image = (255 * image).astype(numpy.uint8)
        warped_bytes = f.warp_image(bytes_image)
        self.assertEqual(warped_bytes.dtype, numpy.uint8)
        self.assertEqual(warped_bytes.shape, image.shape)

    def test_points_are_not_copied(self):
        for real in (numpy.float64, numpy.float32):
            points = numpy.zeros((10, 3), real)
            shared = vtk_to_numpy(arrays.as_points(points, "points")[0].GetData())
            self.assertTrue(numpy.shares_memory(points, shared))

    def test_what_is_given_is_left_alone(self):
        source, points = self.source.copy(), self.points.copy()
        f = Homeomorphism(source, self.target, self.triangles)
        before = f(points)
        source[:] = 7.0
        numpy.testing.assert_array_equal(f(points), before)
        numpy.testing.assert_array_equal(points, self.points)

    def test_integers_and_lists_and_nothing(self):
        f = self.make()
        numpy.testing.assert_array_equal(f([[0, 0]]), self.target[[-4]])
        self.assertEqual(f(numpy.empty((0, 2))).shape, (0, 2))

    def test_masked_elements_are_not_values(self):
        f = self.make()
        points = numpy.ma.array(self.points[:4], mask=[[0, 0], [1, 0], [0, 1], [0, 0]])
        images = f(points)
        numpy.testing.assert_array_equal(numpy.isnan(images[:, 0]), [False, True, True, False])
        numpy.testing.assert_array_equal(images[::3], f(self.points[:4])[::3])
        whole = numpy.ma.array([[0, 0], [1, 1]], mask=[[1, 0], [0, 0]])
        self.assertEqual(numpy.isnan(f(whole)[:, 0]).tolist(), [True, False])
        masked = numpy.ma.masked_less(self.source, 0.5)
        with self.assertRaisesRegex(ValueError, "not finite|NaN"):
            Homeomorphism(masked, self.target, self.triangles)
        with self.assertRaisesRegex(ValueError, "not finite|NaN"):
            Homeomorphism.from_landmarks(masked, self.target)
        pixels = numpy.arange(64).reshape(8, 8)
        g = Homeomorphism(7 * self.source, 7 * self.source, self.triangles)
        warped = g.warp_image(numpy.ma.masked_equal(pixels.astype(float), 27))
        # And pixels beside it, where rounding decides.
        self.assertTrue(numpy.isnan(warped[3, 3]) and numpy.isfinite(warped[[0, 1, 5, 6, 7]]).all())
        numpy.testing.assert_array_equal(g.warp_image(numpy.ma.array(pixels)), pixels)
        with self.assertRaisesRegex(TypeError, "masked"):
            g.warp_image(numpy.ma.masked_equal(pixels, 27))

    def test_byte_orders(self):
        f = Homeomorphism(7 * self.source, 7 * self.source, self.triangles)
        pixels = 300 * numpy.arange(64).reshape(8, 8)
        for kind in ("<u2", ">u2", ">i4", ">f4", ">f8"):
            warped = f.warp_image(pixels.astype(kind))
            self.assertEqual(warped.dtype, kind)
            numpy.testing.assert_allclose(warped, pixels, rtol=0, atol=1e-3)
        numpy.testing.assert_array_equal(self.make()(self.points.astype(">f8")), self.make()(self.points))
        numpy.testing.assert_array_equal(
            Homeomorphism(self.source, self.target, self.triangles.astype(">i4"))(self.points),
            self.make()(self.points))

    def test_copies_have_the_precision_of_the_first(self):
        """Rounding allows for it: points of the border in float32 are inside."""
        turn = numpy.array([[0.8, 0.6], [-0.6, 0.8]])
        f = Homeomorphism((self.source @ turn).astype("f4"), (self.target @ turn).astype("f4"), self.triangles)
        t = numpy.linspace(0, 1, 500)[:, None]
        border = ((t * self.source[-4] + (1 - t) * self.source[-3]) @ turn).astype("f4")
        self.assertFalse(numpy.isnan(f(border)).any())
        for again in (pickle.loads(pickle.dumps(f)), copy.deepcopy(f),
                      Homeomorphism(f.source, f.target, f.triangles)):
            self.assertEqual(again.source.dtype, numpy.float32)
            numpy.testing.assert_array_equal(again(border), f(border))

    def test_threads_take_turns(self):
        f = self.make()
        parts = numpy.split(self.points, 8)
        images, jacobians = [f(part) for part in parts], [f.jacobian(part) for part in parts]
        wrong, interval = [], sys.getswitchinterval()

        def run(k):
            for i in range(60):
                forward = (k + i) % 3
                found = (f(parts[k]), f.inverse(images[k]), f.jacobian(parts[k]))[forward]
                expected = (images[k], None, jacobians[k])[forward]
                if expected is not None and not numpy.array_equal(found, expected):
                    wrong.append(k)

        sys.setswitchinterval(1e-6)
        try:
            threads = [threading.Thread(target=run, args=(k,)) for k in range(8)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
        finally:
            sys.setswitchinterval(interval)
        self.assertEqual(wrong, [])

    def test_messages(self):
        with self.assertRaisesRegex(ValueError, "points"):
            Homeomorphism(self.source, self.target[1:], self.triangles)
        with self.assertRaisesRegex(ValueError, "shape"):
            Homeomorphism(self.source.ravel(), self.target, self.triangles)
        with self.assertRaisesRegex(ValueError, "points that do not exist"):
            Homeomorphism(self.source, self.target, self.triangles + 1000)
        with self.assertRaisesRegex(ValueError, "one of linear, contour, smooth"):
            self.make("quadratic")
        with self.assertRaisesRegex(ValueError, "(?i)discordant"):
            self.make("contour")
        with self.assertRaisesRegex(TypeError, "numbers"):
            self.make()(numpy.array([["a", "b"]]))
        flipped = self.target.copy()
        flipped[0] += 5.0
        with self.assertRaisesRegex(ValueError, "(?i)flipped|orientation|overlap"):
            Homeomorphism(self.source, flipped, self.triangles)

    def test_the_package(self):
        self.assertEqual(doctest.testmod(vtkhomeomorphism).failed, 0)
        self.assertIn("SMOOTH", dir(vtkhomeomorphism.vtkHomeomorphismTransform))
        self.assertIn("map data", vtkhomeomorphism.vtkDifferentiableHomeomorphism.__doc__)
        with self.assertRaises(AttributeError):
            vtkhomeomorphism.nothing


class Files(unittest.TestCase):
    @unittest.skipUnless(vtkHDFWriter, "this VTK writes no VTKHDF files")
    def test_a_mesh_from_a_vtkhdf_file(self):
        """vtkHDFReader gives cells in a storage of their own."""
        sphere = vtkSphereSource()
        sphere.Update()
        with tempfile.TemporaryDirectory() as folder:
            writer = vtkHDFWriter()
            writer.SetInputConnection(sphere.GetOutputPort())
            writer.SetFileName(folder + "/sphere.vtkhdf")
            writer.Write()
            reader = vtkHDFReader()
            reader.SetFileName(folder + "/sphere.vtkhdf")
            reader.Update()
            mesh = reader.GetOutputDataObject(0)
        self.assertEqual(mesh.GetNumberOfPolys(), 96)
        identity = vtkhomeomorphism.vtkDifferentiableHomeomorphism()
        identity.SetSourceData(mesh)
        identity.SetTargetData(sphere.GetOutput())
        identity.SetDataObject(mesh)
        identity.Update()
        self.assertEqual(identity.GetNumberOfOutsidePoints(), 0)
        numpy.testing.assert_allclose(
            vtk_to_numpy(identity.GetOutputDataObject(0).GetPoints().GetData()),
            vtk_to_numpy(mesh.GetPoints().GetData()), rtol=0, atol=1e-6)


if __name__ == "__main__":
    unittest.main()
