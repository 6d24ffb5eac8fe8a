// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkHomeomorphismOptions.h
 * The options that several classes have in common. Each option has a setter and a getter, switches
 * have On and Off methods as well. An option is added by a line in a list below and its description
 * here; if it changes the map, by its use in Pipeline/Options.h as well.
 *
 * vtkHomeomorphismOptionsMacro() declares the options of the map, which vtkHomeomorphismAlgorithm
 * and vtkHomeomorphismTransform have:
 *
 * - `CoordinateSystem`: LINEAR (the piecewise linear map), CONTOUR (the published construction;
 *   concordant triangles only), SMOOTH (default; twice continuously differentiable except at the
 *   vertices, any triangle) or CUBIC (continuously differentiable, interior vertices included, and
 *   certified one to one; it bends least, but does not map triangles onto triangles. Meshes in
 *   planes only). See Documentation/cubic.md.
 * - `CubicBending`: which map of the CUBIC system: LEAST (default; bends least among those that
 *   could be certified) or LOCAL (in closed form; moving a point changes the map nearby only).
 * - `MaximumDeviation`: the greatest distance of the SMOOTH and CUBIC systems' images from
 * LINEAR's, in the target's units, positive. Unlimited by default. CONTOUR has no such limit.
 * - `CertificateMargin`: with LEAST, how far above zero the certificate of the determinant has to
 *   be: relative to LINEAR's determinant, or, in triangles that are cut, to LOCAL's certificate.
 *   0.02 by default, in [0, 0.5].
 * - `FairnessRefinement`: with LEAST, how often the triangles are cut into four first, 0 (default)
 *   to 4. Each level bends less and costs four times as much.
 * - `CenterPoint`: where the contours of the Contour system start: CENTROID (default), or INCENTER,
 *   with which every triangle is concordant.
 * - `DiscordantTriangles`: whether triangles that are discordant in either mesh are an error in the
 *   Contour system (REFUSE, default) or are mapped by the Linear system (USE_LINEAR); the map stays
 *   continuous.
 * - `Tolerance`: how far outside the domain a point may be and still be mapped like the nearest
 *   point of the domain, also off a surface, relative to the diagonal of the mesh's bounding box. 0
 *   (default) allows only for the rounding of coordinates. Not negative.
 * - `MaskInvalidTriangles`: whether triangles that are invalid by themselves (degenerate, not
 *   finite, flipped, overlapping, at a non-manifold edge) are left out with a warning, as if there
 *   were holes, instead of refusing the meshes. All mutually overlapping triangles are left out.
 *   Off by default.
 *
 * vtkHomeomorphismMappingMacro() declares the options of the filters that map data,
 * vtkDifferentiableHomeomorphism and vtkResampleThroughHomeomorphism:
 *
 * - `Inverse`: whether data over the target's domain is mapped to the source's instead of the other
 *   way round. Off by default.
 * - `TransformActiveAttributes`: whether the active vectors, normals and tensors are transformed by
 *   the Jacobian. On by default; when off, they keep their components.
 * - `BlankOutside`: whether points outside (or without values) and the cells that use them are
 *   blanked in the output (vtkGhostType). On by default.
 */

#ifndef vtkHomeomorphismOptions_h
#define vtkHomeomorphismOptions_h

/// A line for each option: name, type, default, least and greatest value. Switches have only a name
/// and a default.
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

/// Declares the methods and the member of an option. In braces, because the wrapping tools of
/// VTK 9.6 take an equals sign here for an ambiguity.
#define vtkHomeomorphismOptionMacro(name, type, value, least, greatest)                            \
protected:                                                                                         \
  type name{ value };                                                                              \
                                                                                                   \
public:                                                                                            \
  vtkSetClampMacro(name, type, least, greatest);                                                   \
  vtkGetMacro(name, type)

/// The same of a switch.
#define vtkHomeomorphismSwitchMacro(name, value)                                                   \
protected:                                                                                         \
  bool name{ value };                                                                              \
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
