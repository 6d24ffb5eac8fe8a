// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Help.h"

#include <CLI/CLI.hpp>

#include <memory>
#include <sstream>

namespace dhm
{
namespace
{

constexpr std::size_t lineLength = 96;
constexpr std::size_t columnWidth = 34;

/// Breaks lines at words.
std::string Wrap(const std::string& text, std::size_t width)
{
  std::string wrapped;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
  {
    std::istringstream words(line);
    std::size_t column = 0;
    for (std::string word; words >> word;)
    {
      if (column > 0)
      {
        const bool fits = column + 1 + word.size() <= width;
        wrapped += fits ? ' ' : '\n';
        column = fits ? column + 1 : 0;
      }
      wrapped += word;
      column += word.size();
    }
    wrapped += '\n';
  }
  if (!wrapped.empty())
  {
    wrapped.pop_back();
  }
  return wrapped;
}

class HelpFormatter : public CLI::Formatter
{
public:
  HelpFormatter() { this->column_width(columnWidth); }

  std::string make_description(const CLI::App* app) const override
  {
    return Wrap(app->get_description(), lineLength) + "\n";
  }

  std::string make_footer(const CLI::App* app) const override
  {
    const std::string footer = app->get_footer();
    return footer.empty() ? footer : Wrap(footer, lineLength) + "\n";
  }

  std::string make_subcommand(const CLI::App* command) const override
  {
    std::ostringstream text;
    CLI::detail::format_help(text, command->get_name(),
      Wrap(command->get_description(), lineLength - columnWidth), columnWidth);
    return text.str();
  }

  std::string make_option_desc(const CLI::Option* option) const override
  {
    return Wrap(option->get_description(), lineLength - columnWidth);
  }

  std::string make_option_opts(const CLI::Option* option) const override
  {
    if (option->get_positional() || option->get_type_size() == 0)
    {
      return "";
    }
    return " " + option->get_type_name() + (option->get_required() ? " (needed)" : "");
  }

  std::string make_option_usage(const CLI::Option* option) const override
  {
    return option->get_type_name();
  }

  std::string make_option_name(const CLI::Option* option, bool isPositional) const override
  {
    return isPositional ? option->get_type_name() : option->get_name(false, true);
  }
};

/// Text as troff takes it literally.
std::string Escape(const std::string& text)
{
  std::string escaped;
  for (const char c : text)
  {
    if (c == '\\')
    {
      escaped += "\\e";
    }
    else if (c == '-')
    {
      escaped += "\\-";
    }
    else if ((c == '.' || c == '\'') && (escaped.empty() || escaped.back() == '\n'))
    {
      // At the beginning of a line it would be a request.
      escaped += std::string("\\&") + c;
    }
    else
    {
      escaped += c;
    }
  }
  return escaped;
}

std::string Paragraphs(const std::string& text)
{
  std::string paragraphs = Escape(text);
  for (std::size_t at = paragraphs.find('\n'); at != std::string::npos;
       at = paragraphs.find('\n', at + 5))
  {
    paragraphs.replace(at, 1, "\n.PP\n");
  }
  return paragraphs + "\n";
}

void WriteOptions(const CLI::App& app, std::ostream& page)
{
  for (const CLI::Option* option : app.get_options())
  {
    const std::string type = option->get_type_name();
    page << ".TP\n";
    if (option->get_positional())
    {
      page << ".I " << Escape(type) << "\n";
    }
    else
    {
      page << ".BR " << Escape(option->get_name(false, true));
      if (option->get_type_size() != 0 && !type.empty())
      {
        page << " \" \" \\fI" << Escape(type) << "\\fR";
      }
      page << "\n";
    }
    page << Escape(option->get_description()) << "\n";
  }
}

} // namespace

void PrepareHelp(CLI::App& program)
{
  program.formatter(std::make_shared<HelpFormatter>());
}

std::string ManualPage(const CLI::App& program)
{
  std::ostringstream page;
  page << ".TH DHM 1 \"\" \"dhm " DHM_VERSION "\" \"User Commands\"\n"
       << ".SH NAME\ndhm \\- carry data from one triangulated domain onto another\n.SH SYNOPSIS\n";
  const auto commands = program.get_subcommands({});
  for (const CLI::App* command : commands)
  {
    page << ".B dhm " << command->get_name() << "\n.RI [ options ]";
    for (const CLI::Option* option : command->get_options())
    {
      if (option->get_positional())
      {
        page << "\n.I " << Escape(option->get_type_name());
      }
    }
    page << "\n.br\n";
  }
  page << ".SH DESCRIPTION\n"
       << Paragraphs(program.get_description() + "\n" + program.get_footer()) << ".SH OPTIONS\n";
  WriteOptions(program, page);
  page << ".SH COMMANDS\n";
  for (const CLI::App* command : commands)
  {
    page << ".SS " << command->get_name() << "\n" << Escape(command->get_description()) << ".\n";
    WriteOptions(*command, page);
    if (command->get_footer() != program.get_footer())
    {
      page << ".PP\n" << Paragraphs(command->get_footer());
    }
  }
  return page.str();
}

std::string DescribeUsageError(const CLI::App& program, const CLI::ParseError& error)
{
  const auto called = program.get_subcommands();
  std::string what = error.what();
  const auto left = program.remaining();
  if (called.empty() && !left.empty() && left[0].compare(0, 1, "-") != 0)
  {
    what = "There is no command \"" + left[0] + "\"; the commands are";
    for (const CLI::App* command : program.get_subcommands({}))
    {
      what += " " + command->get_name();
    }
  }
  else if (called.empty() && !left.empty())
  {
    what = "There is no option " + left[0];
  }
  else if (called.empty())
  {
    what = "What is to be done? Name a command";
  }
  // The files are called in messages as they are in the help.
  const std::string files = "FILES";
  if (!called.empty() && what.compare(0, files.size(), files) == 0)
  {
    what.replace(0, files.size(), called[0]->get_option(files)->get_type_name());
  }
  if (what.back() != '.')
  {
    what += '.';
  }
  return what + " See dhm " + (called.empty() ? "" : called[0]->get_name() + " ") + "--help.";
}

} // namespace dhm
