// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Console.h"

#include "vtkCallbackCommand.h"
#include "vtkLogger.h"
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
    "^(ERROR|Warning|Generic Warning): In [^\\n]*, line [0-9]+\\n([^\\n]*?\\(0x[0-9a-f]+\\): )?");
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
  // It would show them at once, with times and addresses, besides.
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
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

std::string Printable(const std::string& text)
{
  std::string printable;
  for (std::size_t i = 0; i < text.size();)
  {
    const auto byte = [&text](std::size_t k) {
      return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u;
    };
    const unsigned int first = byte(i);
    std::size_t length = first < 0x80u  ? 1u
      : first >= 0xC2u && first < 0xE0u ? 2u
      : first >= 0xE0u && first < 0xF0u ? 3u
      : first >= 0xF0u && first < 0xF5u ? 4u
                                        : 0u;
    for (std::size_t k = 1; k < length; ++k)
    {
      length = byte(i + k) >= 0x80u && byte(i + k) < 0xC0u ? length : 0u;
    }
    const bool control =
      length == 1 && first != '\n' && first != '\t' && (first < ' ' || first == 127u);
    if (length == 0 || control)
    {
      constexpr char digits[] = "0123456789abcdef";
      printable += "\\x";
      printable += digits[first / 16u];
      printable += digits[first % 16u];
      ++i;
    }
    else
    {
      printable.append(text, i, length);
      i += length;
    }
  }
  return printable;
}

void Complain(const std::string& message)
{
  std::cerr << "dhm: " << Printable(message) << std::endl;
}

void Warn(const std::string& message)
{
  if (!isQuiet)
  {
    Complain("warning: " + message);
  }
}

void Remark(const std::string& message)
{
  if (!isQuiet)
  {
    Complain(message);
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
  if (this->Followed)
  {
    this->Followed->RemoveObserver(this->Observer);
  }
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
  this->Observer = algorithm->AddObserver(vtkCommand::ProgressEvent, follower);
  this->Followed = algorithm;
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
