// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Console.h"

#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOutputWindow.h"

#include <algorithm>
#include <iostream>
#include <regex>
#include <utility>

#include <unistd.h>

namespace dhm
{
namespace
{

bool isQuiet = false;

/// A message without what VTK's macros put around it: "ERROR: In file, line n", then the class and
/// the address of the object.
std::string Unwrap(const std::string& text)
{
  static const std::regex wrapping(
    "^(ERROR|Warning): In [^\\n]*, line [0-9]+\\n[^\\n]*?\\(0x[0-9a-f]+\\): ");
  std::string message = std::regex_replace(text, wrapping, "");
  while (!message.empty() && message.back() == '\n')
  {
    message.pop_back();
  }
  return message;
}

class MessageKeeper : public vtkOutputWindow
{
public:
  static MessageKeeper* New() { VTK_STANDARD_NEW_BODY(MessageKeeper); }
  vtkTypeMacro(MessageKeeper, vtkOutputWindow);

  void DisplayErrorText(const char* text) override { Add(this->Errors, text); }
  void DisplayWarningText(const char* text) override { Add(this->Warnings, text); }
  void DisplayGenericWarningText(const char* text) override { Add(this->Warnings, text); }
  void DisplayText(const char* text) override { Add(this->Warnings, text); }
  void DisplayDebugText(const char*) override {}

  std::string Errors;
  std::string Warnings;

private:
  static void Add(std::string& messages, const char* text)
  {
    const std::string message = Unwrap(text);
    // What follows from an earlier failure says nothing new.
    if (message.find("Algorithm vtk") == std::string::npos ||
      message.find("returned failure for request") == std::string::npos)
    {
      messages += (messages.empty() ? "" : "\n") + message;
    }
  }
};

MessageKeeper* Keeper()
{
  static vtkNew<MessageKeeper> keeper;
  return keeper;
}

} // namespace

void CaptureVtkMessages()
{
  vtkOutputWindow::SetInstance(Keeper());
}

std::string TakeErrors()
{
  return std::exchange(Keeper()->Errors, "");
}

std::string TakeWarnings()
{
  return std::exchange(Keeper()->Warnings, "");
}

void SetQuiet(bool quiet)
{
  isQuiet = quiet;
}

void Warn(const std::string& message)
{
  if (!isQuiet)
  {
    std::cerr << "dhm: warning: " << message << std::endl;
  }
}

void Remark(const std::string& message)
{
  if (!isQuiet)
  {
    std::cerr << "dhm: " << message << std::endl;
  }
}

ProgressBar::ProgressBar(std::string what, int steps)
  : What(std::move(what))
  , Steps(steps)
  , Visible(!isQuiet && !this->What.empty() && isatty(STDERR_FILENO) != 0)
{
  this->Show(0.0);
}

ProgressBar::~ProgressBar()
{
  if (this->Visible)
  {
    // Back to the line's beginning, and erase it.
    std::cerr << "\r\033[K" << std::flush;
  }
}

void ProgressBar::Follow(vtkAlgorithm* algorithm)
{
  vtkNew<vtkCallbackCommand> follower;
  follower->SetClientData(this);
  follower->SetCallback([](vtkObject*, unsigned long, void* bar, void* progress) {
    static_cast<ProgressBar*>(bar)->Show(*static_cast<double*>(progress));
  });
  algorithm->AddObserver(vtkCommand::ProgressEvent, follower);
}

void ProgressBar::Advance()
{
  ++this->Done;
  this->Show(0.0);
}

void ProgressBar::Show(double proportion)
{
  if (!this->Visible)
  {
    return;
  }
  const double done = (this->Done + std::clamp(proportion, 0.0, 1.0)) / this->Steps;
  const int percent = std::min(100, static_cast<int>(100.0 * done));
  if (percent == this->ShownPercent)
  {
    return;
  }
  this->ShownPercent = percent;
  constexpr int width = 30;
  const int filled = width * percent / 100;
  std::cerr << "\r" << this->What << " [" << std::string(filled, '#')
            << std::string(width - filled, '.') << "] " << percent << " %" << std::flush;
}

} // namespace dhm
