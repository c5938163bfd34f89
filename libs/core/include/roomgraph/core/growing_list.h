// SPDX-License-Identifier: BSD-3-Clause
// List that only grows, whose copies share what they have in common.
#pragma once

#include <atomic>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace roomgraph {

/// Elements are added at the end and never change. A copy is cheap, a pointer for each 256 elements: it shares those that
/// are there, and both may go on by themselves, in different threads, too. References hold as long as the list, those to its
/// latest elements until it or a copy grows.
template <class T>
class GrowingList {
 public:
  class Iterator {
   public:
    using iterator_category = std::random_access_iterator_tag;
    using value_type = T;
    using difference_type = std::ptrdiff_t;
    using pointer = const T*;
    using reference = const T&;

    Iterator() = default;
    Iterator(const GrowingList& list, difference_type index) : list_(&list), index_(index) {}
    reference operator*() const { return (*list_)[static_cast<std::size_t>(index_)]; }
    pointer operator->() const { return &**this; }
    reference operator[](difference_type n) const { return *(*this + n); }
    Iterator& operator+=(difference_type n) {
      index_ += n;
      return *this;
    }
    Iterator& operator-=(difference_type n) { return *this += -n; }
    Iterator& operator++() { return *this += 1; }
    Iterator& operator--() { return *this -= 1; }
    Iterator operator++(int) { return {*list_, index_++}; }
    Iterator operator--(int) { return {*list_, index_--}; }
    friend Iterator operator+(Iterator it, difference_type n) { return it += n; }
    friend Iterator operator+(difference_type n, Iterator it) { return it += n; }
    friend Iterator operator-(Iterator it, difference_type n) { return it -= n; }
    friend difference_type operator-(const Iterator& a, const Iterator& b) { return a.index_ - b.index_; }
    friend bool operator==(const Iterator& a, const Iterator& b) { return a.index_ == b.index_; }
    friend auto operator<=>(const Iterator& a, const Iterator& b) { return a.index_ <=> b.index_; }

   private:
    const GrowingList* list_ = nullptr;
    difference_type index_ = 0;
  };
  using value_type = T;
  using const_iterator = Iterator;

  GrowingList() = default;
  GrowingList(const GrowingList&) = default;
  GrowingList& operator=(const GrowingList&) = default;
  GrowingList(GrowingList&& other) noexcept : chunks_(std::move(other.chunks_)), size_(std::exchange(other.size_, 0)) {
    other.chunks_.clear();
  }
  GrowingList& operator=(GrowingList&& other) noexcept {
    GrowingList taken(std::move(other));
    std::swap(chunks_, taken.chunks_);
    std::swap(size_, taken.size_);
    return *this;
  }
  GrowingList(std::initializer_list<T> elements) {
    for (const T& element : elements) push_back(element);
  }

  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  const T& operator[](std::size_t i) const { return (*chunks_[i / kChunk])[i % kChunk]; }
  const T& front() const { return (*this)[0]; }
  const T& back() const { return (*this)[size_ - 1]; }
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, static_cast<std::ptrdiff_t>(size_)}; }

  template <class... Arguments>
  void emplace_back(Arguments&&... arguments) {
    const std::size_t place = size_ % kChunk;
    std::shared_ptr<Chunk> chunk = place == 0 ? std::make_shared<Chunk>() : chunks_.back();
    if (!chunk->claim(place)) {  // another list has gone on there
      chunk = std::make_shared<Chunk>();
      for (std::size_t i = 0; i < place; ++i) chunk->put(i, (*chunks_.back())[i]);
      chunk->claim(place);
    }
    chunk->construct(place, std::forward<Arguments>(arguments)...);  // they may be of the chunk that is replaced
    if (place == 0)
      chunks_.push_back(std::move(chunk));
    else
      chunks_.back() = std::move(chunk);
    ++size_;
  }
  void push_back(T value) { emplace_back(std::move(value)); }

 private:
  static constexpr std::size_t kChunk = 256;

  class Chunk {
   public:
    Chunk() = default;
    Chunk(const Chunk&) = delete;
    Chunk& operator=(const Chunk&) = delete;
    ~Chunk() {
      for (std::size_t i = 0; i < used_.load(); ++i) std::destroy_at(at(i));
    }
    const T& operator[](std::size_t i) const { return *std::launder(reinterpret_cast<const T*>(bytes_ + i * sizeof(T))); }
    /// Whether the place after the last one is this one; of several lists only one is told so.
    bool claim(std::size_t place) { return used_.compare_exchange_strong(place, place + 1); }
    /// Of the place that was claimed last.
    template <class... Arguments>
    void construct(std::size_t i, Arguments&&... arguments) {
      try {
        ::new (static_cast<void*>(bytes_ + i * sizeof(T))) T{std::forward<Arguments>(arguments)...};
      } catch (...) {
        used_.store(i);
        throw;
      }
    }
    void put(std::size_t i, const T& value) {
      claim(i);
      construct(i, value);
    }

   private:
    T* at(std::size_t i) { return std::launder(reinterpret_cast<T*>(bytes_ + i * sizeof(T))); }

    alignas(T) std::byte bytes_[kChunk * sizeof(T)];
    std::atomic<std::size_t> used_ = 0;
  };

  std::vector<std::shared_ptr<Chunk>> chunks_;
  std::size_t size_ = 0;
};

}  // namespace roomgraph
