// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// dhm: maps people's own files from one triangulated domain to another. See `dhm --help`.

#include "Command.h"
#include "Console.h"
#include "Failure.h"
#include "Help.h"
#include "TemporaryFile.h"

#include <CLI/CLI.hpp>

#include <exception>
#include <iostream>
#include <new>

int main(int argc, char* argv[])
{
  using namespace dhm;
  HandleSignals();
  CaptureVtkMessages();

  CLI::App program("Carries data from one triangulated domain onto another that has the same "
                   "triangles, one to one and smoothly, with an exact inverse.",
    "dhm");
  PrepareHelp(program);
  program.require_subcommand(1);
  program.fallthrough();
  program.set_version_flag("--version", "dhm " DHM_VERSION);
  program.add_flag_callback(
    "-q,--quiet", [] { SetQuiet(true); }, "Say nothing but errors");
  program.footer(
    "A pair of meshes is one file that has both (PROJ's triangulation files, or a mesh with the "
    "target's positions as a point array) or two files, SOURCE and TARGET. Meshes: .json .vtp .vtk "
    ".vtu .obj .off .ply .stl, xmorph's .mesh. - is standard input or output.\n"
    "Exit status: 0 done (check: yes), 1 the meshes are refused (check: no), 2 wrong usage, 3 a "
    "file cannot be read or written.\n"
    "Examples:\n"
    "dhm check shift.json\n"
    "dhm map shift.json points.csv -o shifted.csv\n"
    "dhm map --inverse before.vtp after.vtp measured.vtp -o back.vtp\n"
    "dhm warp here.obj there.obj photo.png -o warped.png\n"
    "dhm COMMAND --help says more about a command.");
  AddCheck(program);
  AddMap(program);
  AddWarp(program);
  AddMorph(program);
  AddFigure(program);
  AddCoordinates(program);
  AddRefine(program);
  AddConvert(program);
  // For the build, which makes the manual page.
  program
    .add_flag_callback("--manual-page",
      [&program] {
        std::cout << ManualPage(program);
        throw CLI::Success();
      })
    ->group("");

  // What help and versions are written to can be full, too.
  const auto finish = [](int status) {
    if (!std::cout.flush())
    {
      Complain("Cannot write to standard output.");
      return static_cast<int>(FILE_TROUBLE);
    }
    return status;
  };
  try
  {
    program.parse(argc, argv);
    return finish(SUCCESS);
  }
  catch (const CLI::ParseError& error)
  {
    if (error.get_exit_code() == 0)
    {
      program.exit(error);
      return finish(SUCCESS);
    }
    Complain(DescribeUsageError(program, error));
    return WRONG_USAGE;
  }
  catch (const Failure& failure)
  {
    Complain(failure.what());
    return failure.GetStatus();
  }
  catch (const std::bad_alloc&)
  {
    Complain("There is not enough memory.");
    return FILE_TROUBLE;
  }
  catch (const std::exception& error)
  {
    Complain(error.what());
    return FILE_TROUBLE;
  }
}
