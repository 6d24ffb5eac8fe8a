// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "LargeArray.h"

#include <cstdint>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace homeomorphism
{
namespace
{

constexpr std::align_val_t CacheLine{ 64 };

} // namespace

void* AllocateLarge(std::size_t bytes)
{
  void* memory = ::operator new(bytes, CacheLine);
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr std::size_t largePage = std::size_t(1) << 21;
  if (bytes >= largePage / 2)
  {
    // Include huge pages that contain only a part of the array, because arrays often lie side by
    // side. Failure is harmless.
    const std::size_t before = reinterpret_cast<std::uintptr_t>(memory) % largePage;
    const std::size_t pages = (before + bytes + largePage - 1) / largePage;
    madvise(static_cast<char*>(memory) - before, pages * largePage, MADV_HUGEPAGE);
  }
#endif
  return memory;
}

void ReleaseLarge(void* memory)
{
  ::operator delete(memory, CacheLine);
}

} // namespace homeomorphism
