// SPDX-License-Identifier: Apache-2.0
// Digest: 128 bits of XXH3, equal on every machine. For result keys and file checks, not for security.
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace beam {

struct Digest {
  std::uint64_t high = 0, low = 0;
  auto operator<=>(const Digest&) const = default;
  std::string hex() const;  // 32 lower-case digits
};

// Throws Error{Data} unless `hex` is 32 hexadecimal digits.
Digest parseDigest(std::string_view hex);

Digest digestOf(std::span<const std::byte> bytes);
Digest digestOf(std::string_view text);

// Digest of a stream of pieces; equal to digestOf of their concatenation.
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(const Hasher&) = delete;
  Hasher& operator=(const Hasher&) = delete;
  void add(std::span<const std::byte> bytes);
  void add(std::string_view text);
  Digest digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace beam
