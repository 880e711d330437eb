#pragma once

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>

namespace delvox {

/// An array that grows at its end, held in pages of its own: growing moves page tables instead of bytes, and huge pages
/// spare most of the page faults that a triangulation of millions of cells would cost. Elements start as zero bytes.
template <class T>
class PageArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  PageArray() = default;
  PageArray(PageArray&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)),
        size_(std::exchange(other.size_, 0)),
        bytes_(std::exchange(other.bytes_, 0)) {}
  PageArray(const PageArray&) = delete;
  PageArray& operator=(const PageArray&) = delete;
  ~PageArray() { free(); }

  std::size_t size() const { return size_; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  void prefetch(std::size_t i) const { __builtin_prefetch(data_ + i); }

  /// Makes the array at least `size` long. Throws std::bad_alloc. References into it are void afterwards.
  void grow_to(std::size_t size) {
    if (size * sizeof(T) > bytes_) reserve_bytes(std::max(size * sizeof(T), bytes_ + bytes_ / 2));
    size_ = std::max(size_, size);
  }
  /// Forgets the elements but keeps the pages: what grows again starts with what was there.
  void clear() { size_ = 0; }
  /// Gives the pages back.
  void free() {
    if (data_ != nullptr) munmap(data_, bytes_);
    data_ = nullptr;
    size_ = bytes_ = 0;
  }

 private:
  static constexpr std::size_t kHugePage = std::size_t{1} << 21;
  /// Smaller arrays take few page faults anyway, and would waste half a huge page each.
  static constexpr std::size_t kWorthHugePages = 4 * kHugePage;

  void reserve_bytes(std::size_t wanted) {
    const std::size_t bytes = (wanted + kHugePage - 1) / kHugePage * kHugePage;
    void* const pages = data_ == nullptr
                            ? mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)
                            : mremap(data_, bytes_, bytes, MREMAP_MAYMOVE);
    if (pages == MAP_FAILED) throw std::bad_alloc();
    data_ = static_cast<T*>(pages);
    bytes_ = bytes;
    // A wish: without huge pages all works as well.
    if (bytes >= kWorthHugePages) madvise(pages, bytes, MADV_HUGEPAGE);
  }

  T* data_ = nullptr;
  std::size_t size_ = 0, bytes_ = 0;
};

}  // namespace delvox
