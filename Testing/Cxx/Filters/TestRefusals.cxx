// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// If meshes are refused, the VTK classes report an error, set an error code and a table of
// diagnostics, and leave the outputs empty, without data of the previous update.

#include "Fixtures/Defects.h"

#include "vtkInBetweenTriangulation.h"
#include "vtkRefinedTriangulationPair.h"
#include "vtkResampleThroughHomeomorphism.h"

#include "vtkFieldData.h"
#include "vtkTransform.h"
#include "vtkVariant.h"

#include <fstream>
#include <iterator>

namespace
{

using namespace fixtures;

/// Two triangles of the source are degenerate.
MeshPair MakeDegeneratePair()
{
  const MeshPair pair = MakePlanarPair(4, 3, 0.0);
  MovePoint(pair.Source, 0, { 1.0, 1.0, 0.0 });
  return pair;
}

vtkIdType CountElements(vtkAlgorithm* algorithm)
{
  vtkIdType count = 0;
  for (int port = 0; port < algorithm->GetNumberOfOutputPorts(); ++port)
  {
    vtkDataObject* data = algorithm->GetOutputDataObject(port);
    count += data->GetNumberOfElements(vtkDataObject::POINT);
    count += data->GetNumberOfElements(vtkDataObject::CELL);
  }
  return count;
}

template <typename Algorithm>
class Refusals : public ::testing::Test
{
};

using Algorithms =
  ::testing::Types<vtkDifferentiableHomeomorphism, vtkTriangularCoordinates, vtkJacobianContinuity,
    vtkResampleThroughHomeomorphism, vtkRefinedTriangulationPair, vtkInBetweenTriangulation>;
TYPED_TEST_SUITE(Refusals, Algorithms);

TYPED_TEST(Refusals, OfMeshes)
{
  const auto filter = MakeAlgorithm<TypeParam>(MakePlanarPair(4, 1));
  Messages messages(filter);
  filter->Update();
  EXPECT_EQ(messages.Error() + messages.Warning(), "");
  EXPECT_GT(CountElements(filter), 0);
  EXPECT_EQ(filter->GetErrorCode(), 0u);

  for (int update = 0; update < 2; ++update)
  {
    messages.Clear();
    SetMeshes(filter, MakeDegeneratePair());
    filter->Update();
    EXPECT_TRUE(messages.HasError());
    EXPECT_FALSE(messages.HasWarning());
    EXPECT_EQ(filter->GetErrorCode(), TypeParam::MESHES_REFUSED);
    EXPECT_EQ(filter->GetNumberOfOutsidePoints(), -1);
    EXPECT_EQ(CountElements(filter), 0);
    vtkTable* table = filter->GetDiagnostics();
    ASSERT_EQ(table->GetNumberOfRows(), 1);
    EXPECT_EQ(table->GetValueByName(0, "Kind").ToString(), "DegenerateTriangle");
    EXPECT_EQ(table->GetValueByName(0, "Outcome").ToString(), "refused");
  }

  // With the defective triangles masked.
  messages.Clear();
  filter->MaskInvalidTrianglesOn();
  filter->Update();
  EXPECT_FALSE(messages.HasError());
  EXPECT_TRUE(messages.HasWarning());
  EXPECT_EQ(filter->GetErrorCode(), 0u);
  EXPECT_GT(CountElements(filter), 0);
  EXPECT_EQ(filter->GetDiagnostics()->GetValueByName(0, "Outcome").ToString(), "masked");
  SetMeshes(filter, MakePlanarPair(4, 1));
  filter->Update();
  EXPECT_EQ(filter->GetDiagnostics()->GetNumberOfRows(), 0);
}

TYPED_TEST(Refusals, OfMissingOrWrongInputs)
{
  vtkNew<TypeParam> filter;
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(messages.HasError());
  messages.Clear();
  SetMeshes(filter, MakePlanarPair(4, 1));
  filter->SetInputDataObject(0, vtkNew<vtkImageData>());
  filter->Update();
  EXPECT_TRUE(messages.HasError());
  EXPECT_NE(filter->GetErrorCode(), 0u);
}

TEST(Refusals, AreATable)
{
  const MeshPair pair = MakeDegeneratePair();
  MovePoint(pair.Target, 24, { 3.0, 3.5, NotANumber });
  const auto filter = MakeAlgorithm<vtkDifferentiableHomeomorphism>(pair);
  Messages messages(filter);
  filter->MaskInvalidTrianglesOn();
  filter->Update();
  vtkTable* table = filter->GetDiagnostics();
  ASSERT_EQ(table->GetNumberOfRows(), 2);
  auto* ids = vtkIdTypeArray::SafeDownCast(table->GetFieldData()->GetArray("Ids"));
  ASSERT_TRUE(ids);
  for (vtkIdType row = 0; row < 2; ++row)
  {
    for (const auto& [column, text] : std::vector<std::pair<const char*, const char*>>{
           { "Kind", row == 0 ? "DegenerateTriangle" : "NotFinite" },
           { "Domain", row == 0 ? "source" : "target" }, { "Outcome", "masked" },
           { "Remedy", "RepairOrMask" }, { "Count", "2" } })
    {
      EXPECT_EQ(table->GetValueByName(row, column).ToString(), text);
    }
    const vtkIdType first = table->GetValueByName(row, "FirstId").ToInt();
    EXPECT_EQ(ids->GetValue(first), 30 * row);
    EXPECT_EQ(ids->GetValue(first + 1), 30 * row + 1);
  }
}

TEST(Refusals, AreDocumentedAndHaveADifferentMessageForEachKind)
{
  std::ifstream file(DIAGNOSTICS_DOCUMENT);
  const std::string document{ std::istreambuf_iterator<char>(file),
    std::istreambuf_iterator<char>() };
  ASSERT_FALSE(document.empty()) << DIAGNOSTICS_DOCUMENT;
  std::set<std::string> messages;
  for (int kind = 0; kind < MeshDiagnostic::NumberOfKinds; ++kind)
  {
    MeshDiagnostic diagnostic;
    diagnostic.What = static_cast<Kind>(kind);
    const std::string entry = std::string("| `") + GetName(diagnostic.What) + "` |";
    EXPECT_NE(document.find(entry), std::string::npos) << entry;
    const std::string remedy = std::string("`") + GetName(diagnostic.GetRemedy()) + "` |";
    EXPECT_NE(document.find(remedy, document.find(entry)), std::string::npos) << remedy;
    EXPECT_TRUE(messages.insert(entry).second) << entry;
    const bool ofCells =
      kind >= static_cast<int>(Kind::NotTriangles) && kind <= static_cast<int>(Kind::Discordant);
    for (const std::size_t cells : { 0u, 1u, 12u })
    {
      diagnostic.Ids.assign(cells, 7);
      if (ofCells == (cells > 0))
      {
        EXPECT_TRUE(messages.insert(Describe(diagnostic)).second) << entry;
      }
    }
  }
  // At most ten ids are listed.
  EXPECT_EQ(
    homeomorphism::ListIds(Range(0, 9)).size() + 5, homeomorphism::ListIds(Range(0, 10)).size());
}

TEST(Refusals, LeaveEveryPointOutsideATransform)
{
  const auto plane = MakePlanarPair(4, 40).Source;
  const auto sheet = MakeSheet(4, 40, 0.3);
  const Point probe{ 1.5, 1.4, 0.0 };
  for (const MeshPair& pair : { MakeDegeneratePair(), MeshPair{ sheet, plane },
         MeshPair{ plane, sheet }, MeshPair{ sheet, sheet }, MeshPair{ nullptr, plane },
         MeshPair{ plane, nullptr }, MeshPair{ nullptr, nullptr } })
  {
    vtkNew<vtkHomeomorphismTransform> transform;
    Messages messages(transform);
    transform->SetSource(plane);
    transform->SetTarget(plane);
    ASSERT_TRUE(transform->IsInside(probe.data()));
    ASSERT_EQ(messages.Error() + messages.Warning(), "");
    transform->SetSource(pair.Source);
    transform->SetTarget(pair.Target);
    transform->Update();
    EXPECT_TRUE(messages.HasError());
    for (int direction = 0; direction < 2; ++direction)
    {
      EXPECT_FALSE(transform->IsInside(probe.data()));
      Point image;
      double derivative[3][3];
      transform->InternalTransformDerivative(probe.data(), image.data(), derivative);
      EXPECT_EQ(image, (Point{ 1e30, 1e30, 1e30 }));
      EXPECT_TRUE(std::isnan(derivative[0][0]) && std::isnan(derivative[2][2]));
      transform->Inverse();
      transform->Update();
    }
    // Valid meshes make it a map again.
    transform->SetSource(plane);
    transform->SetTarget(plane);
    EXPECT_TRUE(transform->IsInside(probe.data()));
  }
}

TEST(Refusals, OfMapsThatCannotBeMeasuredOrResampled)
{
  vtkNew<vtkJacobianContinuity> continuity;
  Messages messages(continuity);
  // No map; and a transform on a surface.
  continuity->SetInputData(MakePlanarPair(4, 1).Source);
  for (int update = 0; update < 2; ++update)
  {
    continuity->Update();
    EXPECT_TRUE(messages.HasError());
    EXPECT_EQ(CountElements(continuity), 0);
    messages.Clear();
    continuity->SetInputData(MakeSheet(4, 2, 0.5));
    continuity->SetTransform(vtkNew<vtkTransform>());
  }
  // An image over a surface.
  const auto resample =
    MakeAlgorithm<vtkResampleThroughHomeomorphism>({ MakeSheet(4, 2, 0.5), MakeSheet(4, 3, 0.5) });
  Messages ofResample(resample);
  resample->Update();
  EXPECT_TRUE(ofResample.HasError());
  EXPECT_EQ(resample->GetOutput()->GetPointData()->GetNumberOfArrays(), 0);
}

TEST(Refusals, OfWrongArgumentsAndData)
{
  vtkNew<vtkDifferentiableHomeomorphism> filter;
  Messages messages(filter);
  filter->SetAttributeTransformation(nullptr, 0);
  EXPECT_TRUE(messages.HasError());
  messages.Clear();
  filter->SetAttributeTransformation("Velocity", 99);
  EXPECT_TRUE(messages.HasError());
  EXPECT_EQ(filter->GetAttributeTransformation("Velocity"), -1);
  messages.Clear();
  SetMeshes(filter, MakePlanarPair(4, 1));
  filter->SetDataObject(vtkNew<vtkTable>());
  filter->Update();
  EXPECT_TRUE(messages.HasError());
  EXPECT_EQ(filter->GetErrorCode(), vtkDifferentiableHomeomorphism::DATA_REFUSED);
}

TEST(Refusals, ValuesOutOfRangeAreClamped)
{
  using Filter = vtkDifferentiableHomeomorphism;
  vtkNew<Filter> filter;
  vtkNew<vtkTriangularCoordinates> coordinates;
  vtkNew<vtkJacobianContinuity> continuity;
  filter->SetCoordinateSystem(77);
  EXPECT_EQ(filter->GetCoordinateSystem(), Filter::CUBIC);
  filter->SetCoordinateSystem(-3);
  EXPECT_EQ(filter->GetCoordinateSystem(), Filter::LINEAR);
  filter->SetCenterPoint(-5);
  EXPECT_EQ(filter->GetCenterPoint(), Filter::CENTROID);
  filter->SetDiscordantTriangles(9);
  EXPECT_EQ(filter->GetDiscordantTriangles(), Filter::USE_LINEAR);
  filter->SetTolerance(-1.0);
  EXPECT_EQ(filter->GetTolerance(), 0.0);
  coordinates->SetNumberOfContours(0);
  EXPECT_EQ(coordinates->GetNumberOfContours(), 1);
  coordinates->SetLineResolution(1000000);
  EXPECT_EQ(coordinates->GetLineResolution(), 1000);
  continuity->SetSamplesPerEdge(-3);
  EXPECT_EQ(continuity->GetSamplesPerEdge(), 1);
  continuity->SetResolution(7.0);
  EXPECT_EQ(continuity->GetResolution(), 1.0);

  // A tolerance that is NaN is 0.
  const auto map =
    MakeFilter(Smooth, MakePlanarPair(4, 11), MakeCloud({ { 1.0, 1.0, 0.0 }, { -0.1, 1.0, 0.0 } }));
  map->SetTolerance(NotANumber);
  map->Update();
  EXPECT_EQ(map->GetNumberOfOutsidePoints(), 1);
}

} // namespace
