// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file LargeArray.h
/// Arrays with one element per triangle or point of a mesh.

#ifndef homeomorphism_LargeArray_h
#define homeomorphism_LargeArray_h

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace homeomorphism
{

/// Allocates memory for an array, to be released by ReleaseLarge. It is aligned to a cache line.
/// Large arrays use huge pages if the system has them: page faults and address translation for
/// small pages would take longer than the computation.
void* AllocateLarge(std::size_t bytes);
void ReleaseLarge(void* memory);

/// An allocator for standard containers.
template <typename T>
struct LargeAllocator
{
  static_assert(alignof(T) <= 64, "See AllocateLarge");
  using value_type = T;

  LargeAllocator() = default;
  template <typename Other>
  LargeAllocator(const LargeAllocator<Other>&) // NOLINT(google-explicit-constructor)
  {
  }

  T* allocate(std::size_t size) { return static_cast<T*>(AllocateLarge(size * sizeof(T))); }
  void deallocate(T* memory, std::size_t) { ReleaseLarge(memory); }

  template <typename Other>
  bool operator==(const LargeAllocator<Other>&) const
  {
    return true;
  }
  template <typename Other>
  bool operator!=(const LargeAllocator<Other>&) const
  {
    return false;
  }
};

/// For arrays that grow, or whose elements are not trivial.
template <typename T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

/// Memory that temporary arrays use, one part after the other, before it is needed for something
/// else, so that the system does not have to clear pages again.
class LargeScratch
{
public:
  LargeScratch(void* memory, std::size_t bytes)
    : Next(static_cast<char*>(memory))
    , End(Next + bytes)
  {
  }

  /// Returns null if too little is left.
  void* Take(std::size_t bytes)
  {
    constexpr std::size_t cacheLine = 64;
    if (bytes > static_cast<std::size_t>(this->End - this->Next))
    {
      return nullptr;
    }
    void* const memory = this->Next;
    this->Next += std::min((bytes + cacheLine - 1) / cacheLine * cacheLine,
      static_cast<std::size_t>(this->End - this->Next));
    return memory;
  }

private:
  char* Next;
  char* End;
};

/// An array of fixed size. Its elements are uninitialized until they are assigned, so memory is
/// written only once.
template <typename T>
class LargeArray
{
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>,
    "Elements are neither constructed nor destroyed");
  static_assert(alignof(T) <= 64, "See AllocateLarge");

public:
  LargeArray() = default;

  explicit LargeArray(std::size_t size)
    : Memory(size > 0 ? static_cast<T*>(AllocateLarge(size * sizeof(T))) : nullptr)
    , Count(size)
  {
  }

  /// Uses memory of @a scratch, if there is enough; it must outlive the array.
  LargeArray(std::size_t size, LargeScratch& scratch)
    : Count(size)
  {
    this->Memory = { static_cast<T*>(scratch.Take(size * sizeof(T))), Release{ false } };
    if (!this->Memory)
    {
      *this = LargeArray(size);
    }
  }

  LargeArray(std::size_t size, const T& value)
    : LargeArray(size)
  {
    std::fill(this->begin(), this->end(), value);
  }

  /// Copies the elements.
  LargeArray(const std::vector<T>& elements) // NOLINT(google-explicit-constructor)
    : LargeArray(elements.size())
  {
    std::copy(elements.begin(), elements.end(), this->begin());
  }
  LargeArray(std::initializer_list<T> elements)
    : LargeArray(elements.size())
  {
    std::copy(elements.begin(), elements.end(), this->begin());
  }

  LargeArray(LargeArray&& other) noexcept
    : Memory(std::move(other.Memory))
    , Count(std::exchange(other.Count, 0))
  {
  }
  LargeArray& operator=(LargeArray&& other) noexcept
  {
    this->Memory = std::move(other.Memory);
    this->Count = std::exchange(other.Count, 0);
    return *this;
  }

  std::size_t size() const { return this->Count; }
  bool empty() const { return this->Count == 0; }

  T& operator[](std::size_t i) { return this->Memory.get()[i]; }
  const T& operator[](std::size_t i) const { return this->Memory.get()[i]; }

  T* begin() { return this->Memory.get(); }
  T* end() { return this->Memory.get() + this->Count; }
  const T* begin() const { return this->Memory.get(); }
  const T* end() const { return this->Memory.get() + this->Count; }

private:
  struct Release
  {
    bool IsOwned = true;
    void operator()(T* memory) const
    {
      if (this->IsOwned)
      {
        ReleaseLarge(memory);
      }
    }
  };

  std::unique_ptr<T, Release> Memory;
  std::size_t Count = 0;
};

} // namespace homeomorphism

#endif
