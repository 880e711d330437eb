#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>

namespace delvox {

/// A list that is filled and emptied a million times: it keeps its storage, and what is pushed where there is room is
/// just written there.
template <class T>
class Scratch {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  const T* begin() const { return storage_.get(); }
  const T* end() const { return begin() + size_; }
  T* begin() { return storage_.get(); }
  T* end() { return begin() + size_; }
  T& operator[](std::size_t i) { return storage_[i]; }
  const T& operator[](std::size_t i) const { return storage_[i]; }
  const T& front() const { return storage_[0]; }

  void clear() { size_ = 0; }
  /// For so many elements more. References are void afterwards.
  void make_room(std::size_t count) {
    if (size_ + count > capacity_) grow(size_ + count);
  }
  /// One more, whose value is any. pre: there is room.
  T& push_raw() { return storage_[size_++]; }
  /// pre: there is room.
  T& push(const T& element) { return push_raw() = element; }

 private:
  [[gnu::noinline]] void grow(std::size_t wanted) {
    capacity_ = 2 * wanted;
    auto larger = std::make_unique_for_overwrite<T[]>(capacity_);
    std::copy(begin(), end(), larger.get());
    storage_ = std::move(larger);
  }

  std::unique_ptr<T[]> storage_;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace delvox
