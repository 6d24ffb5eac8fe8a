// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "OutputFile.h"

#include "Failure.h"
#include "InputFile.h"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace dhm
{
namespace
{

namespace files = std::filesystem;

/// Pipes and devices are written to, not replaced.
bool IsWrittenThrough(const std::string& name)
{
  return name == "-" || (files::exists(name) && !files::is_regular_file(name));
}

} // namespace

std::string OutputFormatOf(const std::string& name, const std::string& format)
{
  const std::string own = name == "-" ? "" : FormatOf(name);
  return own.empty() && IsWrittenThrough(name) ? format : own;
}

std::string CannotWrite(const std::string& what, const std::string& format)
{
  return format.empty() ? "The output's name has no extension that says what to write"
                        : "Cannot write " + what + " as ." + format;
}

OutputFile::OutputFile(const std::string& name, const std::string& format, bool replace)
  : Name(name)
  , Format(OutputFormatOf(name, format))
  , Replace(replace)
{
  if (name.empty())
  {
    throw Failure(WRONG_USAGE, "The output's name is empty.");
  }
  std::error_code error;
  if (files::is_directory(name, error))
  {
    throw Failure(FILE_TROUBLE, name + " is a folder.");
  }
  if (!replace && name != "-" && files::is_regular_file(name, error))
  {
    throw Failure(FILE_TROUBLE, name + " exists. Use --force to replace it.");
  }
  const files::path path(name);
  const files::path folder = IsWrittenThrough(name) ? files::temp_directory_path()
    : path.has_parent_path()                        ? path.parent_path()
                                                    : files::path(".");
  try
  {
    // The extension stays at the end: some writers look at it.
    this->Temporary.emplace(
      (folder / ("." + path.filename().string() + ".unfinished-")).string(), "." + this->Format);
  }
  catch (const std::system_error& failed)
  {
    throw Failure(FILE_TROUBLE,
      "Cannot write " + this->GetName() + ": " + failed.code().message() + " (" + folder.string() +
        ").");
  }
}

void OutputFile::FailToWrite(int error) const
{
  throw Failure(FILE_TROUBLE,
    "Cannot write " + this->GetName() + ": " + std::generic_category().message(error) + ".");
}

void OutputFile::Commit()
{
  if (IsWrittenThrough(this->Name))
  {
    std::ifstream written(this->GetTemporaryName(), std::ios::binary);
    const int descriptor =
      this->Name == "-" ? dup(STDOUT_FILENO) : open(this->Name.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0)
    {
      this->FailToWrite(errno);
    }
    char buffer[1 << 16];
    while (written.read(buffer, sizeof buffer), written.gcount() > 0)
    {
      for (std::streamsize done = 0; done < written.gcount();)
      {
        const ssize_t count =
          write(descriptor, buffer + done, static_cast<std::size_t>(written.gcount() - done));
        if (count < 0)
        {
          const int error = errno;
          close(descriptor);
          this->FailToWrite(error);
        }
        done += count;
      }
    }
    if (close(descriptor) != 0)
    {
      this->FailToWrite(errno);
    }
    return;
  }
  // Some file systems find out only now that there is no room.
  const int descriptor = open(this->GetTemporaryName().c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0 || fsync(descriptor) != 0 || close(descriptor) != 0)
  {
    this->FailToWrite(errno);
  }
  const int error = this->Temporary->Rename(this->Name, this->Replace);
  if (error != 0)
  {
    this->FailToWrite(error);
  }
}

void OutputFile::Write(std::string_view contents) const
{
  this->Write([contents](std::ostream& file) {
    file.write(contents.data(), static_cast<std::streamsize>(contents.size()));
  });
}

void OutputFile::Write(const std::function<void(std::ostream& file)>& write) const
{
  std::ofstream file(this->GetTemporaryName(), std::ios::binary);
  write(file);
  file.close();
  if (!file)
  {
    this->FailForWantOfRoom();
  }
}

void OutputFile::FailForWantOfRoom() const
{
  throw Failure(FILE_TROUBLE,
    "Cannot write " + this->GetName() + ": there is no room for it, or more than a file may take.");
}

} // namespace dhm
