// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Help.h
/// What `--help` prints, and the manual page, made of the same descriptions.

#ifndef dhm_Help_h
#define dhm_Help_h

#include <string>

namespace CLI
{
class App;
class ParseError;
}

namespace dhm
{

/// Lets `--help` of the program and its subcommands break lines at words, and name files as SOURCE
/// [TARGET]. To be called before subcommands are added.
void PrepareHelp(CLI::App& program);

/// The manual page, in the language of troff (man(7)).
std::string ManualPage(const CLI::App& program);

/// What is wrong with the command line, and where more is said.
std::string DescribeUsageError(const CLI::App& program, const CLI::ParseError& error);

} // namespace dhm

#endif
