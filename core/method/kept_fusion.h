// SPDX-License-Identifier: Apache-2.0
// The fusion of depth after some of its slabs, in a checkpoint.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "core/base/checkpoint.h"
#include "core/base/hash.h"
#include "core/method/tsdf.h"

namespace beam {

class ZeroSurface;

// A fusion that passes a limit is tried again with larger voxels.
struct FusionTry {
  std::int32_t number = 0;
  std::optional<MeshLimit> passed;  // by the try before
};

class KeptFusion {
 public:
  // `of`: a digest of all that the fusion hangs on; asked for once, where something is kept or to be kept.
  // What was kept of something else is passed over.
  KeptFusion(Checkpoint& checkpoint, std::function<Digest()> of);

  // The one that was kept; the first where none was.
  const FusionTry& kept() const { return head_.attempt; }
  void begin(const FusionTry& attempt);

  // Gives `surface` what was kept of the try, and returns the first of the blocks that is not in it; 0:
  // nothing was.
  std::size_t takeUp(std::size_t blocks, ZeroSurface& surface);
  // When it is due: all blocks before `next` are in `surface`.
  void keep(std::size_t next, const ZeroSurface& surface, const Progress& progress);

 private:
  struct Head {
    FusionTry attempt;
    std::uint64_t next = 0;
    Digest of;
  };

  Checkpoint& checkpoint_;
  std::function<Digest()> of_;                // empty: head_ has it
  std::unique_ptr<CheckpointReader> reader_;  // behind the head; null: there is nothing to take up
  Head head_;                                 // of what was kept, then of what is at work
};

}  // namespace beam
