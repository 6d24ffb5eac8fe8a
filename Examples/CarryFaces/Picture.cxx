// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Picture.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkImageActor.h"
#include "vtkImageMapper3D.h"
#include "vtkImageResize.h"
#include "vtkNew.h"
#include "vtkPNGWriter.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkTextActor.h"
#include "vtkTextProperty.h"
#include "vtkWindowToImageFilter.h"

namespace
{

// Drawn twice as large and averaged, which smooths lines on any renderer.
constexpr int oversampling = 2;
constexpr int panelWidth = 360 * oversampling;
constexpr int titleHeight = 40 * oversampling;

void AddLines(vtkRenderer* renderer, vtkPolyData* lines, const std::array<double, 3>& color,
  double opacity, float width, double depth)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(lines);
  mapper->ScalarVisibilityOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetRepresentationToWireframe();
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetColor(color[0], color[1], color[2]);
  actor->GetProperty()->SetOpacity(opacity);
  actor->GetProperty()->SetLineWidth(width * oversampling);
  actor->SetPosition(0.0, 0.0, depth);
  renderer->AddActor(actor);
}

void AddView(vtkRenderWindow* window, const Panel& panel, const std::array<double, 4>& viewport,
  const std::array<double, 2>& center, double halfHeight, float lineWidth)
{
  vtkNew<vtkRenderer> renderer;
  renderer->SetViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
  renderer->SetBackground(1.0, 1.0, 1.0);
  vtkNew<vtkImageActor> image;
  image->GetMapper()->SetInputData(panel.Image);
  image->InterpolateOn();
  renderer->AddActor(image);
  AddLines(renderer, panel.Mesh, panel.MeshColor, 0.5, 0.5f * lineWidth, 0.5);
  AddLines(renderer, panel.Lines, panel.LineColor, 1.0, lineWidth, 1.0);
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetParallelScale(halfHeight);
  camera->SetFocalPoint(center[0], center[1], 0.0);
  camera->SetPosition(center[0], center[1], 1000.0);
  renderer->ResetCameraClippingRange();
  window->AddRenderer(renderer);
}

} // namespace

void WritePicture(const std::vector<Panel>& panels, const std::string& fileName)
{
  double highest = 0.0;
  for (const Panel& panel : panels)
  {
    double bounds[6];
    panel.Image->GetBounds(bounds);
    highest = std::max(highest, (bounds[3] - bounds[2]) / (bounds[1] - bounds[0]));
  }
  const auto count = static_cast<double>(panels.size());
  const int imageHeight = static_cast<int>(panelWidth * highest);
  const int width = panelWidth * static_cast<int>(panels.size());
  const int height = titleHeight + imageHeight + panelWidth;
  const double closeUpTop = static_cast<double>(panelWidth) / height;
  const double imageTop = static_cast<double>(panelWidth + imageHeight) / height;
  constexpr double gap = 0.003;

  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(width, height);
  vtkNew<vtkRenderer> titles;
  titles->SetBackground(1.0, 1.0, 1.0);
  window->AddRenderer(titles);
  for (std::size_t i = 0; i < panels.size(); ++i)
  {
    const Panel& panel = panels[i];
    const double left = static_cast<double>(i) / count + gap;
    const double right = static_cast<double>(i + 1) / count - gap;
    double bounds[6];
    panel.Image->GetBounds(bounds);
    AddView(window, panel, { left, closeUpTop + gap, right, imageTop },
      { 0.5 * (bounds[0] + bounds[1]), 0.5 * (bounds[2] + bounds[3]) },
      0.5 * highest * (bounds[1] - bounds[0]), 1.2f);
    AddView(window, panel, { left, gap, right, closeUpTop - gap },
      { panel.CloseUp[0], panel.CloseUp[1] }, panel.CloseUp[2], 3.2f);

    vtkNew<vtkTextActor> title;
    title->SetInput(panel.Title.c_str());
    title->GetTextProperty()->SetFontSize(20 * oversampling);
    title->GetTextProperty()->SetColor(0.1, 0.1, 0.1);
    title->GetTextProperty()->SetJustificationToCentered();
    title->GetTextProperty()->SetVerticalJustificationToCentered();
    title->SetPosition((static_cast<double>(i) + 0.5) * panelWidth, height - 0.5 * titleHeight);
    titles->AddActor2D(title);
  }
  window->Render();

  vtkNew<vtkWindowToImageFilter> capture;
  capture->SetInput(window);
  capture->ReadFrontBufferOff();
  vtkNew<vtkImageResize> smaller;
  smaller->SetInputConnection(capture->GetOutputPort());
  smaller->SetOutputDimensions(width / oversampling, height / oversampling, 1);
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(smaller->GetOutputPort());
  writer->SetFileName(fileName.c_str());
  writer->Write();
}
