// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "OutputFile.h"

#include "Failure.h"
#include "InputFile.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace dhm
{
namespace
{

namespace files = std::filesystem;

/// Names of the files that an interrupt must remove: signal handlers can use no more than plain
/// arrays. One command writes at most two files at a time.
constexpr int maximumFiles = 4;
constexpr std::size_t maximumLength = 4096;
char unfinished[maximumFiles][maximumLength] = {};

extern "C" void RemoveUnfinished(int signal)
{
  for (const auto& name : unfinished)
  {
    if (name[0] != '\0')
    {
      unlink(name);
    }
  }
  // The default action ends the program as the signal's sender expects.
  std::signal(signal, SIG_DFL);
  raise(signal);
}

void Remember(const std::string& name)
{
  for (auto& slot : unfinished)
  {
    if (slot[0] == '\0' && name.size() < maximumLength)
    {
      std::copy(name.begin() + 1, name.end(), slot + 1);
      slot[name.size()] = '\0';
      slot[0] = name[0];
      return;
    }
  }
}

void Forget(const std::string& name)
{
  for (auto& slot : unfinished)
  {
    if (name == slot)
    {
      slot[0] = '\0';
    }
  }
}

/// Pipes and devices are written to, not replaced.
bool IsWrittenThrough(const std::string& name)
{
  return name == "-" || (files::exists(name) && !files::is_regular_file(name));
}

} // namespace

OutputFile::OutputFile(const std::string& name, const std::string& format, bool replace)
  : Name(name)
  , Format(name == "-" ? format : FormatOf(name))
{
  static const bool prepared = [] {
    for (const int signal : { SIGINT, SIGTERM, SIGHUP })
    {
      std::signal(signal, RemoveUnfinished);
    }
    // A limit on the size of files, or a reader that has gone, is an error like others.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    return true;
  }();
  (void)prepared;

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
  // The extension stays at the end: some writers look at it.
  const std::string ending = "." + this->Format;
  std::string pattern =
    (folder / ("." + path.filename().string() + ".unfinished-XXXXXX" + ending)).string();
  const int descriptor = mkstemps(pattern.data(), static_cast<int>(ending.size()));
  if (descriptor < 0)
  {
    throw Failure(FILE_TROUBLE,
      "Cannot write " + name + ": " + std::strerror(errno) + " (" + folder.string() + ").");
  }
  // As other new files, not only for the owner.
  const mode_t mask = umask(0);
  umask(mask);
  fchmod(descriptor, 0666 & ~mask);
  close(descriptor);
  this->TemporaryName = pattern;
  Remember(this->TemporaryName);
}

OutputFile::~OutputFile()
{
  if (!this->TemporaryName.empty())
  {
    unlink(this->TemporaryName.c_str());
    Forget(this->TemporaryName);
  }
}

void OutputFile::FailToWrite(int error) const
{
  throw Failure(
    FILE_TROUBLE, "Cannot write " + this->GetName() + ": " + std::strerror(error) + ".");
}

void OutputFile::Commit()
{
  if (IsWrittenThrough(this->Name))
  {
    std::ifstream written(this->TemporaryName, std::ios::binary);
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
  const int descriptor = open(this->TemporaryName.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0 || fsync(descriptor) != 0 || close(descriptor) != 0 ||
    std::rename(this->TemporaryName.c_str(), this->Name.c_str()) != 0)
  {
    this->FailToWrite(errno);
  }
  Forget(this->TemporaryName);
  this->TemporaryName.clear();
}

} // namespace dhm
