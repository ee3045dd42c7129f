// SPDX-License-Identifier: Apache-2.0
#include "core/base/hash.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <new>

#include "core/base/error.h"

namespace beam {

std::string Digest::hex() const { return fmt::format("{:016x}{:016x}", high, low); }

Digest parseDigest(std::string_view hex) {
  const bool ok = hex.size() == 32 && hex.find_first_not_of("0123456789abcdef") == std::string_view::npos;
  if (!ok)
    throw Error(Error::Kind::Data, fmt::format("\"{}\" is not a digest of 32 hexadecimal digits", hex));
  return {std::stoull(std::string(hex.substr(0, 16)), nullptr, 16),
          std::stoull(std::string(hex.substr(16)), nullptr, 16)};
}

Digest digestOf(std::span<const std::byte> bytes) {
  const XXH128_hash_t h = XXH3_128bits(bytes.data(), bytes.size());
  return {h.high64, h.low64};
}

Digest digestOf(std::string_view text) {
  return digestOf(std::as_bytes(std::span(text.data(), text.size())));
}

struct Hasher::State {
  State() {
    if (!xxh) throw std::bad_alloc();
  }
  ~State() { XXH3_freeState(xxh); }
  XXH3_state_t* xxh = XXH3_createState();
};

Hasher::Hasher() : state_(std::make_unique<State>()) { XXH3_128bits_reset(state_->xxh); }
Hasher::~Hasher() = default;

void Hasher::add(std::span<const std::byte> bytes) {
  XXH3_128bits_update(state_->xxh, bytes.data(), bytes.size());
}
void Hasher::add(std::string_view text) { add(std::as_bytes(std::span(text.data(), text.size()))); }

Digest Hasher::digest() const {
  const XXH128_hash_t h = XXH3_128bits_digest(state_->xxh);
  return {h.high64, h.low64};
}

}  // namespace beam
