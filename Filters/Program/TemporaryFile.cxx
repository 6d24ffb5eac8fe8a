// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "TemporaryFile.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <system_error>

#include <sys/stat.h>
#include <unistd.h>

namespace dhm
{
namespace
{

/// Names of the files that an interrupt must remove: signal handlers can use no more than plain
/// arrays. One command has at most two outputs and standard input at a time.
constexpr int maximumFiles = 4;
constexpr std::size_t maximumLength = 4096;
char remembered[maximumFiles][maximumLength] = {};

extern "C" void RemoveRemembered(int signal)
{
  for (const auto& name : remembered)
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
  for (auto& slot : remembered)
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
  for (auto& slot : remembered)
  {
    if (name == slot)
    {
      slot[0] = '\0';
    }
  }
}

} // namespace

void HandleSignals()
{
  for (const int signal : { SIGINT, SIGTERM, SIGHUP })
  {
    // What is ignored (by nohup, say) stays so.
    if (std::signal(signal, RemoveRemembered) == SIG_IGN)
    {
      std::signal(signal, SIG_IGN);
    }
  }
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

TemporaryFile::TemporaryFile(const std::string& begin, const std::string& ending)
{
  std::string pattern = begin + "XXXXXX" + ending;
  const int descriptor = mkstemps(pattern.data(), static_cast<int>(ending.size()));
  if (descriptor < 0)
  {
    throw std::system_error(errno, std::generic_category());
  }
  this->Name = pattern;
  Remember(this->Name);
  // As other new files, not only for the owner.
  const mode_t mask = umask(0);
  umask(mask);
  fchmod(descriptor, 0666 & ~mask);
  close(descriptor);
}

TemporaryFile::~TemporaryFile()
{
  if (!this->Name.empty())
  {
    unlink(this->Name.c_str());
    Forget(this->Name);
  }
}

int TemporaryFile::Rename(const std::string& name, bool replace)
{
  // A link, unlike a new name, replaces no file that has come into being meanwhile; but not all
  // file systems have links.
  if (!replace && link(this->Name.c_str(), name.c_str()) == 0)
  {
    unlink(this->Name.c_str());
  }
  else if ((!replace && errno == EEXIST) || std::rename(this->Name.c_str(), name.c_str()) != 0)
  {
    return errno;
  }
  Forget(this->Name);
  this->Name.clear();
  return 0;
}

} // namespace dhm
