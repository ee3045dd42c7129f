// SPDX-License-Identifier: Apache-2.0
// What a long computation has so far, kept so that a kill costs its last minute and not all of it. What goes
// on from there ends with the same bytes. Only values without pointers are kept, as they lie in memory: a
// checkpoint is read where it was written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "core/base/error.h"
#include "core/base/progress.h"

namespace beam {

// Lists one after the other, each behind its length. Those that are lent must live until they are kept.
class CheckpointWriter {
 public:
  using Piece = std::span<const std::byte>;

  template <class T>
  void lend(const std::vector<T>& list) {
    static_assert(std::is_standard_layout_v<T> && std::is_trivially_destructible_v<T>);
    add(list.size(), std::as_bytes(std::span(list)));
  }
  template <class T>
  void give(const std::vector<T>& list) {
    static_assert(std::is_standard_layout_v<T> && std::is_trivially_destructible_v<T>);
    const auto bytes = std::as_bytes(std::span(list));
    add(list.size(), given_.emplace_back(bytes.begin(), bytes.end()));
  }
  std::span<const Piece> pieces() const { return pieces_; }

 private:
  void add(std::size_t length, Piece values) {
    pieces_.push_back(std::as_bytes(std::span(&lengths_.emplace_back(length), 1)));
    pieces_.push_back(values);
  }

  std::vector<Piece> pieces_;
  std::deque<std::uint64_t> lengths_;  // a deque: what points into it stays
  std::deque<std::vector<std::byte>> given_;
};

// The lists in their order.
class CheckpointReader {
 public:
  virtual ~CheckpointReader() = default;

  // Throws Error{Data} when there are not so many bytes.
  template <class T>
  std::vector<T> list() {
    static_assert(std::is_standard_layout_v<T> && std::is_trivially_destructible_v<T>);
    std::uint64_t length = 0;
    read(std::as_writable_bytes(std::span(&length, 1)));
    if (length > left() / sizeof(T))
      throw Error(Error::Kind::Data, "the checkpoint ends in the middle of a list");
    std::vector<T> values(length);
    read(std::as_writable_bytes(std::span(values)));
    return values;
  }

 protected:
  virtual std::uint64_t left() const = 0;  // bytes
  virtual void read(std::span<std::byte> bytes) = 0;
};

class Checkpoint {
 public:
  virtual ~Checkpoint() = default;

  // Whether it is time to keep what there is.
  virtual bool due() const = 0;
  // Takes the place of what was kept before, whole or not at all. A disk that does not take it is warned of
  // and does not end the computation. Throws Cancelled.
  virtual void keep(const CheckpointWriter& what, const Progress& progress) = 0;
  // What was kept last; null when nothing is, or nothing undamaged.
  virtual std::unique_ptr<CheckpointReader> kept() const = 0;
};

}  // namespace beam
