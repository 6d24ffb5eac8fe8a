// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Console.h
/// What the user sees while the program works. Everything goes to standard error, so that results
/// can go to standard output.

#ifndef dhm_Console_h
#define dhm_Console_h

#include "vtkAlgorithm.h"
#include "vtkSmartPointer.h"

#include <string>

namespace dhm
{

/// Keeps VTK's messages from the terminal; see TakeErrors. To be called once.
void CaptureVtkMessages();

/// The errors that VTK has reported since the last call, without the places in VTK's sources; empty
/// if there were none.
std::string TakeErrors();

/// The same for warnings.
std::string TakeWarnings();

/// Whether warnings, progress and remarks are kept back.
void SetQuiet(bool quiet);

/// Text without what would confuse a terminal: control characters and bytes that are no UTF-8 (of
/// damaged files that messages quote) as \\x...
std::string Printable(const std::string& text);

/// An error message.
void Complain(const std::string& message);

void Warn(const std::string& message);

/// Something worth knowing that is no warning.
void Remark(const std::string& message);

/// A progress bar on a terminal, nothing elsewhere or if quiet. Erased at the end of its life.
class ProgressBar
{
public:
  /// @a what is done in @a steps equal steps. Without a name nothing is shown: something larger has
  /// a bar.
  explicit ProgressBar(std::string what, int steps = 1);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Shows what @a algorithm says of its progress, as a part of the current step. To be called
  /// once.
  void Follow(vtkAlgorithm* algorithm);

  /// The current step is done.
  void Advance();

  /// @a proportion of the current step is done.
  void Show(double proportion);

private:
  std::string What;
  int Steps;
  int Done = 0;
  int ShownPercent = -1;
  bool Visible;
  vtkSmartPointer<vtkAlgorithm> Followed;
  unsigned long Observer = 0;
};

} // namespace dhm

#endif
