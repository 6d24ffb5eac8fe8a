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
  if (bytes >= 2 * largePage)
  {
    // Only for whole huge pages within the array. Failure is harmless.
    const auto smallPage = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t before = smallPage - reinterpret_cast<std::uintptr_t>(memory) % smallPage;
    madvise(
      static_cast<char*>(memory) + before, (bytes - before) / smallPage * smallPage, MADV_HUGEPAGE);
  }
#endif
  return memory;
}

void ReleaseLarge(void* memory)
{
  ::operator delete(memory, CacheLine);
}

} // namespace homeomorphism
