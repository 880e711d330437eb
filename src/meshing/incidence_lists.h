#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace delvox {

/// For each vertex the numbers of the cells that it is a corner of, in lists that may change: they lie in one array,
/// and a list that outgrows its place moves to the end.
class IncidenceLists {
 public:
  template <class Cell>
  IncidenceLists(std::size_t vertices, const std::vector<Cell>& cells) : lists_(vertices) {
    for (const Cell& cell : cells) {
      for (std::uint32_t v : cell) ++lists_[v].capacity;
    }
    std::uint32_t begin = 0;
    for (List& list : lists_) {
      list.begin = begin;
      begin += list.capacity;
    }
    pool_.resize(begin);
    for (std::uint32_t c = 0; c < cells.size(); ++c) {
      for (std::uint32_t v : cells[c]) pool_[lists_[v].begin + lists_[v].size++] = c;
    }
  }

  std::span<const std::uint32_t> of(std::uint32_t vertex) const {
    return {pool_.data() + lists_[vertex].begin, lists_[vertex].size};
  }
  void add_vertex() { lists_.emplace_back(); }
  /// Takes away the last vertex. pre: its list is empty.
  void remove_vertex() { lists_.pop_back(); }
  void add(std::uint32_t vertex, std::uint32_t cell) {
    List& list = lists_[vertex];
    if (list.size == list.capacity) move_to_end(list);
    pool_[list.begin + list.size++] = cell;
  }
  /// pre: the cell is in the vertex' list.
  void remove(std::uint32_t vertex, std::uint32_t cell) {
    List& list = lists_[vertex];
    std::uint32_t* const first = pool_.data() + list.begin;
    *std::find(first, first + list.size, cell) = first[list.size - 1];
    --list.size;
  }

 private:
  struct List {
    std::uint32_t begin = 0, size = 0, capacity = 0;
  };

  void move_to_end(List& list) {
    const auto begin = static_cast<std::uint32_t>(pool_.size());
    list.capacity = 2 * list.size + 4;
    pool_.resize(pool_.size() + list.capacity);
    std::copy_n(pool_.begin() + list.begin, list.size, pool_.begin() + begin);
    list.begin = begin;
  }

  std::vector<List> lists_;
  std::vector<std::uint32_t> pool_;
};

}  // namespace delvox
