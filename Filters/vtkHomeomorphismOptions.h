// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkHomeomorphismOptions.h
 * The options that several classes have in common. Each option has a setter and a getter. Switches
 * also have On and Off methods. To add an option, add a line to a list below and its description
 * here. If the option changes the map, use it in Pipeline/Options.h as well.
 *
 * vtkHomeomorphismOptionsMacro() declares the options of the map, which vtkHomeomorphismAlgorithm
 * and vtkHomeomorphismTransform have:
 *
 * - `CoordinateSystem`: LINEAR (the piecewise linear map), CONTOUR (the published construction, for
 *   concordant triangles), SMOOTH (default; twice continuously differentiable except at the
 *   vertices, for any triangle) or CUBIC (for planar meshes; also continuously differentiable at
 *   interior vertices, certified to be one to one, with little bending; edges become curves, so
 *   triangles are not mapped onto triangles). See Documentation/cubic.md.
 * - `CubicBending`: the map of the CUBIC system: LEAST (default; the least bending for which a
 *   certificate was found) or LOCAL (explicit; moving a point changes the map only nearby).
 * - `MaximumDeviation`: the largest allowed distance between images in the SMOOTH or CUBIC system
 *   and in LINEAR, in the target's units; positive. Unlimited by default. Without effect in
 *   CONTOUR.
 * - `CertificateMargin`: for CUBIC with LEAST, the smallest accepted certificate of a triangle,
 *   relative to the determinant of LINEAR or, in triangles that are cut, to the certificate of
 *   LOCAL. 0.02 by default, in [0, 0.5].
 * - `FairnessRefinement`: for CUBIC with LEAST, the number of times that each triangle is first
 *   divided into four, 0 (default) to 4. Each level reduces bending and takes four times as long.
 * - `CenterPoint`: where the contours of the CONTOUR system start: CENTROID (default), or INCENTER,
 *   with which every triangle is concordant.
 * - `DiscordantTriangles`: in the CONTOUR system with CENTROID, triangles that are discordant in
 *   either mesh are an error (REFUSE, default) or are mapped by the LINEAR system (USE_LINEAR; the
 *   map remains continuous).
 * - `Tolerance`: the largest distance from the domain at which points are mapped like the nearest
 *   point of the domain, relative to the diagonal of the mesh's bounding box; at least 0. 0
 *   (default) allows only for the rounding of coordinates.
 * - `MaskInvalidTriangles`: whether triangles that are defective by themselves (degenerate, not
 *   finite, flipped, overlapping, at a non-manifold edge) are left out with a warning, which makes
 *   holes, instead of refusing the meshes. All mutually overlapping triangles are left out. Off by
 *   default.
 *
 * vtkHomeomorphismMappingMacro() declares the options of the filters that map data,
 * vtkDifferentiableHomeomorphism and vtkResampleThroughHomeomorphism:
 *
 * - `Inverse`: whether data is mapped from the target's domain to the source's. Off by default: it
 *   is mapped from the source's domain to the target's.
 * - `TransformActiveAttributes`: whether the active vectors, normals and tensors are transformed by
 *   the Jacobian. On by default. If off, their components are not changed.
 * - `BlankOutside`: whether points outside the domain, points without values, and the cells that
 *   use them are blanked in the output (vtkGhostType). On by default.
 */

#ifndef vtkHomeomorphismOptions_h
#define vtkHomeomorphismOptions_h

/// One line for each option: name, type, default, smallest and largest value. Switches have only a
/// name and a default.
#define vtkHomeomorphismOptionsList(Option, Switch)                                                \
  Option(CoordinateSystem, int, SMOOTH, LINEAR, CUBIC);                                            \
  Option(CubicBending, int, LEAST, LOCAL, LEAST);                                                  \
  Option(MaximumDeviation, double, VTK_DOUBLE_MAX, 1e-300, VTK_DOUBLE_MAX);                        \
  Option(CertificateMargin, double, 0.02, 0.0, 0.5);                                               \
  Option(FairnessRefinement, int, 0, 0, 4);                                                        \
  Option(CenterPoint, int, CENTROID, CENTROID, INCENTER);                                          \
  Option(DiscordantTriangles, int, REFUSE, REFUSE, USE_LINEAR);                                    \
  Option(Tolerance, double, 0.0, 0.0, VTK_DOUBLE_MAX);                                             \
  Switch(MaskInvalidTriangles, false)

#define vtkHomeomorphismMappingList(Switch)                                                        \
  Switch(Inverse, false);                                                                          \
  Switch(TransformActiveAttributes, true);                                                         \
  Switch(BlankOutside, true)

/// Declares the methods and the member of an option. The initializer is in braces because the
/// wrapping tools of VTK 9.6 find an equals sign ambiguous here.
#define vtkHomeomorphismOptionMacro(name, type, value, least, greatest)                            \
protected:                                                                                         \
  type name{ value };                                                                              \
                                                                                                   \
public:                                                                                            \
  vtkSetClampMacro(name, type, least, greatest);                                                   \
  vtkGetMacro(name, type)

/// Declares the methods and the member of a switch.
#define vtkHomeomorphismSwitchMacro(name, value)                                                   \
protected:                                                                                         \
  bool name{ value }; /* NOLINT(bugprone-macro-parentheses) */                                     \
                                                                                                   \
public:                                                                                            \
  vtkSetMacro(name, bool);                                                                         \
  vtkGetMacro(name, bool);                                                                         \
  vtkBooleanMacro(name, bool)

/// Declares the options of the map, with their enumerations.
#define vtkHomeomorphismOptionsMacro()                                                             \
  enum CoordinateSystems                                                                           \
  {                                                                                                \
    LINEAR = 0,                                                                                    \
    CONTOUR = 1,                                                                                   \
    SMOOTH = 2,                                                                                    \
    CUBIC = 3                                                                                      \
  };                                                                                               \
  enum CenterPoints                                                                                \
  {                                                                                                \
    CENTROID = 0,                                                                                  \
    INCENTER = 1                                                                                   \
  };                                                                                               \
  enum CubicBendings                                                                               \
  {                                                                                                \
    LOCAL = 0,                                                                                     \
    LEAST = 1                                                                                      \
  };                                                                                               \
  enum DiscordantTrianglesModes                                                                    \
  {                                                                                                \
    REFUSE = 0,                                                                                    \
    USE_LINEAR = 1                                                                                 \
  };                                                                                               \
  vtkHomeomorphismOptionsList(vtkHomeomorphismOptionMacro, vtkHomeomorphismSwitchMacro);           \
  void SetCoordinateSystemToLinear()                                                               \
  {                                                                                                \
    this->SetCoordinateSystem(LINEAR);                                                             \
  }                                                                                                \
  void SetCoordinateSystemToContour()                                                              \
  {                                                                                                \
    this->SetCoordinateSystem(CONTOUR);                                                            \
  }                                                                                                \
  void SetCoordinateSystemToSmooth()                                                               \
  {                                                                                                \
    this->SetCoordinateSystem(SMOOTH);                                                             \
  }                                                                                                \
  void SetCoordinateSystemToCubic()                                                                \
  {                                                                                                \
    this->SetCoordinateSystem(CUBIC);                                                              \
  }

/// Declares the options of filters that map data.
#define vtkHomeomorphismMappingMacro() vtkHomeomorphismMappingList(vtkHomeomorphismSwitchMacro)

#endif
// VTK-HeaderTest-Exclude: vtkHomeomorphismOptions.h
